"""The adapter of ORB-SLAM2's Python bindings, against a module that has their interface and quirks."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from slamgym.camera import LENSES
from slamgym.errors import ConfigError, SlamError
from slamgym.slam.backend import SlamConfig, check_config
from slamgym.slam.orb_settings import OrbOptions, classic_settings
from slamgym.slam.orbslam2 import OrbSlam2
from slamgym.slam.session import SlamSession
from slamgym.types import SlamEvent, TrackingState

STANDINS = Path(__file__).parent / "standins"
DARK = 0
"""Place at which the stand-in cannot track: the images of frame(0) are black and have no depth."""
START_NS = 10**18
FRAME_NS = 33_333_333


@pytest.fixture
def run(monkeypatch, config, frame):
    """Answers and final trajectory for frames at these places on a line, metres; with the session, closed."""
    monkeypatch.syspath_prepend(str(STANDINS))

    def in_session(places):
        frames = [replace(frame(place), stamp_ns=START_NS + k * FRAME_NS) for k, place in enumerate(places)]
        with SlamSession("orbslam2", config) as session:
            return [session.track(one) for one in frames], session.finish(), session

    return in_session


def events(online):
    return {k: result.event for k, result in enumerate(online) if result.event}


def fed_frames(final):
    return ((final.stamps_ns - START_NS) / FRAME_NS).tolist()


def test_tracked_throughout(run):
    online, final, session = run([5, 6, 8, 9])
    assert session.outcome == ""
    assert events(online) == {0: SlamEvent.INITIALIZED}
    assert [result.T_map_cam[0, 3] for result in online] == [0.0, 1.0, 3.0, 4.0]
    assert {result.tracked_points for result in online} == {100}
    assert final.stamps_ns.tolist() == [START_NS + k * FRAME_NS for k in range(4)]  # exact to the nanosecond
    assert final.map_id.tolist() == [0, 0, 0, 0]
    np.testing.assert_allclose(final.T_map_cam, [result.T_map_cam for result in online])


def test_rotations_are_exact_though_it_reckons_in_float32(run):
    online, _, _ = run([1, 4])
    np.testing.assert_allclose(online[1].T_map_cam[0, :3], [np.cos(0.3), 0.0, np.sin(0.3)], atol=1e-6)
    R = online[1].T_map_cam[:3, :3]
    np.testing.assert_allclose(R @ R.T, np.eye(3), rtol=0, atol=1e-14)


def test_found_again_in_the_same_map(run):
    online, final, _ = run([DARK, 1, 2, 3, 4, 5, 6, DARK, DARK, 9, 10])
    assert events(online) == {1: SlamEvent.INITIALIZED, 7: SlamEvent.LOST, 9: SlamEvent.RELOCALIZED}
    assert online[0].state is TrackingState.NOT_INITIALIZED
    # Though it says of frame 7 that there is a pose, and repeats the last one in its trajectory.
    assert all(np.isnan(online[k].T_map_cam).all() and online[k].map_id == -1 for k in (0, 7, 8))
    assert fed_frames(final) == [1, 2, 3, 4, 5, 6, 9, 10]
    # The poses that it stands by at the end, not those that it first gave.
    assert [result.T_map_cam[1, 3] for result in online[1:7]] == [0.0] * 6
    assert final.T_map_cam[:, 1, 3].tolist() == [0.25] * 8
    assert final.T_map_cam[:, 0, 3].tolist() == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 8.0, 9.0]


@pytest.mark.parametrize("before", [1, 3, 5])
def test_lost_soon_after_the_start_the_map_is_thrown_away(run, before):
    online, final, _ = run([*range(1, before + 1), DARK, 20, 21])
    assert events(online) == {0: SlamEvent.INITIALIZED, before: SlamEvent.LOST, before + 1: SlamEvent.MAP_RESET}
    assert [result.map_id for result in online] == [0] * before + [-1, 1, 1]
    assert online[-1].T_map_cam[0, 3] == 1.0
    assert fed_frames(final) == [before + 1, before + 2]
    assert final.map_id.tolist() == [1, 1]


def test_lost_at_the_end_keeps_its_map(run):
    online, final, _ = run([1, 2, DARK])
    assert online[-1].event is SlamEvent.LOST
    assert fed_frames(final) == [0, 1]


def test_never_initialized(run):
    online, final, session = run([DARK, DARK])
    assert [result.state for result in online] == [TrackingState.NOT_INITIALIZED] * 2
    assert (final.T_map_cam.shape, session.outcome) == ((0, 4, 4), "")


def test_its_crash_in_the_dark_after_a_reset_is_an_outcome(run):
    online, final, session = run([1, 2, DARK, DARK])
    assert events(online) == {0: SlamEvent.INITIALIZED, 2: SlamEvent.LOST, 3: SlamEvent.CRASHED}
    assert (len(final.stamps_ns), session.outcome) == (0, "crashed")


def test_missing_bindings(config, tmp_path, monkeypatch):
    (tmp_path / "orbslam2").mkdir()  # a folder of that name is no module
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(SlamError, match=r"orbslam2 is missing; build ORB-SLAM2 .* PYTHONPATH"):
        check_config("orbslam2", config)


def test_other_bindings_of_that_name(config, tmp_path, monkeypatch):
    (tmp_path / "orbslam2.py").write_text("class System:\n    initialize = get_tracking_state = None\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    with (
        SlamSession("orbslam2", config) as session,
        pytest.raises(SlamError, match="lacks set_use_viewer, process_image_rgbd"),
    ):
        session.wait_ready()


def test_loop_closing_cannot_be_turned_off(config, monkeypatch):
    monkeypatch.syspath_prepend(str(STANDINS))
    check_config("orbslam2", replace(config, loop_closure=True))
    with pytest.raises(ConfigError, match="'orbslam2': expected loop_closure as one of None, True, got False"):
        check_config("orbslam2", replace(config, loop_closure=False))


def test_versions_name_the_bindings_and_the_vocabulary(config, monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / "orbslam2.py").write_bytes(b"")
    versions = OrbSlam2.versions(config)
    assert versions.keys() == {"orbslam2_sha256", "vocabulary_sha256"}
    assert versions["orbslam2_sha256"] == "e3b0c44298fc"  # SHA-256 of nothing


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"is_rgb": True, "depth_units": 1.0}, {"Camera.RGB": 1, "DepthMapFactor": 1.0}),
        ({"is_rgb": False, "depth_units": 5000.0}, {"Camera.RGB": 0, "DepthMapFactor": 5000.0}),
    ],
)
def test_classic_settings_are_yaml_that_opencv_reads(given, expected):
    options = OrbOptions(features=1234, baseline=0.1, depth_threshold=30)
    text = classic_settings(SlamConfig(LENSES["tum_fr1"], fps=14.9), options, **given)
    store = cv2.FileStorage(text, cv2.FILE_STORAGE_READ | cv2.FILE_STORAGE_MEMORY)
    expected |= {"Camera.fx": 517.306408, "Camera.k3": 1.163314, "Camera.fps": 15, "Camera.bf": 51.7306408}
    expected |= {"ThDepth": 30.0, "ORBextractor.nFeatures": 1234}
    assert {name: store.getNode(name).real() for name in expected} == pytest.approx(expected)
    assert store.getNode("Camera.type").string() == "PinHole"


def test_classic_settings_of_a_lens_without_distortion_name_it(config):
    text = classic_settings(config, OrbOptions(), is_rgb=True, depth_units=1.0)
    assert all(f"Camera.{name}: 0.0\n" in text for name in ("k1", "k2", "p1", "p2", "k3"))
