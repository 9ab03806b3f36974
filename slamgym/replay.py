"""Recorded sequences through a SLAM: the same results as of a live drive, from frames that are on the disk."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass
from importlib.metadata import version
from typing import Any, ClassVar

import numpy as np

from slamgym.errors import ConfigError
from slamgym.eval.datasets import Sequence, read_ahead
from slamgym.eval.episode import summarize_slam
from slamgym.eval.trajectories import Trajectory, step_sizes
from slamgym.params import SlamParams
from slamgym.slam.backend import load_backend
from slamgym.slam.groundtruth import GroundTruth
from slamgym.slam.record import SlamRun, run_sequence
from slamgym.types import Frame, SlamRecord, Summary


@dataclass(frozen=True, slots=True, eq=False)
class Replay:
    """What became of one SLAM run over a recorded sequence.

    config: all parameters with their values, the camera, and the versions that the results depend on. summary: the
    content of `episode.json`.
    """

    sequence: Sequence
    config: dict[str, Any]
    slam: SlamRecord
    slam_log: str
    summary: Summary
    grid: ClassVar[None] = None
    path_xy: ClassVar[None] = None

    @property
    def truth(self) -> Trajectory | None:
        """All true poses of the sequence."""
        return self.sequence.truth

    def motion(self) -> dict[str, Any]:
        """How the camera moved, columns with a row a frame of the sequence; speeds are those since the frame before.

        NaN without a truth.
        """
        sequence = self.sequence
        step_s = np.diff(sequence.stamps_ns) * 1e-9
        unknown = np.full(len(step_s), np.nan)
        step_m, step_rad = (unknown, unknown) if sequence.truth is None else step_sizes(sequence.T_world_cam)
        position = sequence.T_world_cam[:, :3, 3]
        return {
            "stamp_ns": sequence.stamps_ns,
            "x_m": position[:, 0],
            "y_m": position[:, 1],
            "z_m": position[:, 2],
            "speed_mps": np.append(np.nan, step_m / step_s),
            "rotation_rate_radps": np.append(np.nan, step_rad / step_s),
            "has_truth": sequence.has_truth,
        }


def replay(sequence: Sequence, params: SlamParams, on_frame: Callable[[int], None] | None = None) -> Replay:
    """Feed the sequence to a SLAM, every (stride + 1)-th frame of it.

    The images are read ahead of their use, a few at a time, whatever the length of the sequence. on_frame: called with
    the number of frames done. Raises ConfigError and SlamError for the SLAM, SequenceError for an unreadable image.
    """
    if sequence.truth is None and issubclass(load_backend(params.slam), GroundTruth):
        raise ConfigError(
            f"slam backend {params.slam!r}: expected a sequence with a truth, got {sequence.name} without"
        )
    config = params.config(sequence.camera, sequence.fps)
    recorded = params.recorded(config)  # now: a program may be built anew while it runs
    with params.session(config) as session:
        session.start()  # it loads while the first frames are read
        run = SlamRun(session)
        record = run_sequence(run, _told(read_ahead(sequence, sequence.rows(params.stride)), on_frame))
        log = session.log()
    versions = {"slamgym": version("slamgym"), **recorded.pop("slam_versions")}
    return Replay(
        sequence=sequence,
        config={
            "run": {"sequence": sequence.name, "versions": versions},
            "camera": asdict(sequence.camera),
            "fps": sequence.fps,
            **recorded,
        },
        slam=record,
        slam_log=log,
        summary={
            "sequence": sequence.name,
            "end": "slam_gone" if record.outcome else "sequence_end",
            **summarize_slam(record, params.map_policy),
            "frames": len(sequence),
            "timing": run.timing(),
        },
    )


def _told(frames: Iterable[Frame], on_frame: Callable[[int], None] | None) -> Iterator[Frame]:
    for number, frame in enumerate(frames):
        if on_frame is not None:
            on_frame(number)
        yield frame
