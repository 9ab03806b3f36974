"""What was seen at a loss: the figures, worked out by hand, and the causes of losses of the real ORB-SLAM3."""

import tracemalloc
from dataclasses import astuple, replace

import cv2
import numpy as np
import pytest

from slamgym.camera import CAMERAS, LENSES
from slamgym.errors import TrajectoryWarning
from slamgym.eval.datasets import read_sequence
from slamgym.geometry import mast_camera_pose
from slamgym.slam.backend import SlamConfig, untracked
from slamgym.slam.history import FrameHistory, WholeHistory
from slamgym.slam.session import SlamSession
from slamgym.types import Frame, TrackingState, TrackResult

CAMERA = CAMERAS["small"]  # 320x240, 230 pixels of focal length
LOST = untracked(TrackingState.LOST)


def tracked(points=300):
    return TrackResult(TrackingState.OK, np.eye(4), 0, points)


def frame(seconds, x=0.0, yaw=0.0, dots=100, depth=2.3):
    """A camera at (x, 0) that looks along x at a grey wall with so many white dots."""
    rgb = np.full((240, 320, 3), 100, np.uint8)
    rgb[10 : 10 + 10 * (dots // 20) : 10, 20:220:10] = 255
    return Frame(round(seconds * 1e9), rgb, np.full((240, 320), depth, np.float32), mast_camera_pose(x, 0.0, yaw, 0.8))


def context_of(frames, results):
    history = FrameHistory(CAMERA)
    for one, result in zip(frames, results, strict=True):
        history.add(one, result)
    return history.context()


def figures(context):
    return np.array(astuple(context)[:14])


def test_figures_by_hand():
    """Every 0.1 s, 0.05 m and 1 degree on; then 0.3 s without a frame, and one that is 0.3 m and 12 degrees further."""
    calm = [frame(0.1 * k, 0.05 * k, np.deg2rad(k), dots=200) for k in range(6)]
    turned = frame(0.8, 0.55, np.deg2rad(17), dots=40, depth=0.0)
    context = context_of([*calm, turned], [*(tracked(400 - 20 * k) for k in range(6)), LOST])
    assert context.speed_mps == pytest.approx(0.3 / 0.3)
    assert context.rotation_rate_degps == pytest.approx(12 / 0.3)
    assert (context.frame_gap_s, context.usual_frame_gap_s) == pytest.approx((0.3, 0.1))
    assert (context.keypoints, context.usual_keypoints) == (40, 200)
    assert context.brightness == pytest.approx(100 + 155 * 40 / (320 * 240), abs=0.01)
    assert context.valid_depth == 0.0
    assert np.isnan(context.median_depth_m)
    assert (context.tracked_points, context.tracked_points_slope) == pytest.approx((300, -200))
    # 12 degrees are 49 of 320 columns in the middle of the image, and 0.3 m nearer what is left spreads.
    assert 0.5 < context.overlap < 1 - 49 / 320
    assert context.cause == "frame_gap"
    assert context.explanation.startswith("0.30 s since the last frame, usually 0.10 s; hardly any depth (0% ")


def test_only_tracked_frames_of_the_last_second_are_usual():
    dots = [20, *[100] * 4, *[60] * 3, 200, 0]
    results = [*[tracked()] * 5, LOST, LOST, LOST, tracked(), LOST]
    frames = [frame(0.25 * k, dots=n) for k, n in enumerate(dots)]
    # Of the frames from 1.0 s to the last tracked one at 2.0 s, only these two were tracked: 100 and 200 dots.
    assert context_of(frames, results).usual_keypoints == 150


def test_usual_after_a_long_gap_is_what_was_before_it():
    frames = [*(frame(0.1 * k) for k in range(10)), frame(60.0)]
    context = context_of(frames, [*[tracked()] * 10, LOST])
    assert (context.frame_gap_s, context.usual_frame_gap_s) == pytest.approx((59.1, 0.1))
    assert context.usual_keypoints == 100


def test_slower_than_a_frame_a_second():
    context = context_of([frame(4.0 * k, 0.1 * k) for k in range(4)], [*[tracked()] * 3, LOST])
    assert (context.frame_gap_s, context.usual_frame_gap_s, context.speed_mps) == pytest.approx((4.0, 4.0, 0.025))
    assert np.isnan(context.tracked_points_slope)
    assert context.cause == "unknown"


def test_motion_over_frames_of_200_hz_is_taken_over_more_than_two():
    """Noise of 1 mm to and fro between frames would be 0.4 m/s."""
    frames = [frame(0.005 * k, 0.0005 * k + 0.001 * (k % 2)) for k in range(101)]
    context = context_of(frames, [*[tracked()] * 100, LOST])
    assert context.speed_mps == pytest.approx(0.1, abs=0.04)
    assert (context.frame_gap_s, context.usual_frame_gap_s) == pytest.approx((0.005, 0.005))


def test_without_a_truth_the_motion_is_not_known_but_the_images_are():
    frames = [replace(frame(0.1 * k), T_world_cam=np.full((4, 4), np.nan)) for k in range(3)]
    context = context_of(frames, [tracked(), tracked(), LOST])
    assert np.isnan([context.speed_mps, context.rotation_rate_degps, context.overlap]).all()
    assert (context.keypoints, context.usual_keypoints, context.valid_depth) == (100, 100, 1.0)


def test_at_the_first_frame_nothing_is_usual():
    context = context_of([frame(0.0)], [LOST])
    assert (context.keypoints, context.median_depth_m) == (100, pytest.approx(2.3))
    assert np.isnan(figures(context)).sum() == 9


def test_images_may_change_after_they_were_fed():
    frames = [frame(0.1 * k, 0.05 * k) for k in range(3)]
    history = FrameHistory(CAMERA)
    for one in frames:
        history.add(one, tracked())
    before = history.context()
    for one in frames:
        for array in (one.rgb, one.depth, one.T_world_cam):
            array[:] = 0
    fresh = context_of([frame(0.1 * k, 0.05 * k) for k in range(3)], [tracked()] * 3)
    np.testing.assert_array_equal(figures(before), figures(fresh))
    np.testing.assert_array_equal(figures(history.context()), figures(fresh))


@pytest.mark.parametrize("fps", [30, 60, 500])
def test_memory_is_bounded(fps):
    """Views of a second, 0.03 s apart: at most 34 and the last two, in grey and with a sixteenth of the depth."""
    history = FrameHistory(CAMERA)
    tracemalloc.start()
    for k in range(3 * fps):
        history.add(frame(k / fps), tracked())
    used, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    one_view = 320 * 240 + 80 * 60 * 4
    assert 20 * one_view < used < 36 * (one_view + 2000)


def test_a_whole_run_is_explained_as_a_live_one():
    """Same frames, same states: all figures but those of the tracked points, which only a live SLAM tells."""
    frames = [frame(k / 10, 0.02 * k, 0.03 * k, dots=20 * (k % 7), depth=1 + k / 10) for k in range(30)]
    ok = np.array([k not in (14, 15, 27) for k in range(30)])
    whole, live = WholeHistory(CAMERA), FrameHistory(CAMERA)
    contexts = {}
    for k, one in enumerate(frames):
        whole.add(one)
        live.add(one, tracked() if ok[k] else LOST)
        contexts[k] = live.context()
    for k in (0, 1, 14, 27):
        np.testing.assert_allclose(figures(whole.context(k, ok))[:12], figures(contexts[k])[:12], rtol=1e-12)
    assert np.isnan(figures(whole.context(27, ok))[12:]).all()


def flat(rgb, share):
    rgb[:, : round(640 * share)] = 150
    return rgb


CHANGES = {
    "dark": lambda rgb: (rgb * 0.02).astype(np.uint8),
    "blur": lambda rgb: cv2.GaussianBlur(rgb, (0, 0), 15),
    "few_keypoints": lambda rgb: flat(rgb.copy(), 0.95),
}


@pytest.fixture(scope="module")
def real_frames(shared_data):
    with pytest.warns(TrajectoryWarning, match="5 of 100"):
        return list(read_sequence(shared_data / "tum_fr1_xyz_100", "tum_fr1").frames())


@pytest.mark.parametrize("cause", CHANGES)
def test_why_the_real_orbslam3_was_lost(real_frames, cause):
    """Forty real frames as they are, in which nothing may stand out, then one that was spoilt."""
    spoilt = replace(real_frames[40], rgb=CHANGES[cause](real_frames[40].rgb))
    history = FrameHistory(LENSES["tum_fr1"])
    causes = []
    with SlamSession("orbslam3", SlamConfig(LENSES["tum_fr1"], fps=30.0)) as session:
        for one in [*real_frames[:40], spoilt]:
            result = session.track(one)
            history.add(one, result)
            causes.append(history.context().cause)
    assert result.state is TrackingState.LOST
    assert causes == ["unknown"] * 40 + [cause]
