"""About how long a study takes and what it fills, before any of it is done."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil
from pathlib import Path

from slamgym import MAX_EPISODE_STEPS
from slamgym.agents import AGENTS
from slamgym.camera import PinholeCamera
from slamgym.computer import cores
from slamgym.env import BLUR_SAMPLES
from slamgym.eval.datasets import read_sequence
from slamgym.params import DriveParams, SlamParams
from slamgym.study.planned import PlannedDrive, PlannedRun

# Measured on one core of a machine without a GPU, in furnished houses at 640x480; all grow with the pixels.
RENDER_S = 0.060
"""To render a frame, colour and depth, and to write it."""
SLAM_S = {"groundtruth": 0.010, "opencv": 0.065, "wheel_odometry": 0.010}
USUAL_SLAM_S = 0.030
"""To read a frame and to track it in lock-step; that of the ORB-SLAMs, and of what is not in the list."""
FRAME_BYTES = 550_000
"""A rendered frame, two PNG files."""

# Measured, whatever the camera.
SCENE_S = 8.0
"""To load a house and to bake its light, once."""
RUN_S = 3.0
"""To start a SLAM, and to write its run folder with a map and a picture of each loss."""
RUN_BYTES = 200_000
DRIVE_BYTES = 80_000
"""What stays of a drive when its frames are gone."""

# Measured on paths of 8 m through 12 procedural houses.
ROUND_TRIP = 1.17
"""A tour that comes back to its start is so much longer than asked for."""
SWIFTEST_MPS = 1.05
"""The mean speed over a tour with bends, however fast the robot may drive."""
METRES_A_RADIAN = 0.42
"""Driven for each radian that the robot may turn, where its turn rate is what holds it up."""

_USUAL = SlamParams()


@dataclass(frozen=True, slots=True)
class _Frames:
    """Of one drive: how many, what they show in seconds, how many pixels they have beside 640x480."""

    count: int
    duration_s: float
    size: float


@dataclass(frozen=True, slots=True)
class Estimate:
    """About what a study comes to. render_s, slam_s: for one worker. drive_bytes: frames of the longest drive, which
    are kept until its last run is done. kept_bytes: what stays.
    """

    drives: int
    runs: int
    frames_rendered: int
    frames_fed: int
    render_s: float
    slam_s: float
    drive_bytes: int
    kept_bytes: int

    def seconds(self, workers: int = 1) -> float:
        """Time with so many workers, each on a core of its own."""
        return (self.render_s + self.slam_s) / min(workers, max(self.runs, 1))

    def disk_bytes(self, workers: int = 1) -> int:
        """The most on the disk at a time: what stays, and the frames that so many workers, and one ahead, use."""
        return self.kept_bytes + self.drive_bytes * min(workers + 1, self.drives)


def estimate(runs: Sequence[PlannedRun]) -> Estimate:
    """From the parameters of the runs; only of recorded sequences the lists of files are read.

    Raises SequenceError for those.
    """
    drives = {run.drive.drive_id: run.drive for run in runs}
    frames = {drive_id: _frames(drive) for drive_id, drive in drives.items()}
    rendered = {drive_id: frames[drive_id] for drive_id, drive in drives.items() if drive.sequence is None}
    scenes = {drives[drive_id].params["scene"] for drive_id in rendered}
    return Estimate(
        drives=len(drives),
        runs=len(runs),
        frames_rendered=sum(one.count for one in rendered.values()),
        frames_fed=sum(_fed(run, frames[run.drive.drive_id]) for run in runs),
        render_s=len(scenes) * SCENE_S + sum(_render_s(drives[key], one) for key, one in rendered.items()),
        slam_s=sum(_slam_s(run, frames[run.drive.drive_id]) for run in runs),
        drive_bytes=max((round(one.count * one.size * FRAME_BYTES) for one in rendered.values()), default=0),
        kept_bytes=len(runs) * RUN_BYTES + len(drives) * DRIVE_BYTES,
    )


def _frames(drive: PlannedDrive) -> _Frames:
    if drive.sequence is not None:
        sequence = read_sequence(Path(drive.sequence))
        return _Frames(len(sequence), len(sequence) / sequence.fps, _size(sequence.camera))
    params = DriveParams.checked(drive.params)
    length_m = params.path_length_m * _tour_length(drive.agent)
    duration_s = length_m / min(params.speed, SWIFTEST_MPS, METRES_A_RADIAN * params.top_turn_rate)
    count = min(ceil(duration_s * params.fps) + 1, drive.max_episode_steps or MAX_EPISODE_STEPS)
    return _Frames(count, count / params.fps, _size(params.camera))


def _tour_length(agent: str) -> float:
    """How many times as long as asked for its tour is."""
    tour = getattr(AGENTS[agent], "reset_options", {}).get("tour", "one_way")
    return 1.0 if tour == "one_way" else ROUND_TRIP


def _size(camera: PinholeCamera) -> float:
    return camera.width * camera.height / (640 * 480)


def _render_s(drive: PlannedDrive, frames: _Frames) -> float:
    params = DriveParams.checked(drive.params)
    images = BLUR_SAMPLES if params.motion_blur else 1
    return frames.count * frames.size * images * RENDER_S * (3 if params.multisampling else 1)


def _fed(run: PlannedRun, frames: _Frames) -> int:
    return ceil(frames.count / (int(run.slam.get("stride", _USUAL.stride)) + 1))


def _slam_s(run: PlannedRun, frames: _Frames) -> float:
    if run.slam.get("slam_sync", _USUAL.slam_sync) == "realtime":
        return RUN_S + frames.duration_s
    crowding = max(1.0, run.busy_processes / cores())
    return (
        RUN_S + _fed(run, frames) * frames.size * SLAM_S.get(run.slam.get("slam", _USUAL.slam), USUAL_SLAM_S) * crowding
    )
