"""Studies of a few rows, written by hand, and their comparison."""

import numpy as np
import pandas as pd

from slamgym.report.comparison import compare_studies
from slamgym.report.comparison.pairing import pair_studies
from tests.report.made_up import study


def table(rows, **columns):
    """rows: (path, speed, repeat, success, ATE); the other columns are the same for all."""
    frame = pd.DataFrame(rows, columns=["path", "speed", "repeat", "success", "ate_rmse_m"])
    frame["status"] = np.where(frame["success"], "ok", "lost")
    return frame.assign(dataset="procedural", completion=1.0, slam="orbslam3", **columns)


def repeated(spec, repeats=10, **columns):
    """spec: (path, speed, how many of the repeats fail)."""
    rows = [(path, speed, r + 1, r >= failed, 0.02) for path, speed, failed in spec for r in range(repeats)]
    return table(rows, **columns)


def compared(new, baseline, factors=()):
    return compare_studies(study(new, factors), study(baseline, factors, folder="old"))


def pairs_of(new, baseline, factors=("speed",)):
    return pair_studies(study(new, factors), study(baseline, factors, folder="old"))
