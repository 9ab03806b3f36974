"""How long a SLAM was right: correct rate and relocalisation score of the OpenLORIS benchmark.

Shi et al., "Are we ready for service robots? The OpenLORIS-Scene datasets for lifelong SLAM", ICRA 2020; the details as
in `benchmark/evaluate.py` of openloris-scene-tools. All functions take the estimated poses (M,) in order of time:
`stamps_ns` int64, `correct` bool (`correct_poses`); and the first and last stamp of the sequence, nanoseconds.
"""

import numpy as np

from slamgym.errors import ConfigError, TrajectoryError
from slamgym.types import BoolArray, FloatArray, IntArray


def correct_poses(trans_m: FloatArray, rot_deg: FloatArray, *, max_trans_m: float, max_rot_deg: float) -> BoolArray:
    """Whether estimated poses are right (M,): both their errors, metres and degrees (M,), are at most the given ones.

    An infinite bound asks nothing; an error that is NaN is never right. Raises TrajectoryError for shapes that differ,
    ConfigError for a bound below 0.
    """
    if trans_m.ndim != 1 or trans_m.shape != rot_deg.shape:
        raise TrajectoryError(f"expected errors (M,) in pairs, got shapes {trans_m.shape} and {rot_deg.shape}")
    if not (max_trans_m >= 0 and max_rot_deg >= 0):
        raise ConfigError(f"correct poses: expected bounds of 0 or more, got {max_trans_m} m and {max_rot_deg} degrees")
    return np.asarray((trans_m <= max_trans_m) & (rot_deg <= max_rot_deg), dtype=np.bool_)


def correct_rate(
    stamps_ns: IntArray, correct: BoolArray, start_ns: int, end_ns: int, max_interval_s: float = 1.0
) -> float:
    """Share of the sequence's time, 0..1, for which the SLAM was right.

    A right pose holds until the next estimated one, the last until the end, but at most `max_interval_s`. Time before
    the start and after the end never counts; poses there are taken as at the start or the end.
    0 without poses; NaN for a sequence that lasts no time. Raises TrajectoryError, and ConfigError for an interval
    that is not above 0.
    """
    _check(stamps_ns, correct, start_ns, end_ns)
    if not max_interval_s > 0:
        raise ConfigError(f"correct rate: expected a longest interval above 0 s, got {max_interval_s}")
    holds_ns = np.diff(np.clip(np.append(stamps_ns, end_ns), start_ns, end_ns))
    correct_ns = np.minimum(holds_ns, max_interval_s * 1e9)[correct].sum()
    return float(correct_ns / (end_ns - start_ns)) if end_ns > start_ns else np.nan


def correct_rate_of_tracking(
    stamps_ns: IntArray, correct: BoolArray, start_ns: int, end_ns: int, max_interval_s: float = 1.0
) -> float:
    """`correct_rate` over the time from the first estimated pose to the end: what came before is left out.

    It flatters a SLAM that starts late; give it beside the relocalisation score, never alone.
    """
    first_ns = int(stamps_ns[0]) if len(stamps_ns) else start_ns
    return correct_rate(stamps_ns, correct, min(max(first_ns, start_ns), end_ns), end_ns, max_interval_s)


def relocalization_score(stamps_ns: IntArray, correct: BoolArray, start_ns: int, scale_s: float = 60.0) -> float:
    """exp(-(time from the start to the first estimated pose) / scale_s), 0..1; 0 when it is wrong or there is none.

    Raises TrajectoryError, and ConfigError for a scale that is not above 0.
    """
    _check(stamps_ns, correct, start_ns, start_ns)
    if not scale_s > 0:
        raise ConfigError(f"relocalisation score: expected a time scale above 0 s, got {scale_s}")
    if not (len(correct) and correct[0]):
        return 0.0
    return float(np.exp(-max(int(stamps_ns[0]) - start_ns, 0) * 1e-9 / scale_s))


def _check(stamps_ns: IntArray, correct: BoolArray, start_ns: int, end_ns: int) -> None:
    if correct.dtype != np.bool_ or stamps_ns.ndim != 1 or correct.shape != stamps_ns.shape:
        got = f"{stamps_ns.shape} and {correct.dtype} {correct.shape}"
        raise TrajectoryError(f"expected stamps (M,) and as many bool flags, got {got}")
    if (np.diff(stamps_ns) <= 0).any():
        raise TrajectoryError("expected strictly increasing stamps of estimated poses: sort them, drop repeated ones")
    if end_ns < start_ns:
        raise TrajectoryError(f"expected a sequence that ends at its start {start_ns} ns or later, got {end_ns} ns")
