"""Studies made of numbers, with a truth that is known: for the statistics of a report, not for its run folders."""

from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd

from slamgym.study.results import StudyResults

CAUSES = ("few_keypoints", "fast_turn", "low_overlap", "unknown")


def varied_study(
    factors: dict[str, list] | None = None,
    *,
    paths: int = 12,
    repeats: int = 2,
    half_fail_at: float = 1.0,
    slope: float = 6.0,
    datasets: int = 1,
    planned: int | None = None,
    seed: int = 0,
) -> StudyResults:
    """Runs fail by a logistic curve over `speed`, where it is a factor; all other factors do nothing."""
    factors = factors or {}
    rng = np.random.default_rng(seed)
    levels = [dict(zip(factors, row, strict=True)) for row in product(*factors.values())]
    rows = [{"path_number": p, "repeat": r, **level} for p, level, r in product(range(paths), levels, range(repeats))]
    table = pd.DataFrame(rows)
    n = len(table)
    speed = table["speed"].to_numpy(float) if "speed" in table else np.full(n, half_fail_at)
    hard = rng.normal(0, 0.5, paths)[table["path_number"]]
    failed = rng.random(n) < 1 / (1 + np.exp(-slope * (speed - half_fail_at) - hard))
    number = table.pop("path_number")
    results = {
        "run_id": [f"run_{i}" for i in range(n)],
        "dataset": [f"dataset {p % datasets}" for p in number],
        "path": [f"procedural:{p // 3} #{p % 3}" for p in number],
        "drive_id": [f"drive_{p}" for p in number],
        "scene": [f"procedural:{p // 3}" for p in number],
        "status": np.where(failed, "lost", "ok"),
        "success": ~failed,
        "ate_rmse_m": np.exp(rng.normal(-3.5, 0.3, n) + 2.0 * failed),
        "rpe_trans_rmse_m": np.exp(rng.normal(-4, 0.3, n)),
        "rpe_rot_mean_deg": np.exp(rng.normal(-1, 0.3, n)),
        "completion": np.where(failed, rng.uniform(0.2, 0.9, n), 1.0),
        "loss_count": failed.astype(int),
        "frames_fed": 240,
        "fps": 30.0,
        "duration_s": 8.0,
        "distance_m": 6.0,
        "velocity_m_per_frame": speed / 30,
        "angular_velocity_deg_per_s": 10 + 5 * hard + speed,
        "loops_closed": 0,
        "frames_dropped": 0,
        "lockstep_overruns": 0,
        "timing.track_ms_median": rng.uniform(10, 15, n),
        "run.versions.slamgym": "0.1.0",
        "run.versions.house_sha256": "abc",
    }
    causes = rng.integers(0, len(CAUSES), n)
    told = {f"loss_causes.{c}": np.where(failed & (causes == i), 1.0, np.nan) for i, c in enumerate(CAUSES)}
    runs = pd.concat([table, pd.DataFrame({k: v for k, v in {**results, **told}.items() if k not in table})], axis=1)
    runs["repeat"] += 1
    return StudyResults(Path("made_up"), "varied", "Numbers.", tuple(factors), n if planned is None else planned, runs)
