"""Drift over segments of the path, as the KITTI odometry benchmark measures it.

Geiger, Lenz, Urtasun, "Are we ready for autonomous driving? The KITTI vision benchmark suite", CVPR 2012; its
development kit's `evaluate_odometry`.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from slamgym.errors import ConfigError
from slamgym.eval.accuracy.pair_errors import PairErrors
from slamgym.eval.accuracy.pair_selection import path_steps_m
from slamgym.types import BoolArray, FloatArray, IntArray

INDOOR_LENGTHS_M = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0)


class SegmentDrift(NamedTuple):
    """Mean error at the end of a segment, by its length; NaN when there is no segment at all."""

    trans_percent: float
    rot_deg_per_m: float
    segments: int


def segment_drift(
    ref_T: FloatArray,
    est_T: FloatArray,
    lengths_m: Sequence[float] = INDOOR_LENGTHS_M,
    *,
    step: int = 10,
    tracked: BoolArray | None = None,
    map_ids: IntArray | None = None,
) -> SegmentDrift:
    """Mean relative pose error of the estimate (N, 4, 4) over segments of the true path (N, 4, 4), by their length.

    A segment of each length starts at every `step`-th frame, and ends at the first frame where the true path from there
    is longer than that length. Its error of translation and rotation is divided by the length; the mean is over all
    segments of all lengths. lengths_m: 1 to 8 m suit a drive through a house; KITTI's are 100, 200, ... 800 m. KITTI
    starts at every 10th frame, of 10 a second. tracked, map_ids: as for `rpe`; a segment counts with both ends tracked
    in one map. Raises ConfigError for lengths or a step that are not above 0, TrajectoryError for the arrays.
    """
    lengths = np.asarray(lengths_m, dtype=np.float64)
    if lengths.ndim != 1 or not len(lengths) or not (np.isfinite(lengths) & (lengths > 0)).all():
        raise ConfigError(f"expected lengths of segments above 0 m, got {lengths_m}")
    if step < 1:
        raise ConfigError(f"expected a step of at least 1 frame between the starts of segments, got {step}")
    errors = PairErrors.of(ref_T, est_T, tracked, map_ids)
    start, end, length = _segments(path_steps_m(ref_T), lengths, step)
    valid = errors.valid(start, end)
    if not valid.any():
        return SegmentDrift(np.nan, np.nan, 0)
    trans_m, rot_deg = errors.trans_m_rot_deg(start[valid], end[valid])
    length = length[valid]
    return SegmentDrift(float(100.0 * np.mean(trans_m / length)), float(np.mean(rot_deg / length)), len(length))


def _segments(steps_m: FloatArray, lengths: FloatArray, step: int) -> tuple[IntArray, IntArray, FloatArray]:
    """First frame, last frame and nominal length of every segment that the path holds."""
    along = np.concatenate([[0.0], np.cumsum(steps_m)])
    start, length = (grid.ravel() for grid in np.meshgrid(np.arange(0, len(along), step), lengths, indexing="ij"))
    end = np.searchsorted(along, along[start] + length, side="right")
    fits = end < len(along)
    return start[fits], end[fits], length[fits]
