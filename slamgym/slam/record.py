"""From the frames that a SLAM was fed to the record that the evaluation needs."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from slamgym.slam.session import SlamSession
from slamgym.types import FloatArray, Frame, SlamRecord, SlamTrajectory, TrackResult


class Fed(NamedTuple):
    """One frame's stamp and true pose, and what the SLAM said about it."""

    stamp_ns: int
    T_world_cam: FloatArray
    result: TrackResult


def feed(session: SlamSession, frame: Frame) -> Fed:
    """Give one frame to the SLAM."""
    return Fed(frame.stamp_ns, frame.T_world_cam, session.track(frame))


def finish(session: SlamSession, fed: Sequence[Fed]) -> SlamRecord:
    """End the run and put together the record of its frames, of which there must be at least one."""
    final: SlamTrajectory = session.finish()
    results = [one.result for one in fed]
    return SlamRecord(
        stamps_ns=np.array([one.stamp_ns for one in fed], dtype=np.int64),
        T_world_cam=np.array([one.T_world_cam for one in fed]),
        states=np.array([result.state for result in results], dtype=np.int64),
        T_map_cam=np.array([result.T_map_cam for result in results]),
        map_id=np.array([result.map_id for result in results], dtype=np.int64),
        tracked_points=np.array([result.tracked_points for result in results], dtype=np.int64),
        events=tuple(result.event for result in results),
        final=final,
        outcome=session.outcome,
        lockstep_overruns=session.lockstep_overruns,
    )


def run_sequence(session: SlamSession, frames: Iterable[Frame]) -> SlamRecord:
    """Feed a whole sequence, in order, until its end or that of the SLAM."""
    fed: list[Fed] = []
    for frame in frames:
        fed.append(feed(session, frame))
        if session.outcome:
            break
    return finish(session, fed)
