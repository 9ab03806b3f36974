"""Frames without a pose, and the losses that they are. Needs no SLAM record, only which frames have one.

`tracked` is bool (N,): whether the frame has a pose in the evaluated map.
"""

import numpy as np

from slamgym.errors import ConfigError, TrajectoryError
from slamgym.eval.trajectories import Trajectory, step_sizes
from slamgym.types import BoolArray, FloatArray, IntArray, LossEvent


def check_frames(stamps_ns: IntArray, tracked: BoolArray, T_world_cam: FloatArray | None = None) -> None:
    """Raise TrajectoryError unless stamps, flags and poses, where given, are those of N frames in order of time."""
    if tracked.dtype != np.bool_ or tracked.shape != stamps_ns.shape:
        raise TrajectoryError(
            f"expected `tracked` as bool (N,), one a stamp of shape {stamps_ns.shape}, "
            f"got {tracked.dtype} of shape {tracked.shape}"
        )
    Trajectory(stamps_ns, np.broadcast_to(np.eye(4), (len(stamps_ns), 4, 4)) if T_world_cam is None else T_world_cam)


def covered_frames(stamps_ns: IntArray, poses_ns: IntArray, max_gap_s: float) -> BoolArray:
    """Which frames (N,) lie between two estimated poses at most `max_gap_s` apart: for frames, such as the poses of the
    truth, that are not those the SLAM was given.

    stamps_ns: int64 (N,), of the frames; poses_ns: int64 (M,), of all estimated poses. The time before the first pose
    and after the last one are gaps too, from the first frame and to the last. None is covered without a pose.
    Raises TrajectoryError for stamps that do not increase, ConfigError for a negative gap.
    """
    if not max_gap_s >= 0:
        raise ConfigError(f"covered frames: expected a longest gap of 0 s or more, got {max_gap_s}")
    for name, stamps in (("frames", stamps_ns), ("poses", poses_ns)):
        if (np.diff(stamps) <= 0).any():
            raise TrajectoryError(f"expected strictly increasing stamps of the {name}: sort them, drop repeated ones")
    if not (len(stamps_ns) and len(poses_ns)):
        return np.zeros(len(stamps_ns), dtype=np.bool_)
    ends_ns = np.concatenate([stamps_ns[:1], poses_ns, stamps_ns[-1:]])
    short = np.diff(ends_ns) <= np.round(max_gap_s * 1e9)
    # A frame at the stamp of a pose belongs to the gap before it as well as to that behind it.
    before, after = (np.searchsorted(poses_ns, stamps_ns, side=side) for side in ("left", "right"))
    return np.asarray(short[before] | short[after], dtype=np.bool_)


def find_gaps(stamps_ns: IntArray, T_world_cam: FloatArray | None, tracked: BoolArray) -> list[LossEvent]:
    """Loss events of plain frames: maximal runs of frames without a pose, after the first with one.

    stamps_ns: int64 (N,); T_world_cam: true poses (N, 4, 4), None where none is known; tracked: bool (N,). `start_s`
    counts from the first frame. Distance and rotation are those of the true path, added up from frame to frame, from
    the first frame of the run to the first tracked one after it, or to the last frame; NaN without true poses. The
    outcome is "relocalized", or "never" for a run that lasts to the end. Raises TrajectoryError.
    """
    check_frames(stamps_ns, tracked, T_world_cam)
    unknown = np.full(len(stamps_ns), np.nan)
    step_m, step_rad = (unknown, unknown) if T_world_cam is None else step_sizes(T_world_cam)
    return [
        LossEvent(
            start_frame=start,
            end_frame=after - 1,
            start_s=seconds(stamps_ns, 0, start),
            duration_s=seconds(stamps_ns, start, min(after, len(tracked) - 1)),
            distance_m=float(step_m[start:after].sum()),
            rotation_deg=float(np.rad2deg(step_rad[start:after].sum())),
            outcome="relocalized" if after < len(tracked) else "never",
        )
        for start, after in untracked_runs(tracked)
    ]


def untracked_runs(tracked: BoolArray) -> list[tuple[int, int]]:
    """First frame of each run of frames without a pose, after the first with one, and the first frame after the run;
    tracked: bool (N,), N after a run that lasts to the end.
    """
    # A tracked frame past the end closes a run that is still open there.
    frames = np.flatnonzero(np.append(tracked, True))
    start, after = frames[:-1] + 1, frames[1:]
    some = start < after
    return list(zip(start[some].tolist(), after[some].tolist(), strict=True))


def seconds(stamps_ns: IntArray, first: int, last: int) -> float:
    """Time from one frame to another, seconds."""
    return float(stamps_ns[last] - stamps_ns[first]) * 1e-9
