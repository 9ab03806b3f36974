"""Made-up studies with the noise that real ones have."""

from pathlib import Path

import numpy as np
import pandas as pd

from slamgym.study.results import StudyResults


def study(table: pd.DataFrame, factors: tuple[str, ...] = (), name: str = "speed", folder: str = "new") -> StudyResults:
    return StudyResults(Path(folder), name, "", factors, len(table), table)


def runs(
    paths: int = 30,
    repeats: int = 3,
    speeds: tuple[float, ...] = (0.2, 0.8),
    ate_factor: float = 1.0,
    more_failures: float = 0.0,
    time_factor: float = 1.0,
    seed: int = 0,
) -> pd.DataFrame:
    """Rows of a table of runs: the paths have their own difficulty, the same whatever the seed; repeats scatter.

    ATE is log-normal, 30 % from repeat to repeat, and fails with a path's own probability, a few percent as a rule.
    """
    of_paths, rng = np.random.default_rng(99), np.random.default_rng(seed)
    hard = of_paths.beta(0.4, 6.0, paths)
    usual_ate = 0.02 * np.exp(of_paths.normal(0.0, 0.6, paths))
    grid = np.array([(p, s, r) for p in range(paths) for s in range(len(speeds)) for r in range(repeats)])
    p, s = grid[:, 0], grid[:, 1]
    failed = rng.random(len(grid)) < np.clip(hard[p] + more_failures, 0, 1)
    ate = ate_factor * usual_ate[p] * (1 + s) * np.exp(rng.normal(0.0, 0.3, len(grid)))
    losses = np.where(failed, rng.integers(1, 4, len(grid)), 0)
    return pd.DataFrame(
        {
            "run_id": [f"d{a}/{b}/{c}" for a, b, c in grid],
            "dataset": "procedural",
            "path": [f"procedural:1 #{a}" for a in p],
            "drive_id": [f"d{a}-{b}" for a, b, _ in grid],
            "repeat": grid[:, 2] + 1,
            "speed": np.array(speeds)[s],
            "slam": "orbslam3",
            "run.versions.pyorbslam3": "0.1.1",
            "status": np.where(failed, "lost", "ok"),
            "success": ~failed,
            "ate_rmse_m": ate,
            "completion": np.where(failed, rng.uniform(0.2, 0.9, len(grid)), 1.0),
            "losses_per_metre": losses / 8.0,
            "losses_per_minute": losses * 1.5,
            "timing.track_ms_median": time_factor * 14.0 * np.exp(rng.normal(0.0, 0.05, len(grid))),
        }
    )
