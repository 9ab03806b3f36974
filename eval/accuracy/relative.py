"""Relative pose error.

Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012.
"""

from slamgym.eval.accuracy.error_stats import PoseErrorStats
from slamgym.eval.accuracy.pair_errors import PairErrors
from slamgym.eval.accuracy.pair_selection import select_pairs
from slamgym.types import BoolArray, FloatArray, IntArray


def rpe(
    ref_T: FloatArray,
    est_T: FloatArray,
    delta: float = 1,
    unit: str = "frames",
    *,
    pairs: str = "all",
    stamps_ns: IntArray | None = None,
    tracked: BoolArray | None = None,
    map_ids: IntArray | None = None,
    tolerance: float | None = None,
) -> PoseErrorStats:
    """Relative pose error of the estimate (N, 4, 4) against the truth (N, 4, 4) over pairs of frames `delta` apart.

    unit: "frames"; "seconds" of stamps_ns, int64 (N,), increasing; or "metres" along the true path.
    pairs: "all", each frame with a later one: exactly `delta` frames on, or the nearest to `delta` seconds or metres on
    (the earlier of two), where it is off by at most `tolerance`, a share of `delta` (0.1 when left out); "consecutive",
    from the first frame on, each pair from the end of the last one to the first frame at least `delta` on. In frames
    and metres these are evo's pairs (`all_pairs`, `pairs_from_reference`); in seconds the same on the stamps.
    tracked: bool (N,), where `est_T` holds a pose; everywhere when left out. map_ids: int64 (N,), the map of each pose;
    one map when left out.

    Which frames make a pair depends on the truth alone: frames without a pose keep their place, and the pair counts
    when both its ends are tracked in one map. All NaN when none does. Raises ConfigError for options that are wrong or
    contradict each other, TrajectoryError for the arrays.
    """
    errors = PairErrors.of(ref_T, est_T, tracked, map_ids)
    start, end = select_pairs(ref_T, delta, unit, pairs, stamps_ns, tolerance)
    valid = errors.valid(start, end)
    return PoseErrorStats.of(*errors.trans_m_rot_deg(start[valid], end[valid]))
