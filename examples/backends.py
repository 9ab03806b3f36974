"""All SLAM backends over the same drives: each drive is rendered once, and every backend gets the same frames."""

from typing import Any

import pandas as pd
import tyro

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.params import SlamParams
from slamgym.recording import recorded_drive
from slamgym.replay import replay
from slamgym.report_table import remarks


def main(
    seeds: tuple[int, ...] = (1, 2, 3, 4, 5),
    backends: tuple[str, ...] = ("groundtruth", "wheel_odometry", "opencv", "orbslam3"),
    command: str | None = None,
    speed: float = 0.2,
    path_length_m: float = 9.0,
    scene: str = "procedural",
    camera: str = "default",
) -> None:
    """Print status, accuracy, completion and time a frame of each backend on each path.

    `--command` is the template of a program of your own, see the backend `command`.
    """
    runs: list[dict[str, Any]] = [{"slam": name} for name in backends]
    if command is not None:
        runs.append({"slam": "command", "slam_options": {"command": command}})
    rows = []
    for seed in seeds:
        drive = {"speed": speed, "path_length_m": path_length_m, "scene": scene, "camera": camera}
        with recorded_drive(PathFollower(), seed, **drive) as sequence:
            for params in runs:
                summary = replay(sequence, SlamParams.checked(params)).summary
                rows.append({"path": seed, **params, **columns(summary)})
                for line in remarks(summary):
                    print(f"path {seed}, {params['slam']}: {line}")
    print(pd.DataFrame(rows).drop(columns="slam_options", errors="ignore").to_string(index=False, float_format="%.4f"))


def columns(summary: dict[str, Any]) -> dict[str, Any]:
    """What the table shows of one run."""
    return {
        "frames": summary["frames_fed"],
        "status": summary["status"],
        "ATE m": summary["ate_rmse_m"],
        "completion": summary["completion"],
        "losses": summary["loss_count"],
        "ms a frame": summary["timing"]["track_ms_median"],
    }


if __name__ == "__main__":
    tyro.cli(main)
