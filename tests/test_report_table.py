from types import SimpleNamespace

import pytest
from rich.console import Console

from slamgym.cli.terminal import WIDTH
from slamgym.report_table import EPISODE_COLUMNS, episode_table, remarks, replay_table, spread_line

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


def row(ate, success):
    return {"ate_rmse_m": ate, "success": success}


@pytest.mark.parametrize(
    ("rows", "line"),
    [
        ([row(0.01, True), row(0.03, True)], "ATE 0.0100 to 0.0300 m, median 0.0200 m; 2 of 2 runs without a failure"),
        ([row(0.01, True), row(0.03, True), row(0.001, False)], "median 0.0300 m; 2 of 3 runs"),
        ([row(0.01, True), row(0.03, False)], "median none, since half of the runs or more failed; 1 of 2 runs"),
        ([row(float("nan"), True)] * 2, "no ATE; 2 of 2 runs without a failure"),
    ],
)
def test_spread_counts_a_failed_run_as_worse_than_any_other(rows, line):
    assert line in spread_line("fr1_xyz", rows)


def loss(cause, outcome="relocalized"):
    context = {"cause": cause, "explanation": f"it was {cause}"}
    return {"start_s": 1.0, "duration_s": 0.5, "outcome": outcome, "context": context}


def test_remarks_tell_losses_failures_and_a_lockstep_that_gave_up():
    summary = {"losses": [loss("dark")] * 12, "failure": "", "status": "ok", "lockstep_overruns": 3}
    lines = list(remarks(summary))
    assert lines[0] == "lost at 1.00 s for 0.50 s, then found again: it was dark"
    assert lines[10] == "and 2 more losses, see episode.json"
    assert "never came to rest after 3 frames" in lines[11]


def test_a_crash_is_told_once():
    crashed = {"failure": "it was crashed", "status": "crashed", "lockstep_overruns": 0}
    assert len(list(remarks({"losses": [loss("crashed", "never")], **crashed}))) == 1
    assert list(remarks({"losses": [], **crashed})) == ["crashed: it was crashed"]


def test_names_of_sequences_are_told_apart_and_figures_whole():
    figures = {"status": "init_failed", "ate_rmse_m": 0.0123, "published_ate_rmse_m": 0.01, "completion": 1.0}
    counts = {"loss_count": 12, "frames_fed": 2700, "frames_dropped": 1000, "track_ms": 123.4, "run": 100}
    names = ["rgbd_dataset_freiburg1_xyz", "rgbd_dataset_freiburg3_nostructure_texture_near_withloop"]
    console = Console(width=WIDTH)
    with console.capture() as capture:
        console.print(replay_table([{"sequence": name, **figures, **counts} for name in names]))
    assert "freiburg1_xyz" in capture.get()
    assert "0.0123" in capture.get()
    assert "123.4" in capture.get()
