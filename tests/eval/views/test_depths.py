import numpy as np
import pytest

from slamgym.camera import CAMERAS
from slamgym.eval.views import median_depth_m, overlap, valid_depth
from slamgym.geometry import mast_camera_pose

CAMERA = CAMERAS["default"]  # 640x480, 460 pixels of focal length
HERE = mast_camera_pose(1.0, 2.0, 0.7, 0.8)


@pytest.fixture
def wall():
    """A wall straight ahead, 2.3 m away: 200 pixels a metre."""
    return np.full((480, 640), 2.3, np.float32)


def moved(x=0.0, y=0.0, z=0.0):
    """The pose after a step right, down and ahead, metres, as the camera sees it."""
    step = np.eye(4)
    step[:3, 3] = x, y, z
    return HERE @ step


def test_share_and_median_of_what_was_measured():
    depth = np.array([[0, 1, 2], [3, np.nan, np.inf], [0, 0, 0], [0, 0, 10]], np.float32)
    assert valid_depth(depth) == 4 / 12
    assert median_depth_m(depth) == 2.5
    assert valid_depth(0 * depth[2:]) == 0.0
    assert np.isnan(median_depth_m(depth[2:3]))


@pytest.mark.parametrize(
    ("step", "expected"),
    [
        ({}, 1.0),
        ({"x": 0.32}, 0.9),  # 64 of 640 columns have left
        ({"x": -0.32}, 0.9),
        ({"y": 0.6}, 0.75),  # 120 of 480 rows
        ({"x": 0.32, "y": -0.6}, 0.9 * 0.75),
        ({"x": 3.3}, 0.0),
        ({"z": 1.15}, 0.25),  # half as far: twice the size
        ({"z": -1.0}, 1.0),
        ({"z": 2.4}, 0.0),  # behind the camera, where the projection alone would be in view
    ],
)
def test_overlap_before_a_wall(wall, step, expected):
    assert overlap(wall, HERE, moved(**step), CAMERA) == pytest.approx(expected, abs=1e-9)
    assert overlap(wall[::4, ::4], HERE, moved(**step), CAMERA, step=4) == pytest.approx(expected, abs=1e-9)


def test_overlap_when_turning(wall):
    """Turned by 35 degrees right, what was on the axis is 460 tan(35) = 322 columns left: just out of view."""
    axis_only = np.zeros_like(wall)
    axis_only[238:242, 318:321] = 2.3
    for degrees, expected in ((34, 1.0), (36, 0.0)):
        turned = mast_camera_pose(1.0, 2.0, 0.7 - np.deg2rad(degrees), 0.8)
        assert overlap(axis_only, HERE, turned, CAMERA) == expected
    assert overlap(wall, HERE, mast_camera_pose(1.0, 2.0, 0.7 + np.pi, 0.8), CAMERA) == 0.0


def test_only_pixels_with_a_depth_count(wall):
    wall[:, 64:] = 0  # what is left goes out of view
    assert overlap(wall, HERE, moved(x=0.32), CAMERA) == 0.0


def test_overlap_that_cannot_be_told(wall):
    nowhere = np.full((4, 4), np.nan)
    assert np.isnan(overlap(0 * wall, HERE, HERE, CAMERA))
    assert np.isnan(overlap(wall, HERE, nowhere, CAMERA))
    assert np.isnan(overlap(wall, nowhere, HERE, CAMERA))
