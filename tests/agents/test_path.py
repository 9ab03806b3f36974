import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from slamgym.agents.path import Path, resample

EIGHT = np.array([(0, 0), (2, 0), (2, 2), (1, 2), (1, -2), (0, -2)], dtype=float)


@pytest.fixture
def eight() -> Path:
    """Ten metres, crossing itself at (1, 0), after 1 m and after 7 m."""
    return Path(resample(EIGHT))


def test_arc_length_and_points(eight):
    assert eight.length_m == pytest.approx(10.0, abs=0.02)
    assert np.allclose(eight.point_at(0.5), (0.5, 0))
    assert np.allclose(eight.point_at([-1.0, 99.0]), EIGHT[[0, -1]])
    assert eight.heading_at(1.0) == pytest.approx(0.0)
    assert eight.heading_at(3.0) == pytest.approx(np.pi / 2)
    assert eight.heading_at(99.0) == pytest.approx(np.pi)


@given(st.floats(0, 10), st.floats(0, 0.45), st.floats(-0.02, 0.02))
def test_projection_finds_points_beside_the_path(s, ahead, aside):
    path = Path(resample(EIGHT[:4]))
    s = min(s, path.length_m)
    target = min(s + ahead, path.length_m)
    normal = path.heading_at(target) + np.pi / 2
    xy = path.point_at(target) + aside * np.array([np.cos(normal), np.sin(normal)])
    assert path.project(xy, s) == pytest.approx(target, abs=0.05)


def test_projection_never_goes_back_and_does_not_jump_at_crossings(eight):
    assert eight.project((0.5, 0.0), 0.8) == pytest.approx(0.8)
    assert eight.project((1.0, 0.02), 0.9) == pytest.approx(1.0, abs=0.01)
    assert eight.project((1.02, 0.0), 6.9) == pytest.approx(7.0, abs=0.01)
    assert eight.project((0.0, -2.0), 9.9) == eight.length_m
    assert eight.project((-5.0, -2.0), 99.0) == eight.length_m


def test_a_retraced_path_is_driven_there_before_back():
    path = Path(resample(np.array([(0.0, 0), (2, 0), (0, 0)])))
    assert path.project((1.8, 0.01), 1.75) == pytest.approx(1.8, abs=0.01)
    assert path.project((1.7, 0.01), 1.95) == pytest.approx(2.3, abs=0.01)


def test_waypoints_are_in_the_robots_frame(eight):
    waypoints = eight.waypoints(1.5, 1.5, 0.0, 0.0)
    assert waypoints.dtype == np.float32
    assert waypoints.shape == (5, 2)
    assert np.allclose(waypoints, [(0.2, 0), (0.4, 0), (0.5, 0.1), (0.5, 0.3), (0.5, 0.5)], atol=0.03)
    # Seen by a robot that looks along y, what lies at larger x is to its right.
    assert np.allclose(eight.waypoints(0.0, 0.0, 0.0, np.pi / 2)[:, 1], -0.2 * np.arange(1, 6), atol=1e-6)
    assert np.allclose(eight.waypoints(9.9, 0.0, 0.0, 0.0), (0.0, -2.0), atol=1e-6)


def test_cut_is_exact(eight):
    for length_m in (0.025, 3.0, 7.123):
        cut = eight.cut(length_m)
        assert cut.length_m == pytest.approx(length_m, abs=1e-9)
        assert np.allclose(cut.xy[-1], eight.point_at(length_m))
        assert np.diff(cut.arc_m).min() > 0


def test_a_part_of_a_path_is_that_part():
    path = Path(resample(EIGHT), np.array([0.5, 2.0, 4.0, 7.0, 9.0]))
    part = path.between(1.23, 7.0)
    assert part.length_m == pytest.approx(5.77, abs=1e-9)
    for s in np.linspace(0.0, 5.77, 40):
        assert np.allclose(part.point_at(s), path.point_at(1.23 + s), atol=1e-9)
        assert part.heading_at(s) == pytest.approx(path.heading_at(1.23 + s))
    assert part.goals_m == pytest.approx([0.77, 2.77])  # the one at its end is none
    assert np.diff(part.arc_m).min() > 0


def test_parts_join_and_the_whole_is_a_part(eight):
    parts = [eight.between(0.0, 3.3), eight.between(3.3, eight.length_m)]
    assert np.allclose(np.vstack([parts[0].xy, parts[1].xy[1:]])[[0, -1]], eight.xy[[0, -1]])
    assert parts[0].length_m + parts[1].length_m == pytest.approx(eight.length_m)
    assert np.array_equal(eight.between(0.0, eight.length_m).xy, eight.xy)
