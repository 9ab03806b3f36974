"""Hand-made SLAM runs: one letter a fed frame tells what the SLAM said."""

from collections.abc import Callable, Mapping

import numpy as np
import pytest

from slamgym.geometry import inverse, mast_camera_pose
from slamgym.types import FloatArray, SlamEvent, SlamRecord, SlamTrajectory, TrackingState

RecordMaker = Callable[..., SlamRecord]
FRAME_S = 0.1
MAP_ORIGINS = [mast_camera_pose(x, 1.0, 0.5 * x, 0.3) for x in range(10)]


def drive(n: int) -> FloatArray:
    """True poses (n, 4, 4) of a curved drive: 0.1 m and 0.05 rad a frame."""
    yaw = 0.05 * np.arange(n)
    xy = np.cumsum(0.1 * np.column_stack([np.cos(yaw), np.sin(yaw)]), axis=0)
    return np.array([mast_camera_pose(xy[i, 0], xy[i, 1], yaw[i], 1.0) for i in range(n)]).reshape(n, 4, 4)


@pytest.fixture(scope="session")
def make_record() -> RecordMaker:
    """make_record("..00xx00") is a run whose poses are perfect: a digit for a frame tracked in that map, "." for not
    initialised, "x" for lost.

    final: the maps of the final trajectory, "." for a frame without a final pose; by default as they were fed.
    events: frame -> event. online_error_m: how far emitted poses are off, to and fro along the view.
    """

    def make(
        online: str,
        final: str | None = None,
        events: Mapping[int, SlamEvent] | None = None,
        outcome: str = "",
        online_error_m: float = 0.0,
    ) -> SlamRecord:
        n = len(online)
        T_world_cam = drive(n)
        map_id = np.array([int(c) if c.isdigit() else -1 for c in online], dtype=np.int64)
        final_id = [int(c) if c.isdigit() else -1 for c in (online if final is None else final)]
        rows = np.array([i for i in range(n) if final_id[i] >= 0], dtype=np.int64)
        stamps_ns = 10_000_000_000 + np.arange(n, dtype=np.int64) * int(FRAME_S * 1e9)
        T_map_cam = np.full((n, 4, 4), np.nan)
        for i in np.flatnonzero(map_id >= 0):
            T_map_cam[i] = inverse(MAP_ORIGINS[map_id[i]]) @ T_world_cam[i]
            T_map_cam[i, :3, 3] += T_map_cam[i, :3, 2] * online_error_m * (-1) ** i
        states = {".": TrackingState.NOT_INITIALIZED, "x": TrackingState.LOST}
        poses = [inverse(MAP_ORIGINS[final_id[i]]) @ T_world_cam[i] for i in rows]
        return SlamRecord(
            stamps_ns=stamps_ns,
            T_world_cam=T_world_cam,
            states=np.array([states.get(c, TrackingState.OK) for c in online], dtype=np.int64),
            T_map_cam=T_map_cam,
            map_id=map_id,
            tracked_points=np.arange(n, dtype=np.int64),
            events=tuple((events or {}).get(i, SlamEvent.NONE) for i in range(n)),
            final=SlamTrajectory(
                stamps_ns[rows], np.array(poses).reshape(-1, 4, 4), np.array(final_id, dtype=np.int64)[rows]
            ),
            outcome=outcome,
        )

    return make
