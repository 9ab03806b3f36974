"""Which pairs of frames a relative error is taken over.

Frames lie one after another on an axis: that of their number, of their stamps, or of the length of the true path. An
axis is given by its steps (N - 1,), how far each frame lies behind the one before, never below 0.
"""

import math
from typing import cast

import numpy as np

from slamgym.errors import ConfigError, TrajectoryError, unknown_word
from slamgym.types import FloatArray, IndexPair, IntArray

UNITS = ("frames", "seconds", "metres")
PAIRS = ("all", "consecutive")
TOLERANCE = 0.1
"""Of what a pair may be off the wanted distance, as a share of it, unless told otherwise; evo's default."""

_NS_PER_S = 1_000_000_000


def select_pairs(
    ref_T: FloatArray, delta: float, unit: str, pairs: str, stamps_ns: IntArray | None, tolerance: float | None
) -> IndexPair:
    """Indices of the frames where the pairs start and end, for the options of `rpe`."""
    if pairs not in PAIRS:
        raise ConfigError(unknown_word("kind of pairs", pairs, PAIRS))
    steps, distance = _axis(ref_T, delta, unit, stamps_ns)
    if tolerance is not None and (pairs, unit) not in (("all", "seconds"), ("all", "metres")):
        raise ConfigError(
            f"expected a tolerance only with pairs 'all' in seconds or metres, got one with {pairs!r} in {unit}: "
            "leave it out"
        )
    if pairs == "consecutive":
        return consecutive_pairs(steps, distance)
    if tolerance is None:
        tolerance = 0.0 if unit == "frames" else TOLERANCE
    if not 0 <= tolerance < 1:
        raise ConfigError(f"expected a tolerance from 0 to below 1, a share of the distance, got {tolerance}")
    return nearest_pairs(steps, distance, tolerance)


def nearest_pairs(steps: FloatArray, distance: float, tolerance: float) -> IndexPair:
    """For each frame the later one nearest to `distance` behind it, where it is off by at most `tolerance * distance`.

    Of two equally near ones the earlier is taken; as evo's pairs by path.
    """
    along = np.concatenate([[0.0], np.cumsum(steps)])
    start = np.arange(len(steps))
    after = np.clip(np.searchsorted(along, along[start] + distance), start + 1, len(steps))
    # Of frames that stand in one place the first.
    before = np.maximum(np.searchsorted(along, along[after - 1]), start + 1)
    off_after, off_before = (np.abs(along[end] - along[start] - distance) for end in (after, before))
    end = np.where(off_before <= off_after, before, after)
    near = np.minimum(off_before, off_after) <= tolerance * distance
    return start[near], end[near]


def consecutive_pairs(steps: FloatArray, distance: float) -> IndexPair:
    """From the first frame on, pairs that end at the first frame at least `distance` on and start where the last ended.

    As evo's pairs by path.
    """
    ends, since_end = [0], 0.0
    for frame, step in enumerate(steps.tolist(), start=1):
        since_end += step
        if since_end >= distance:
            ends.append(frame)
            since_end = 0.0
    return np.array(ends[:-1], dtype=np.int64), np.array(ends[1:], dtype=np.int64)


def path_steps_m(ref_T: FloatArray) -> FloatArray:
    """Distances (N - 1,), metres, between the positions of successive poses (N, 4, 4)."""
    return cast(FloatArray, np.linalg.norm(np.diff(ref_T[:, :3, 3], axis=0), axis=1))


def _axis(ref_T: FloatArray, delta: float, unit: str, stamps_ns: IntArray | None) -> tuple[FloatArray, float]:
    """The steps (N - 1,) of the axis in `unit`, and `delta` on it."""
    if unit not in UNITS:
        raise ConfigError(unknown_word("unit", unit, UNITS))
    if not (math.isfinite(delta) and delta > 0):
        raise ConfigError(f"expected a finite distance above 0 between the ends of a pair, got {delta} {unit}")
    if (unit == "seconds") != (stamps_ns is not None):
        wanted, got = ("stamps_ns", "none") if stamps_ns is None else ("no stamps_ns", "some")
        raise ConfigError(f"expected {wanted} for pairs in {unit}, got {got}: only unit 'seconds' takes them")
    if stamps_ns is not None:
        return _time_axis(stamps_ns, len(ref_T), delta)
    if unit == "metres":
        return path_steps_m(ref_T), float(delta)
    if delta != round(delta):
        raise ConfigError(f"expected a whole number of frames, got {delta}: seconds and metres may be broken")
    return np.ones(max(len(ref_T) - 1, 0)), float(delta)


def _time_axis(stamps_ns: IntArray, n: int, delta_s: float) -> tuple[FloatArray, float]:
    """In nanoseconds: whole numbers, which float64 adds up exactly for 104 days."""
    if stamps_ns.shape != (n,) or stamps_ns.dtype != np.int64:
        got = f"{stamps_ns.dtype} of shape {stamps_ns.shape}"
        raise TrajectoryError(f"expected stamps as int64 nanoseconds of shape ({n},), one a pose, got {got}")
    steps = np.diff(stamps_ns)
    if (steps <= 0).any():
        raise TrajectoryError(f"expected stamps that increase, got a step back after pose {np.argmax(steps <= 0)}")
    if (delta_ns := round(delta_s * _NS_PER_S)) < 1:
        raise ConfigError(f"expected at least a nanosecond between the ends of a pair, got {delta_s} s")
    return steps.astype(np.float64), float(delta_ns)
