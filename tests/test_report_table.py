from types import SimpleNamespace

import pytest
from rich.console import Console

from slamgym.report_table import EPISODE_COLUMNS, episode_table

SUMMARY = {
    "seed": 12,
    "speed_p95_mps": 1.6,
    "status": "init_failed",
    "ate_rmse_m": 0.0123,
    "rpe_step_trans_rmse_m": 0.0045,
    "rpe_trans_rmse_m": 0.0612,
    "rpe_rot_mean_deg": 11.23,
    "completion": 1.0,
    "loss_count": 12,
    "distance_m": 10.2,
}


@pytest.mark.parametrize("ate", [0.0123, float("nan")])
def test_table_fits_a_terminal_of_80_columns(ate):
    console = Console(width=80)
    with console.capture() as capture:
        console.print(episode_table([SimpleNamespace(config={"speed": 0.2}, summary={**SUMMARY, "ate_rmse_m": ate})]))
    text = capture.get()
    assert "…" not in text
    assert ("0.0123" in text) == (ate == 0.0123)
    assert "100.0%" in text  # completion stands beside it, always
    assert len(EPISODE_COLUMNS) == len(text.splitlines()[-2].split())
