"""Data that passes between the layers: frozen, slotted, and without dependencies but NumPy.

Transforms are float64 arrays of shape (4, 4) or (N, 4, 4); `T_a_b` maps points of frame b into frame a. Lengths are
metres, stamps integer nanoseconds. The camera frame is optical: x right, y down, z forward.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum, StrEnum
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
IndexPair = tuple[IntArray, IntArray]


class TrackingState(IntEnum):
    """What a SLAM says about one frame. A guessed pose is LOST."""

    NOT_INITIALIZED = 0
    OK = 1
    LOST = 2

    @property
    def label(self) -> str:
        return self.name.lower()


class SlamEvent(StrEnum):
    """What changed at one frame."""

    NONE = ""
    INITIALIZED = "initialized"
    LOST = "lost"
    RELOCALIZED = "relocalized"
    NEW_MAP = "new_map"
    MAP_RESET = "map_reset"
    MAPS_MERGED = "maps_merged"
    LOOP_CLOSED = "loop_closed"
    CRASHED = "crashed"
    TIMEOUT = "timeout"


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """One RGB-D image pair.

    rgb: uint8 (H, W, 3). depth: float32 (H, W), metres along the optical axis, 0 where nothing was measured.
    T_world_cam: true pose (4, 4), NaN where nothing is known of it; only the backends `groundtruth` and
    `wheel_odometry` look at it. has_truth: False where it is interpolated in a hole of the truth: good enough to tell
    how the camera moved, not to judge a pose by.
    """

    stamp_ns: int
    rgb: NDArray[np.uint8]
    depth: NDArray[np.float32]
    T_world_cam: FloatArray
    has_truth: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class TrackResult:
    """What a SLAM said right after one frame. `T_map_cam` (4, 4) is NaN and `map_id` -1 unless the state is OK."""

    state: TrackingState
    T_map_cam: FloatArray
    map_id: int
    tracked_points: int
    event: SlamEvent = SlamEvent.NONE


@dataclass(frozen=True, slots=True, eq=False)
class SlamTrajectory:
    """Poses that a SLAM stands by at the end of a run, after loop closing and bundle adjustment.

    stamps_ns: int64 (M,), increasing. T_map_cam: (M, 4, 4). map_id: int64 (M,); poses of different maps share no
    origin and must never be aligned together.
    """

    stamps_ns: IntArray
    T_map_cam: FloatArray
    map_id: IntArray

    @classmethod
    def of(cls, poses: Sequence[tuple[int, FloatArray, int]] = ()) -> Self:
        """From the stamp, nanoseconds, T_map_cam (4, 4) and the map of each pose, in the order of the stamps."""
        return cls(
            stamps_ns=np.array([stamp_ns for stamp_ns, _, _ in poses], dtype=np.int64),
            T_map_cam=np.array([T_map_cam for _, T_map_cam, _ in poses], dtype=np.float64).reshape(-1, 4, 4),
            map_id=np.array([map_id for _, _, map_id in poses], dtype=np.int64),
        )


@dataclass(frozen=True, slots=True)
class LossContext:
    """What the SLAM was given when it got lost: at the first lost frame, beside what had been usual just before.

    All but the last two are NaN where they cannot be told. `usual_*`: medians over the tracked frames of the second
    before. Image measures are those of `slamgym.eval.views`.

    speed_mps, rotation_rate_degps: true motion of the camera; for a level robot the second is its yaw rate.
    frame_gap_s: since the last fed frame; usual_frame_gap_s.
    overlap: share of the last fed frame's view that is still in view. keypoints, sharpness, brightness: of the image.
    valid_depth: share of the pixels with a depth; median_depth_m: over these. tracked_points: at the last tracked
    frame; tracked_points_slope: their change over the second before, 1/s.
    cause: a word of `slamgym.eval.robustness.CAUSES`, "unknown" where nothing stands out; "crashed" or "timeout" when
    the SLAM was gone. explanation: it in words, with the figures that it rests on.
    """

    speed_mps: float
    rotation_rate_degps: float
    frame_gap_s: float
    usual_frame_gap_s: float
    overlap: float
    keypoints: float
    usual_keypoints: float
    sharpness: float
    usual_sharpness: float
    brightness: float
    valid_depth: float
    median_depth_m: float
    tracked_points: float
    tracked_points_slope: float
    cause: str = "unknown"
    explanation: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class SlamRecord:
    """One whole SLAM run over N fed frames, as the evaluation needs it.

    stamps_ns: int64 (N,). T_world_cam: true poses (N, 4, 4). states: TrackingState codes, int64 (N,).
    T_map_cam: poses as they were emitted (N, 4, 4), NaN where the state is not OK. map_id: int64 (N,), -1 where the
    state is not OK. tracked_points: int64 (N,). events: N SlamEvents. final: see `SlamTrajectory`.
    has_truth: bool (N,), False where the true pose is only interpolated; None: it is known everywhere.
    outcome: "" when the SLAM ran to its end, else "crashed" or "timeout"; failure: what happened then, in one line;
    log_tail: the last lines that it printed. contexts: first frame of a loss -> what was seen then.
    lockstep_overruns: fed frames after which the SLAM's threads still worked when the longest wait of lock-step was
    over. frames_dropped: frames that were not fed because the SLAM was busy with an earlier one ("realtime").
    """

    stamps_ns: IntArray
    T_world_cam: FloatArray
    states: IntArray
    T_map_cam: FloatArray
    map_id: IntArray
    tracked_points: IntArray
    events: tuple[SlamEvent, ...]
    final: SlamTrajectory
    has_truth: BoolArray | None = None
    outcome: str = ""
    failure: str = ""
    log_tail: str = ""
    contexts: Mapping[int, LossContext] = field(default_factory=dict)
    lockstep_overruns: int = 0
    frames_dropped: int = 0


@dataclass(frozen=True, slots=True)
class LossEvent:
    """A maximal run of fed frames, after the first initialisation, whose state is not OK.

    start_frame, end_frame: first and last fed frame of the run, inclusive. duration_s: from the first lost frame to the
    first tracked one after it, or to the last fed frame. distance_m, rotation_deg: true motion in that time.
    outcome: "relocalized", "new_map", "map_reset" or "never". context: what was seen at its start; None where only
    poses are known.
    """

    start_frame: int
    end_frame: int
    start_s: float
    duration_s: float
    distance_m: float
    rotation_deg: float
    outcome: str
    context: LossContext | None = None


Summary = dict[str, Any]
