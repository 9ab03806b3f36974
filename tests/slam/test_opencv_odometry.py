"""OpenCV's odometry on real frames, and whether its failures are seen."""

import warnings
from dataclasses import replace

import cv2
import numpy as np
import pytest

from slamgym.camera import CAMERAS, LENSES
from slamgym.errors import ConfigError, SlamError, TrajectoryWarning
from slamgym.eval.accuracy import ate
from slamgym.eval.datasets import read_sequence
from slamgym.slam.backend import SlamConfig, check_config
from slamgym.slam.opencv_odometry import OpenCvOptions
from slamgym.slam.rgbd_matcher import Matcher, condition, grey_jacobian
from slamgym.slam.session import SlamSession
from slamgym.types import Frame, SlamEvent, TrackingState

CAMERA = LENSES["tum_fr1"]
FRAME_NS = 33_333_333


@pytest.fixture(scope="module")
def real_frames(shared_data):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", TrajectoryWarning)  # some colour images have no depth image in time
        return list(read_sequence(shared_data / "tum_fr1_xyz_100", "tum_fr1").frames())


def track(frames, **options):
    """Online answers and final trajectory of frames fed at 30 Hz."""
    with SlamSession("opencv", SlamConfig(CAMERA, 30.0, options=options)) as session:
        online = [session.track(replace(frame, stamp_ns=k * FRAME_NS)) for k, frame in enumerate(frames)]
        final = session.finish()
        assert session.outcome == "", session.log()
    return online, final


def events(online):
    return {k: result.event for k, result in enumerate(online) if result.event}


def error_m(online, frames, map_id=0):
    pairs = [(f.T_world_cam, r.T_map_cam) for f, r in zip(frames, online, strict=True) if r.map_id == map_id]
    return ate(*map(np.array, zip(*pairs, strict=True))).trans_m.rmse


def covered(frame):
    return replace(frame, rgb=frame.rgb * 0, depth=frame.depth * 0)


def wall(frame, grey=180.0, noise=12.0):
    """A plane at 1.5 m, parallel to the image, as a noisy camera sees it."""
    rgb = grey + noise * np.random.default_rng(0).standard_normal(frame.rgb.shape)
    return replace(frame, rgb=np.clip(rgb, 0, 255).astype(np.uint8), depth=np.full_like(frame.depth, 1.5))


def striped_wall(frame):
    """Nothing tells how far the camera moves along the stripes."""
    stripes = 128 + 60 * np.sign(np.sin(np.arange(frame.rgb.shape[1]) / 12))
    return wall(frame, stripes[None, :, None], noise=5.0)


FAULTS = {
    "covered": covered,
    "no colour": lambda frame: replace(frame, rgb=frame.rgb * 0),
    "no depth": lambda frame: replace(frame, depth=frame.depth * 0),
    "little depth": lambda frame: replace(frame, depth=np.where(np.arange(640) < 480, 0, frame.depth)),
    "blank wall": wall,
    "striped wall": striped_wall,
    "another scene": lambda frame: replace(frame, rgb=frame.rgb[::-1].copy(), depth=frame.depth[::-1].copy()),
}


def test_accuracy_on_real_frames(real_frames):
    online, final = track(real_frames)
    assert events(online) == {0: SlamEvent.INITIALIZED}  # no false loss
    assert {r.state for r in online} == {TrackingState.OK}
    np.testing.assert_array_equal(online[0].T_map_cam, np.eye(4))
    assert error_m(online, real_frames) < 0.02
    assert 1000 < min(r.tracked_points for r in online) <= max(r.tracked_points for r in online) <= 10_000
    np.testing.assert_array_equal(final.T_map_cam, [r.T_map_cam for r in online])
    assert final.stamps_ns.tolist() == [k * FRAME_NS for k in range(len(real_frames))]


def test_every_other_frame_and_the_same_answers_again(real_frames):
    frames = real_frames[:40:2]
    first, second = track(frames)[0], track(frames)[0]
    assert events(first) == {0: SlamEvent.INITIALIZED}
    assert error_m(first, frames) < 0.02
    np.testing.assert_array_equal([r.T_map_cam for r in first], [r.T_map_cam for r in second])


def test_every_fault_is_a_loss_and_nothing_else_is(real_frames):
    fed = [frame for k, fault in enumerate(FAULTS.values()) for frame in (real_frames[k], fault(real_frames[k]))]
    online, final = track([*fed, real_frames[len(FAULTS)]])
    lost = {name: online[2 * k + 1] for k, name in enumerate(FAULTS)}
    assert {name: r.state for name, r in lost.items()} == dict.fromkeys(FAULTS, TrackingState.LOST)
    assert {name: r.event for name, r in lost.items()} == dict.fromkeys(FAULTS, SlamEvent.LOST)
    assert all(np.isnan(r.T_map_cam).all() and r.map_id == -1 for r in lost.values())
    assert [r.event for r in online[2::2]] == [SlamEvent.RELOCALIZED] * len(FAULTS)
    assert {r.map_id for r in online[::2]} == set(final.map_id) == {0}
    assert len(final.stamps_ns) == len(FAULTS) + 1


def test_jump_starts_a_new_map_at_identity(real_frames):
    frames = [*real_frames[:10], *real_frames[30:60]]
    online, final = track(frames, new_map_after_s=0.3)
    # Lost for more than 0.3 s at the tenth frame after the first lost one.
    assert events(online) == {0: SlamEvent.INITIALIZED, 10: SlamEvent.LOST, 20: SlamEvent.NEW_MAP}
    assert {r.state for r in online[10:20]} == {TrackingState.LOST}
    np.testing.assert_array_equal(online[20].T_map_cam, np.eye(4))
    assert final.map_id.tolist() == [0] * 10 + [1] * 20
    assert error_m(online, frames, 0) < 0.02
    assert error_m(online, frames, 1) < 0.02


def test_no_new_map_where_nothing_can_be_seen(real_frames):
    fed = [real_frames[0], *map(covered, real_frames[1:8]), real_frames[8]]
    online, _ = track(fed, new_map_after_s=0.1, max_translation=0.01)
    # Frame 8 is too far from frame 0, and the frame before it shows nothing.
    assert events(online) == {0: SlamEvent.INITIALIZED, 1: SlamEvent.LOST}


def test_first_frame_needs_texture_and_depth(real_frames):
    good = real_frames[0]
    online, _ = track([covered(good), wall(good), striped_wall(good), good])
    assert [r.state for r in online] == [TrackingState.NOT_INITIALIZED] * 3 + [TrackingState.OK]
    assert events(online) == {3: SlamEvent.INITIALIZED}


def test_finish_without_frames():
    assert track([])[1].T_map_cam.shape == (0, 4, 4)


@pytest.mark.parametrize(
    "option",
    [
        {"max_depth": 0.3},
        {"max_translation": 0.01},
        {"max_rotation_deg": 0.5},
        {"min_points": 20_000},
        {"min_share": 0.99},
        {"min_correlation": 0.999},
        {"max_condition": 3.0},
    ],
)
def test_options_refuse_a_good_match(real_frames, option):
    assert match(real_frames[0], real_frames[2])
    assert match(real_frames[0], real_frames[2], **option) is None


def match(first, second, camera=CAMERA, **options):
    matcher = Matcher(camera, OpenCvOptions(**options))
    return matcher.match(matcher.look(first), matcher.look(second))


def two_walls(shift):
    """Walls with a texture, the upper one at 2 m and the lower one at 1 m, seen `shift` / 230 m further right."""
    spots = np.random.default_rng(0).integers(0, 2, (480 // 12, 720 // 12)) * 255.0
    texture = cv2.GaussianBlur(np.kron(spots, np.ones((12, 12))), (0, 0), 3).astype(np.uint8)
    grey = np.concatenate([texture[:240, shift : shift + 640], texture[240:, 2 * shift : 2 * shift + 640]])
    depth = np.repeat(np.float32([2.0, 1.0]), 240)[:, None] * np.ones(640, np.float32)
    return Frame(0, np.repeat(grey[..., None], 3, axis=2), depth, np.eye(4))


@pytest.mark.parametrize("shrink", [1, 2])
def test_metres_and_direction_of_a_motion(shrink):
    moved = np.eye(4)
    moved[0, 3] = 10 * 2.0 / 460.0  # 10 pixels to the right, at 2 m, with 460 pixels of focal length
    answer = match(two_walls(0), two_walls(10), CAMERAS["default"], shrink=shrink)
    np.testing.assert_allclose(answer.T_reference_view, moved, atol=6e-3)


@pytest.mark.parametrize("shrink", [1, 2])
def test_points_of_a_distorting_lens(shrink):
    point = np.array([0.6, 0.5, 2.0])
    K = np.array([[CAMERA.fx, 0, CAMERA.cx], [0, CAMERA.fy, CAMERA.cy], [0, 0, 1]])
    seen = cv2.projectPoints(point, np.zeros(3), np.zeros(3), K, np.array(CAMERA.distortion))[0].ravel()
    x, y = np.rint(seen).astype(int)
    rgb, depth = np.zeros((480, 640, 3), np.uint8), np.full((480, 640), 2.0, np.float32)
    rgb[y - 6 : y + 7, x - 6 : x + 7] = 255
    assert np.linalg.norm(K @ point / 2.0 - [*seen, 1.0]) > 3.0  # pixels, without regard to the lens
    view = Matcher(CAMERA, OpenCvOptions(shrink=shrink)).look(Frame(0, rgb, depth, np.eye(4)))
    np.testing.assert_allclose(view.points.mean(axis=0), point, atol=0.004)  # one pixel


def test_grey_jacobian_by_hand():
    points, K = np.array([[0.0, 0.0, 2.0], [2.0, 0.0, 2.0]]), np.diag([100.0, 200.0, 1.0])
    along_x, along_y = (grey_jacobian(points, np.array([[gx] * 2, [gy] * 2]), K) for gx, gy in ((3, 0), (0, 1)))
    # A metre sideways at 2 m is 50 pixels of 3 grey levels each; turning about y moves the second point twice as far.
    np.testing.assert_allclose(along_x, [[150, 0, 0, 0, 150, 0], [150, 0, -150, 0, 300, 0]])
    np.testing.assert_allclose(along_y, [[0, 100, 0, -100, 0, 0], [0, 100, 0, -100, 0, 100]])


def test_condition():
    assert condition(np.diag([1.0, 1, 1, 1, 1, 4])) == pytest.approx(4)
    assert condition(np.diag([1.0, 1, 1, 1, 1, 0])) == np.inf
    assert condition(np.empty((0, 6))) == np.inf


def test_options_may_be_text_as_on_the_command_line():
    assert OpenCvOptions.checked({"shrink": "1", "max_depth": "4.5"}) == OpenCvOptions(shrink=1, max_depth=4.5)
    with pytest.raises(ConfigError, match=r"slam option 'shrink': .*less than or equal to 2, got '3'"):
        OpenCvOptions.checked({"shrink": "3"})


def test_opencv_without_odometry(monkeypatch):
    monkeypatch.delattr(cv2, "OdometrySettings")
    with pytest.raises(SlamError, match=r"expected OpenCV 5.*pip install 'opencv-python-headless>=5.0'"):
        check_config("opencv", SlamConfig(CAMERA, 30.0))
