"""What a SLAM has to offer to be driven by slamgym, and the registry of those that do."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Protocol

from pydantic import BaseModel

from slamgym.camera import PinholeCamera
from slamgym.types import Frame, SlamTrajectory, TrackResult


@dataclass(frozen=True, slots=True)
class SlamConfig:
    """What a backend is built from. loop_closure: None leaves the backend's own default."""

    camera: PinholeCamera
    fps: float
    loop_closure: bool | None = None
    options: Mapping[str, Any] = field(default_factory=dict)


class Backend(Protocol):
    """One SLAM run over one sequence. It lives in a worker process, so it may crash, hang or print as it likes.

    A backend's module must import without its SLAM library: `Options`, `supports_loop_closure` and
    `has_background_threads` are read in the user's process, `__init__` and the rest run in the worker's.
    """

    Options: ClassVar[type[BaseModel]]
    """Accepted `slam_options`; an unknown key is an error."""
    supports_loop_closure: ClassVar[bool]
    has_background_threads: ClassVar[bool]
    """Whether work goes on after `track` returns, so that lock-step has to wait for it."""

    def __init__(self, config: SlamConfig) -> None: ...

    def track(self, frame: Frame) -> TrackResult: ...

    def finish(self) -> SlamTrajectory:
        """Shut down and return the poses that the SLAM stands by. Called once, after the last frame."""
        ...


BACKENDS: dict[str, str] = {
    "groundtruth": "slamgym.slam.groundtruth:GroundTruth",
    "orbslam3": "slamgym.slam.orbslam3:OrbSlam3",
}
"""Name -> "module:class". A new backend is one file and one line here."""
