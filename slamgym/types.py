"""Data that passes between the layers: frozen, slotted, and without dependencies but NumPy.

Transforms are float64 arrays of shape (4, 4) or (N, 4, 4); `T_a_b` maps points of frame b into frame a. Lengths are
metres, stamps integer nanoseconds. The camera frame is optical: x right, y down, z forward.
"""

from dataclasses import dataclass
from enum import IntEnum, StrEnum
from typing import Any

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
    T_world_cam: true pose (4, 4); only the `groundtruth` backend looks at it.
    """

    stamp_ns: int
    rgb: NDArray[np.uint8]
    depth: NDArray[np.float32]
    T_world_cam: FloatArray


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


@dataclass(frozen=True, slots=True, eq=False)
class SlamRecord:
    """One whole SLAM run over N fed frames, as the evaluation needs it.

    stamps_ns: int64 (N,). T_world_cam: true poses (N, 4, 4). states: TrackingState codes, int64 (N,).
    T_map_cam: poses as they were emitted (N, 4, 4), NaN where the state is not OK. map_id: int64 (N,), -1 where the
    state is not OK. tracked_points: int64 (N,). events: N SlamEvents. final: see `SlamTrajectory`.
    outcome: "" when the SLAM ran to its end, else "crashed" or "timeout". lockstep_overruns: fed frames after which the
    SLAM's threads still worked when the longest wait of lock-step was over.
    """

    stamps_ns: IntArray
    T_world_cam: FloatArray
    states: IntArray
    T_map_cam: FloatArray
    map_id: IntArray
    tracked_points: IntArray
    events: tuple[SlamEvent, ...]
    final: SlamTrajectory
    outcome: str = ""
    lockstep_overruns: int = 0


@dataclass(frozen=True, slots=True)
class LossEvent:
    """A maximal run of fed frames, after the first initialisation, whose state is not OK.

    start_frame, end_frame: first and last fed frame of the run, inclusive. duration_s: from the first lost frame to the
    first tracked one after it, or to the last fed frame. distance_m, rotation_deg: true motion in that time.
    outcome: "relocalized", "new_map", "map_reset" or "never".
    """

    start_frame: int
    end_frame: int
    start_s: float
    duration_s: float
    distance_m: float
    rotation_deg: float
    outcome: str


Summary = dict[str, Any]
