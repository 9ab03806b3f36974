"""A study from Python: what are two backends worth at two speeds, on the same paths?"""

import sys
from pathlib import Path

import tyro

from slamgym.errors import SlamgymError
from slamgym.study.run import run_study
from slamgym.study.spec import StudySpec


def main(
    scenes: tuple[str, ...] = ("procedural:1", "procedural:2"),
    speeds: tuple[float, ...] = (0.4, 1.2),
    slams: tuple[str, ...] = ("orbslam3", "opencv"),
    path_length_m: float = 8.0,
    camera: str = "default",
    out: Path = Path("out/own_study"),
) -> None:
    """Drive one lap in each of `scenes` at each of `speeds` (m/s). out: a new folder, or this study's, to go on."""
    study = StudySpec.checked(
        {
            "name": "own_study",
            "paths": [{"scene": list(scenes), "seeds": [1]}],
            "fixed": {"agent": "lap", "path_length_m": path_length_m, "camera": camera},
            "factors": [{"slam": list(slams)}, {"speed": list(speeds)}],
        }
    )
    runs = run_study(study, out).runs
    columns = ["path", "slam", "speed", "status", "completion", "loss_count", "ate_rmse_m"]
    print(runs[columns].to_string(index=False))


if __name__ == "__main__":  # the study's worker processes import this file
    try:
        tyro.cli(main)
    except SlamgymError as error:
        sys.exit(f"own_study: {error}")
