import math
from dataclasses import asdict, replace

import pytest

from slamgym.camera import CAMERAS, PinholeCamera, resolve_camera
from slamgym.errors import ConfigError
from slamgym.params import DriveParams, SlamParams, split_params


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"sped": 1}, "unknown parameter 'sped'; did you mean 'speed'?"),
        ({"slam": "orbslam"}, "did you mean 'orbslam3'?"),
        ({"slam_sync": "lockstepp"}, "did you mean 'lockstep'?"),
        ({"depth_noise": "icl"}, "did you mean 'icl_nuim'?"),
        ({"camera": "smal"}, "did you mean 'small'?"),
        ({"camera": {"widht": 3}}, "did you mean 'width'?"),
        ({"camera": {"width": 3}}, "missing: cx, cy, fx, fy, height"),
        ({"camera": 3}, "got 3"),
        ({"camera": {**asdict(CAMERAS["small"]), "width": "640"}}, "whole pixels"),
        ({"camera": {**asdict(CAMERAS["small"]), "distortion": 3}}, "tuple of numbers"),
        ({"camera": replace(CAMERAS["small"], distortion=(0.1, 0.0, 0.0, 0.0))}, "without distortion"),
        ({"fps": 1e-9}, "fps"),
        ({"fps": 2, "speed": 1.0}, "at most 0.4 m between two frames, got 0.50 m"),
        ({"speed": -0.2}, "speed: the value should be greater than 0, got -0.2"),
        ({"speed": math.nan}, "speed: the value should be a finite number, got nan"),
        ({"speed": "fast"}, "got 'fast'"),
        ({"stride": -1}, "stride: the value should be greater than or equal to 0, got -1"),
        ({"path_length_m": math.inf}, "path_length_m"),
    ],
)
def test_bad_parameters_are_refused_in_one_line(values, message):
    with pytest.raises(ConfigError) as error:
        split_params(values)
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_turn_rate_follows_speed_unless_given():
    assert DriveParams(speed=0.5).top_turn_rate == 2.0
    assert DriveParams(speed=0.5, turn_rate=1.0).top_turn_rate == 1.0


def test_parameters_are_split_and_dump_to_plain_values():
    drive, slam = split_params({"speed": 1, "stride": 2, "camera": "small"})
    assert (drive.speed, slam.stride) == (1.0, 2)
    assert resolve_camera(drive.model_dump()["camera"]) == CAMERAS["small"]
    assert SlamParams().slam == "orbslam3"


def test_camera_rejects_nonsense():
    with pytest.raises(ConfigError, match="focal"):
        PinholeCamera(640, 480, 0.0, 1.0, 0.0, 0.0)
    with pytest.raises(ConfigError, match="1x1"):
        PinholeCamera(0, 480, 1.0, 1.0, 0.0, 0.0)
