"""What a SLAM has to offer to be driven by slamgym, and the registry of those that do."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Protocol

import numpy as np

from slamgym.camera import PinholeCamera
from slamgym.checked_params import Params
from slamgym.errors import ConfigError, unknown_word
from slamgym.plugins import load_class, named_targets
from slamgym.types import Frame, SlamEvent, SlamTrajectory, TrackingState, TrackResult


@dataclass(frozen=True, slots=True)
class SlamConfig:
    """What a backend is built from. loop_closure: None leaves the backend's own default."""

    camera: PinholeCamera
    fps: float
    loop_closure: bool | None = None
    options: Mapping[str, Any] = field(default_factory=dict)


class SlamOptions(Params):
    """The base of each backend's own options, and those of a backend that has none."""

    kind: ClassVar[str] = "slam option"

    @classmethod
    def _label(cls, name: str) -> str:
        return f"{cls.kind} {name!r}"


class Backend(Protocol):
    """One SLAM run over one sequence. It lives in a worker process, so it may crash, hang or print as it likes.

    A backend's module must import without its SLAM library: `Options`, `loop_closures`, `has_background_threads`,
    `offline`, `check` and `versions` are used in the user's process, the rest in the worker's.

    A method `map_points()`, where it has one, answers with the points (N, 3) of the map that the last frame was tracked
    by, metres in that map's frame. It is asked only by who shows a run while it goes on, and changes no result.
    """

    Options: ClassVar[type[SlamOptions]]
    """Accepted `slam_options`, each with a default; an unknown key is an error. On the command line they are text."""
    loop_closures: ClassVar[tuple[bool, ...]]
    """Values of `loop_closure` that it can honour, beside None."""
    has_background_threads: ClassVar[bool]
    """Whether work goes on after `track` returns, so that lock-step has to wait for it."""
    offline: ClassVar[bool]
    """Whether `track` only takes the frames, answering NOT_INITIALIZED, and `finish` does all the work: a frame then
    counts as tracked when the final trajectory has a pose at its stamp."""

    @classmethod
    def check(cls, config: SlamConfig) -> None:
        """Raise SlamError, saying what to install, when something is missing that can be seen without starting, and
        ConfigError for options, valid each by itself, that cannot be honoured together.
        """
        ...

    @classmethod
    def versions(cls, config: SlamConfig) -> dict[str, str]:
        """What a result depends on besides the parameters, to be recorded: versions of libraries, hashes of files."""
        ...

    def __init__(self, config: SlamConfig) -> None: ...

    def track(self, frame: Frame) -> TrackResult: ...

    def finish(self) -> SlamTrajectory:
        """Shut down and return the poses that the SLAM stands by. Called once, after the last frame."""
        ...


BACKENDS: dict[str, str] = {
    "command": "slamgym.slam.command:Command",
    "groundtruth": "slamgym.slam.groundtruth:GroundTruth",
    "opencv": "slamgym.slam.opencv_odometry:OpenCvOdometry",
    "orbslam2": "slamgym.slam.orbslam2:OrbSlam2",
    "orbslam3": "slamgym.slam.orbslam3:OrbSlam3",
    "wheel_odometry": "slamgym.slam.wheel_odometry:WheelOdometry",
}
"""Name -> "module:class". A new backend is one file and one line here."""

ENTRY_POINTS = "slamgym.slam_backends"
"""Group of entry points by which installed packages add backends of theirs."""


PARTS = ("Options", "loop_closures", "has_background_threads", "offline", "check", "versions", "track", "finish")


def backend_target(name: str) -> str:
    """The "module:class" that a name stands for: a registered one, an installed package's, or one as it is.

    Raises ConfigError.
    """
    targets = named_targets(BACKENDS, ENTRY_POINTS)
    if name not in targets and ":" not in name:
        raise ConfigError(unknown_word("slam backend", name, targets))
    return targets.get(name, name)


def load_backend(name: str) -> type[Backend]:
    """The class that a name stands for, see `backend_target`; raises ConfigError."""
    what = f"slam backend {name!r}"
    return load_class(what, backend_target(name), PARTS, "slamgym.slam.backend.Backend", SlamOptions)


def check_config(name: str, config: SlamConfig) -> type[Backend]:
    """The backend's class, when it can honour the configuration as far as the user's process can tell.

    Raises ConfigError or SlamError.
    """
    backend = load_backend(name)
    backend.Options.checked(config.options)
    if config.loop_closure is not None and config.loop_closure not in backend.loop_closures:
        choices = ", ".join(map(str, (None, *backend.loop_closures)))
        raise ConfigError(
            f"slam backend {name!r}: expected loop_closure as one of {choices}, got {config.loop_closure}"
        )
    backend.check(config)
    return backend


def untracked(state: TrackingState, event: SlamEvent = SlamEvent.NONE, tracked_points: int = 0) -> TrackResult:
    """Answer for a frame without a trusted pose."""
    return TrackResult(state, np.full((4, 4), np.nan), -1, tracked_points, event)
