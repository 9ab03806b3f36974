"""The parameters of the environments: every keyword of `gym.make`, checked in one place and recorded with results."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import Field, field_validator, model_validator

from slamgym.camera import CAMERAS, PinholeCamera, resolve_camera
from slamgym.checked_params import Params
from slamgym.errors import ConfigError, unknown_word
from slamgym.eval.robustness import MapPolicy
from slamgym.render import MAX_BRIGHTNESS, Lighting, Multisampling
from slamgym.scenes.registry import SceneSource, find_scene
from slamgym.slam.backend import SlamConfig, load_backend
from slamgym.slam.session import Limits, SlamSession, Sync

RADIUS_OF_TURN = 0.25
"""metres; `turn_rate=None` turns at speed / RADIUS_OF_TURN, so that another speed retimes the same path."""

_LIMITS = Limits()

LONGEST_STEP_M = 0.4
"""More than that between two frames, and progress along a path that crosses itself cannot be told."""


class DriveParams(Params):
    """The house, the drive through it and the camera."""

    scene: str = Field("procedural", description="house: 'procedural:SEED', 'sweethome:SEED', or a file")
    scene_options: dict[str, Any] = Field(default_factory=dict, description="options of the scene's loader")
    occupancy_map: Path | None = Field(
        None, description="YAML file of a ROS map_server map, in place of the grid computed from the scene"
    )
    speed: float = Field(0.2, gt=0, le=10, description="top speed, m/s")
    turn_rate: float | None = Field(
        None, gt=0, le=50, description=f"top turn rate, rad/s; None: speed / {RADIUS_OF_TURN} m"
    )
    fps: float = Field(30.0, ge=1, le=1000, description="frames a simulated second; one step is one frame")
    path_length_m: float = Field(10.0, ge=0.5, le=10_000, description="length of the planned path, m")
    camera: PinholeCamera = Field(CAMERAS["default"], description="a preset's name, or a PinholeCamera")
    camera_height: float = Field(0.83, ge=0.1, le=2.0, description="height of the camera above the floor, m")
    depth_noise: Literal["none", "icl_nuim"] = Field("none", description="noise of the depth sensor")
    rgb_noise: float = Field(0.0, ge=0, le=128, description="standard deviation of the image noise, grey levels")
    motion_blur: float = Field(0.0, ge=0, le=1, description="exposure time as a share of the time between frames")
    lighting: Lighting = Field("baked", description="baked light, or the bare textures")
    brightness: float = Field(1.0, gt=0, le=MAX_BRIGHTNESS, description="factor of all grey values, cut off at white")
    multisampling: Multisampling = Field(
        0,
        description="samples a pixel of the colour image: 0 for one at its centre, or 4 for smooth edges at three "
        "times the cost; depth always has one",
    )

    @field_validator("multisampling", mode="before")
    @classmethod
    def _as_number(cls, samples: Any) -> Any:
        """From the command line it comes as text, which pydantic does not take for one of some numbers."""
        return int(samples) if isinstance(samples, str) and samples.isdigit() else samples

    @field_validator("camera", mode="before")
    @classmethod
    def _resolve_camera(cls, camera: Any) -> PinholeCamera:
        resolved = resolve_camera(camera)
        if resolved.distortion:
            raise ConfigError(f"camera: expected one without distortion to render, got {resolved.distortion}")
        return resolved

    @field_validator("occupancy_map")
    @classmethod
    def _existing_map(cls, path: Path | None) -> Path | None:
        if path is not None and not path.is_file():
            raise ConfigError(f"occupancy_map: expected the YAML file of a map, got {str(path)!r}, which is not there")
        return path

    @model_validator(mode="after")
    def _short_steps(self) -> Self:
        step_m = self.speed / self.fps
        if step_m > LONGEST_STEP_M:
            raise ConfigError(
                f"speed, fps: expected at most {LONGEST_STEP_M} m between two frames, got {step_m:.2f} m; "
                "drive slower or take more frames a second"
            )
        return self

    def scene_source(self) -> SceneSource:
        """What the house is loaded from; raises SceneError, and ConfigError for its options."""
        return find_scene(self.scene, self.scene_options)

    def recorded(self) -> dict[str, Any]:
        """All parameters, the scene's options resolved."""
        return {**self.model_dump(), "scene_options": self.scene_source().options.model_dump()}

    @property
    def top_turn_rate(self) -> float:
        """Turn rate in rad/s that an action of 1 commands."""
        return self.speed / RADIUS_OF_TURN if self.turn_rate is None else self.turn_rate


class SlamParams(Params):
    """The SLAM, how it is fed, and how its maps are judged."""

    slam: str = Field("orbslam3", description="SLAM backend, or 'module:class' of your own")
    slam_sync: Sync = Field(
        "lockstep",
        description="lockstep: wait after each frame until the SLAM idles; realtime: feed by the wall clock; "
        "free: feed at full speed",
    )
    stride: int = Field(0, ge=0, description="frames left out between two that the SLAM sees")
    loop_closure: bool | None = Field(None, description="loop closing on or off; None: the backend's default")
    slam_options: dict[str, Any] = Field(default_factory=dict, description="options of the backend")
    map_policy: MapPolicy = Field(
        "largest", description="map that is evaluated: the largest, the first, or each by itself"
    )
    slam_timeout_s: float = Field(
        _LIMITS.frame_s, gt=0, le=3600, description="longest time that the SLAM may take for a frame, s"
    )
    slam_finish_timeout_s: float = Field(
        _LIMITS.finish_s, gt=0, le=86_400, description="longest time that it may take to load, and to end, s"
    )
    slam_memory_mb: float = Field(_LIMITS.memory_mb, ge=100, description="memory that it may take, MB")

    @field_validator("slam")
    @classmethod
    def _known_backend(cls, slam: str) -> str:
        load_backend(slam)
        return slam

    def config(self, camera: PinholeCamera, fps: float) -> SlamConfig:
        """What the backend is built from, for frames of a camera that takes `fps` a second."""
        return SlamConfig(camera, fps, self.loop_closure, self.slam_options)

    def session(self, config: SlamConfig) -> SlamSession:
        """A new run of the backend; raises ConfigError or SlamError."""
        limits = Limits(self.slam_timeout_s, self.slam_finish_timeout_s, self.slam_memory_mb)
        return SlamSession(self.slam, config, self.slam_sync, limits)

    def recorded(self, config: SlamConfig) -> dict[str, Any]:
        """All parameters, the backend's options resolved, and what else the results depend on in `slam_versions`."""
        backend = load_backend(self.slam)
        options = backend.Options.checked(config.options).model_dump()
        return {**self.model_dump(), "slam_options": options, "slam_versions": backend.versions(config)}


class SlamInLoopParams(SlamParams):
    """The SLAM in the loop, how it is fed, how its maps are judged, and what its tracking is worth."""

    reward: Literal["progress", "tracking"] = Field(
        "progress", description="metres of progress, or that minus 1 for each fed frame that is not tracked"
    )


def split_params(values: Mapping[str, Any]) -> tuple[DriveParams, SlamInLoopParams]:
    """The keywords of `gym.make("HomeRobotSLAM-v0", ...)`, sorted into the two groups; raises ConfigError."""
    drive_names, slam_names = DriveParams.model_fields.keys(), SlamInLoopParams.model_fields.keys()
    for name in values:
        if name not in drive_names | slam_names:
            raise ConfigError(unknown_word("parameter", name, drive_names | slam_names))
    drive = DriveParams.checked({k: v for k, v in values.items() if k in drive_names})
    return drive, SlamInLoopParams.checked({k: v for k, v in values.items() if k in slam_names})
