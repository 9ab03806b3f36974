"""Pairs in metres along a path; frames and seconds go through the same two functions, see test_relative.py."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from slamgym.eval.accuracy.pair_selection import consecutive_pairs, nearest_pairs, path_steps_m


def as_list(pairs):
    return list(zip(*(frames.tolist() for frames in pairs), strict=True))


def test_nearest_pairs_by_hand():
    # Frames at 0, 1, 2, 2 and 3.5 m. 2 m on from 0 is 2, first reached by frame 2. From 1 on, 3.5 is off by 0.5 (2 is
    # off by 1); from both at 2, 3.5 is off by 0.5.
    steps = np.array([1.0, 1.0, 0.0, 1.5])
    assert as_list(nearest_pairs(steps, 2.0, 0.3)) == [(0, 2), (1, 4), (2, 4), (3, 4)]
    # 0.5 is more than a fifth of 2, and just a quarter.
    assert as_list(nearest_pairs(steps, 2.0, 0.2)) == [(0, 2)]
    assert as_list(nearest_pairs(steps, 2.0, 0.25)) == [(0, 2), (1, 4), (2, 4), (3, 4)]


def test_of_two_equally_near_the_earlier():
    assert as_list(nearest_pairs(np.array([1.0, 2.0]), 2.0, 0.5)) == [(0, 1), (1, 2)]


def test_of_frames_in_one_place_the_first():
    # At 0, 1, 1, 1 and 3 m: from 0 on, the three at 1 m and the one at 3 m are all off by 1 m.
    assert as_list(nearest_pairs(np.array([1.0, 0.0, 0.0, 2.0]), 2.0, 0.5)) == [(0, 1), (1, 4), (2, 4), (3, 4)]


def test_consecutive_pairs_by_hand():
    # Frames at 0, 1, 2, 2 and 3.5 m: 2 m are reached at frame 2, and 1.5 m are left; 1 m is reached at 1, 2 and 4.
    steps = np.array([1.0, 1.0, 0.0, 1.5])
    assert as_list(consecutive_pairs(steps, 2.0)) == [(0, 2)]
    assert as_list(consecutive_pairs(steps, 1.0)) == [(0, 1), (1, 2), (2, 4)]
    assert as_list(consecutive_pairs(steps, 4.0)) == []


@pytest.mark.parametrize("n", [0, 1])
def test_no_pair_among_no_two_frames(n):
    steps = path_steps_m(np.tile(np.eye(4), (n, 1, 1)))
    assert as_list(nearest_pairs(steps, 1.0, 0.5)) == []
    assert as_list(consecutive_pairs(steps, 1.0)) == []


# Halves add up exactly, repeat places, and make ties.
halves = st.lists(st.integers(0, 4), max_size=12).map(lambda numbers: 0.5 * np.array(numbers, dtype=np.float64))
distances = st.integers(1, 10).map(lambda number: 0.5 * number)


@given(halves, distances, st.sampled_from([0.0, 0.1, 0.5, 0.9]))
@settings(deadline=None, max_examples=300)
def test_nearest_pairs_equal_their_definition(steps, distance, tolerance):
    along = [sum(steps[:i]) for i in range(len(steps) + 1)]
    expected = []
    for i in range(len(along) - 1):
        off, j = min((abs(along[j] - along[i] - distance), j) for j in range(i + 1, len(along)))
        if off <= tolerance * distance:
            expected.append((i, j))
    assert as_list(nearest_pairs(steps, distance, tolerance)) == expected


@given(halves, distances)
@settings(deadline=None)
def test_consecutive_pairs_are_a_chain_of_shortest_links(steps, distance):
    pairs = as_list(consecutive_pairs(steps, distance))
    starts = [i for i, _ in pairs] + [pairs[-1][1] if pairs else 0]
    assert starts == [0, *(j for _, j in pairs)]
    for i, j in pairs:
        assert steps[i : j - 1].sum() < distance <= steps[i:j].sum()
    assert steps[starts[-1] :].sum() < distance
