"""What do many runs say together? Reads the run folders below a folder, such as that of speed_sweep.py."""

import json
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import tyro
import yaml

from slamgym.errors import SlamgymError
from slamgym.eval.plots import plot_failure_curve, plot_sorted_bars, save_figure
from slamgym.eval.robustness import average, status_counts
from slamgym.eval.statistics import failure_curve, failure_threshold


def main(folder: tyro.conf.Positional[Path], factor: str = "speed", pictures: Path | None = None) -> None:
    """Print how runs failed, by `factor`, a parameter that they differ in. pictures: folder to write figures to."""
    runs = pd.DataFrame([load(path.parent) for path in sorted(folder.rglob("episode.json"))])
    if runs.empty:
        sys.exit(f"analyse_runs: expected run folders with an episode.json below {folder}, got none")
    if factor not in runs or not pd.api.types.is_numeric_dtype(runs[factor]):
        sys.exit(f"analyse_runs: expected a number that the runs differ in as factor, such as speed, got {factor!r}")
    levels, failed = runs[factor].to_numpy(), ~runs["success"].to_numpy()
    ate, held_ate = (runs[key].to_numpy(np.float64) for key in ("ate_rmse_m", "ate_held_rmse_m"))
    print(f"{len(runs)} runs:", ", ".join(f"{n} {status}" for status, n in status_counts(runs["status"]).items() if n))
    print("ATE m, failed runs ranked last:", average(ate, failed, "penalise", penalty=np.inf))
    print("ATE m, failed runs at their last pose:", average(ate, failed, "hold_last_pose", held=held_ate))
    curve = failure_curve(levels, failed, groups=runs["path"])
    print(f"{factor}: {curve.verdict}")
    print("ATE m:", failure_threshold(ate).verdict)
    if pictures is not None:
        by_level = runs.assign(failed=failed).groupby(factor)["failed"].agg(["sum", "count"])
        shares = plot_failure_curve(by_level.index, by_level["sum"], by_level["count"], curve, factor=factor)
        bars = plot_sorted_bars({"all runs": np.where(failed, np.nan, ate)})
        for name, figure in {"failure_curve": shares, "sorted_bars": bars}.items():
            print(save_figure(figure, pictures / name)[1])


def load(folder: Path) -> dict[str, object]:
    """Parameters and results of one run; runs of one scene and seed drove the same path."""
    config = yaml.safe_load((folder / "config.yaml").read_text())
    result = json.loads((folder / "episode.json").read_text())
    return {**result, **config, "path": f"{config['scene']} {result['seed']}"}


if __name__ == "__main__":
    try:
        tyro.cli(main)
    except SlamgymError as error:
        sys.exit(f"analyse_runs: {error}")
