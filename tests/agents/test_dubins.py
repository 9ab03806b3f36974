from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from slamgym.agents.dubins import dubins_curves
from slamgym.agents.path import arc_length

poses = st.tuples(st.floats(-2, 2), st.floats(-2, 2), st.floats(-np.pi, np.pi))


def headings(xy):
    step = np.diff(xy, axis=0)
    step = step[np.linalg.norm(step, axis=1) > 1e-6]
    return np.arctan2(step[:, 1], step[:, 0])


def wrapped(angle):
    return (np.asarray(angle) + np.pi) % (2 * np.pi) - np.pi


@given(poses, poses, st.floats(0.2, 0.6))
def test_every_curve_leads_from_pose_to_pose_without_turning_tighter(start, goal, radius_m):
    curves = dubins_curves(start, goal, radius_m, 0.02)
    assert 2 <= len(curves) <= 6
    lengths = [arc_length(xy)[-1] for xy in curves]
    assert all(b > a - 0.01 for a, b in pairwise(lengths))
    for xy in curves:
        assert np.allclose(xy[0], start[:2])
        assert np.allclose(xy[-1], goal[:2], atol=1e-6)
        assert np.linalg.norm(np.diff(xy, axis=0), axis=1).max() <= 0.02 + 1e-9
        if len(turned := headings(xy)) > 1:
            assert abs(wrapped(turned[0] - start[2])) < 0.06
            assert abs(wrapped(turned[-1] - goal[2])) < 0.06
            assert np.abs(wrapped(np.diff(turned))).max() < 0.02 / radius_m + 1e-3


def test_known_lengths():
    straight = dubins_curves((0, 0, 0), (3, 0, 0), 0.5, 0.01)[0]
    assert np.isclose(arc_length(straight)[-1], 3.0)
    half_circle = dubins_curves((0, 0, 0), (0, 1, np.pi), 0.5, 0.01)[0]
    assert np.isclose(arc_length(half_circle)[-1], np.pi / 2, atol=1e-3)
    # Back on its own track: three arcs of 60, 300 and 60 degrees.
    turn_round = dubins_curves((0, 0, 0), (0, 0, np.pi), 0.3, 0.01)[0]
    assert np.isclose(arc_length(turn_round)[-1], 7 / 3 * np.pi * 0.3, atol=1e-3)
    assert np.isclose(turn_round[:, 0].max(), (1 + np.sqrt(3)) * 0.3, atol=1e-3)
