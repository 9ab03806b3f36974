"""What ORB-SLAM2 and ORB-SLAM3 have in common: options, times, settings files, and how files are handed over."""

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from pydantic import Field

from slamgym.slam.backend import SlamConfig, SlamOptions

# No worker opens the viewer, but its settings are compulsory; programs of the user's may open it.
_VIEWER = {
    "Viewer.KeyFrameSize": 0.05,
    "Viewer.KeyFrameLineWidth": 1.0,
    "Viewer.GraphLineWidth": 0.9,
    "Viewer.PointSize": 2.0,
    "Viewer.CameraSize": 0.08,
    "Viewer.CameraLineWidth": 3.0,
    "Viewer.ViewpointX": 0.0,
    "Viewer.ViewpointY": -0.7,
    "Viewer.ViewpointZ": -1.8,
    "Viewer.ViewpointF": 500.0,
}


class OrbOptions(SlamOptions):
    """The settings of the ORB-SLAMs' own files for RGB-D cameras, with their usual values."""

    vocabulary: Path | None = Field(None, description="DBoW2 text file; None: the one of slamgym")
    features: int = Field(1000, ge=100, le=20_000, description="ORB features an image")
    scale_factor: float = Field(1.2, gt=1.0, le=2.0, description="scale between pyramid levels")
    levels: int = Field(8, ge=1, le=16, description="pyramid levels")
    ini_fast: int = Field(20, ge=1, le=255, description="FAST threshold tried first, grey levels")
    min_fast: int = Field(7, ge=1, le=255, description="FAST threshold where the first finds nothing")
    baseline: float = Field(0.07732, gt=0, description="baseline of the virtual stereo camera, metres")
    depth_threshold: float = Field(40.0, gt=0, description="largest depth of a close point, in baselines")


class Clock:
    """Stamps as ORB-SLAM keeps them, seconds in a double: from the first frame on they come back to the nanosecond."""

    def __init__(self) -> None:
        self._first_ns: int | None = None

    @property
    def first_ns(self) -> int:
        """Stamp of the first frame, 0 before there is one."""
        return self._first_ns or 0

    def seconds(self, stamp_ns: int) -> float:
        """Seconds since the first frame that was asked about."""
        if self._first_ns is None:
            self._first_ns = stamp_ns
        return (stamp_ns - self._first_ns) * 1e-9


def settings(config: SlamConfig, options: OrbOptions) -> str:
    """ORB-SLAM3's settings file, version 1.0, for RGB images and depth in metres."""
    camera = config.camera
    return _yaml(
        {
            "File.version": '"1.0"',
            "Camera.type": '"PinHole"',
            **{f"Camera1.{name}": float(getattr(camera, name)) for name in ("fx", "fy", "cx", "cy")},
            **{f"Camera1.{k}": float(v) for k, v in zip(_DISTORTION, camera.distortion, strict=False)},
            **_image(config, is_rgb=True),
            "Stereo.b": options.baseline,
            "Stereo.ThDepth": options.depth_threshold,
            "RGBD.DepthMapFactor": 1.0,
            **_extractor(options),
            "loopClosing": int(config.loop_closure is not False),
            **_VIEWER,
        }
    )


def classic_settings(config: SlamConfig, options: OrbOptions, *, is_rgb: bool, depth_units: float) -> str:
    """The settings file of ORB-SLAM2, which ORB-SLAM3 reads as well. It says nothing of loop closing.

    is_rgb: order of the colours in the images that the SLAM is given; `cv::imread` makes it BGR. depth_units: depth
    values a metre.
    """
    camera = config.camera
    distortion = (*camera.distortion, *[0.0] * len(_DISTORTION))
    return _yaml(
        {
            "Camera.type": '"PinHole"',
            **{f"Camera.{name}": float(getattr(camera, name)) for name in ("fx", "fy", "cx", "cy")},
            **{f"Camera.{k}": float(v) for k, v in zip(_DISTORTION, distortion, strict=False)},
            **_image(config, is_rgb=is_rgb),
            "Camera.bf": options.baseline * camera.fx,
            "ThDepth": options.depth_threshold,
            "DepthMapFactor": depth_units,
            **_extractor(options),
            **_VIEWER,
        }
    )


_DISTORTION = ("k1", "k2", "p1", "p2", "k3")


def _image(config: SlamConfig, *, is_rgb: bool) -> dict[str, int]:
    """ORB-SLAM wants its fps as a whole number of at least 1."""
    return {
        "Camera.width": config.camera.width,
        "Camera.height": config.camera.height,
        "Camera.fps": max(1, round(config.fps)),
        "Camera.RGB": int(is_rgb),
    }


def _extractor(options: OrbOptions) -> dict[str, float]:
    return {
        "ORBextractor.nFeatures": options.features,
        "ORBextractor.scaleFactor": options.scale_factor,
        "ORBextractor.nLevels": options.levels,
        "ORBextractor.iniThFAST": options.ini_fast,
        "ORBextractor.minThFAST": options.min_fast,
    }


def _yaml(values: Mapping[str, Any]) -> str:
    return "\n".join(["%YAML:1.0", *(f"{key}: {value}" for key, value in values.items()), ""])


@contextmanager
def memory_file(text: str = "") -> Iterator[tuple[IO[bytes], str]]:
    """A file that holds the text, and its path in this process. It has no name: nothing is left behind by a crash."""
    with os.fdopen(os.memfd_create("slamgym"), "r+b", buffering=0) as file:
        file.write(text.encode())
        yield file, f"/proc/self/fd/{file.fileno()}"
