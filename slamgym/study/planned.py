"""What a study consists of: drives, each rendered once, and SLAM runs, each over the frames of one drive."""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class PlannedDrive:
    """Frames that are rendered once, or that somebody recorded.

    drive_id: its name in the study, fit for a folder, the same whenever the same drive is planned. dataset: what its
    path is counted under. path: what is driven, the same at all levels of all factors, so that runs can be paired by
    it: "procedural:1 #7", or the sequence's name. params: keywords of `gym.make("HomeRobot-v0", ...)`, for a recorded
    sequence none. seed: picks the path. agent: one of `slamgym.agents.AGENTS`. sequence: folder of a recorded sequence,
    None where the environment drives.
    """

    drive_id: str
    dataset: str
    path: str
    params: dict[str, Any]
    seed: int = 0
    agent: str = "follower"
    max_episode_steps: int | None = None
    sequence: str | None = None


@dataclass(frozen=True, slots=True)
class PlannedRun:
    """One SLAM run. run_id: "DRIVE_ID/REST", its folder below `runs` of the study's, the same whenever it is planned.

    slam: fields of `SlamParams`. busy_processes: how many processes keep the computer busy meanwhile. repeat: from 1.
    levels: factor -> its level here, factors of the drive and of the SLAM.
    """

    run_id: str
    drive: PlannedDrive
    slam: dict[str, Any]
    repeat: int
    levels: dict[str, Any]
    busy_processes: int = 0
