"""The pinhole camera model and the presets that the `camera` parameter names."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from math import isfinite
from typing import Any

from slamgym.errors import ConfigError, unknown_word


@dataclass(frozen=True, slots=True)
class PinholeCamera:
    """Image size in pixels; focal lengths and principal point in pixels, the centre of the top left pixel at (0, 0).

    distortion: OpenCV's k1, k2, p1, p2 and, if given, k3 of a real lens; rendered images have none.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if not all(isinstance(v, int) for v in (self.width, self.height)):
            raise ConfigError(f"camera: expected a size in whole pixels, got {self.width!r} x {self.height!r}")
        if not all(isinstance(v, int | float) for v in (self.fx, self.fy, self.cx, self.cy)):
            raise ConfigError(f"camera: expected numbers for fx, fy, cx and cy, got {self}")
        if not isinstance(self.distortion, tuple):
            raise ConfigError(f"camera: expected a tuple of numbers as distortion, got {self.distortion!r}")
        if self.width < 1 or self.height < 1:
            raise ConfigError(f"camera: expected a size of at least 1x1 pixels, got {self.width}x{self.height}")
        if not all(isfinite(v) and v > 0 for v in (self.fx, self.fy)):
            raise ConfigError(f"camera: expected finite focal lengths above 0, got fx={self.fx}, fy={self.fy}")
        if not (isfinite(self.cx) and isfinite(self.cy)):
            raise ConfigError(f"camera: expected a finite principal point, got cx={self.cx}, cy={self.cy}")
        if len(self.distortion) not in (0, 4, 5) or not all(map(isfinite, self.distortion)):
            raise ConfigError(f"camera: expected no distortion, or finite k1 k2 p1 p2 [k3], got {self.distortion}")


LENSES: dict[str, PinholeCamera] = {
    # As the settings files of ORB-SLAM2 for the sequences of TUM RGB-D have them.
    "tum_fr1": PinholeCamera(
        *(640, 480, 517.306408, 516.469215, 318.643040, 255.313989),
        distortion=(0.262383, -0.953104, -0.005358, 0.002628, 1.163314),
    ),
    "tum_fr2": PinholeCamera(
        *(640, 480, 520.908620, 521.007327, 325.141442, 249.701764),
        distortion=(0.231222, -0.784899, -0.003257, -0.000105, 0.917205),
    ),
    "tum_fr3": PinholeCamera(640, 480, 535.4, 539.2, 320.1, 247.6),
}
"""Cameras that real sequences were recorded with."""

CAMERAS: dict[str, PinholeCamera] = {
    # 70 degrees across, as the colour camera of common indoor depth cameras.
    "default": PinholeCamera(640, 480, 460.0, 460.0, 319.5, 239.5),
    "small": PinholeCamera(320, 240, 230.0, 230.0, 159.5, 119.5),
    **{name: replace(lens, distortion=()) for name, lens in LENSES.items()},
}
"""Cameras to render with, which have no distortion."""


def resolve_camera(camera: str | PinholeCamera | Mapping[str, Any]) -> PinholeCamera:
    """The camera that a user named, gave, or wrote down as a mapping; raises ConfigError."""
    if isinstance(camera, PinholeCamera):
        return camera
    if isinstance(camera, str):
        if camera not in CAMERAS:
            raise ConfigError(unknown_word("camera", camera, CAMERAS))
        return CAMERAS[camera]
    if not isinstance(camera, Mapping):
        raise ConfigError(f"camera: expected a preset's name, a PinholeCamera or a mapping, got {camera!r}")
    names = {field.name for field in fields(PinholeCamera)}
    for key in camera:
        if key not in names:
            raise ConfigError(unknown_word("camera key", str(key), names))
    if missing := sorted(names - {"distortion"} - set(camera)):
        raise ConfigError(f"camera: expected the keys {', '.join(sorted(names))}; missing: {', '.join(missing)}")
    distortion = camera.get("distortion", ())
    return PinholeCamera(**{**camera, "distortion": tuple(distortion) if isinstance(distortion, list) else distortion})
