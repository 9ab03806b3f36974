"""How much of a drive was tracked: in frames, in time, in distance."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from slamgym.eval.robustness.gaps import check_frames
from slamgym.eval.trajectories import step_sizes
from slamgym.types import BoolArray, FloatArray, IntArray


class Exposure(NamedTuple):
    """How long a drive was, and how much of it was tracked: the steps between two consecutive frames that both are."""

    duration_s: float
    distance_m: float
    tracked_s: float
    tracked_m: float


class Completion(NamedTuple):
    """Shares 0..1 that were tracked; see `completion`."""

    frames: float
    time: float
    distance: float


def exposure(stamps_ns: IntArray, T_world_cam: FloatArray, tracked: BoolArray) -> Exposure:
    """Time and true distance of a drive, and of its tracked steps.

    stamps_ns: int64 (N,); T_world_cam: true poses (N, 4, 4); tracked: bool (N,). A step between consecutive frames is
    tracked only when both its ends are: what happened beside a frame without a pose is not known to the SLAM.
    Raises TrajectoryError.
    """
    check_frames(stamps_ns, tracked, T_world_cam)
    step_ns, (step_m, _) = np.diff(stamps_ns), step_sizes(T_world_cam)
    both = tracked[:-1] & tracked[1:]
    return Exposure(
        duration_s=float(step_ns.sum()) * 1e-9,
        distance_m=float(step_m.sum()),
        tracked_s=float(step_ns[both].sum()) * 1e-9,
        # Added up in the same order as the whole, so that rounding never makes a part the larger one.
        tracked_m=float(np.where(both, step_m, 0.0).sum()),
    )


def total_exposure(exposures: Iterable[Exposure]) -> Exposure:
    """Sum over many drives, so that long ones count for more; zeros for none."""
    return Exposure(*map(sum, zip(Exposure(0.0, 0.0, 0.0, 0.0), *exposures, strict=True)))


def completion(stamps_ns: IntArray, T_world_cam: FloatArray, tracked: BoolArray) -> Completion:
    """Shares of a drive that were tracked: of its frames, of its time, of its true distance.

    stamps_ns: int64 (N,); T_world_cam: true poses (N, 4, 4); tracked: bool (N,), the frames with a pose in the
    evaluated map. Time and distance count by `exposure`'s tracked steps, so that a pose alone between two frames
    without one covers nothing (`covered_frames` first where an estimate has fewer poses on purpose). Without frames
    the share of frames is 0; the share of time is NaN below two frames, that of distance when nothing moved.
    Raises TrajectoryError.
    """
    return completion_of(exposure(stamps_ns, T_world_cam, tracked), tracked)


def completion_of(drive: Exposure, tracked: BoolArray) -> Completion:
    """`completion` of a drive whose `exposure` is known."""
    return Completion(
        frames=float(tracked.mean()) if len(tracked) else 0.0,
        time=drive.tracked_s / drive.duration_s if drive.duration_s > 0 else np.nan,
        distance=drive.tracked_m / drive.distance_m if drive.distance_m > 0 else np.nan,
    )
