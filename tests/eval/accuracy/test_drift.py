import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from slamgym.errors import ConfigError, TrajectoryError
from slamgym.eval.accuracy import segment_drift

X = 0.5 * np.arange(6)
# Segments of 1 and 2 m that start at frames 0, 2, 4, at 0, 1, 2 m: more than 1 m on from 0 is frame 3 (1.5 m), more
# than 2 m on is frame 5 (2.5 m); more than 1 m on from 1 is frame 5; nothing is far enough from 2.
OPTIONS = {"lengths_m": (1.0, 2.0), "step": 2}


def test_translation_by_hand(straight):
    # A tenth too long: off by 0.15, 0.25 and 0.15 m at the ends, over 1, 2 and 1 m: 15, 12.5 and 15 %.
    drift = segment_drift(straight(X), straight(1.1 * X), **OPTIONS)
    assert drift.trans_percent == pytest.approx((15 + 12.5 + 15) / 3)
    assert drift.rot_deg_per_m == pytest.approx(0.0, abs=1e-12)
    assert drift.segments == 3


def test_rotation_by_hand(straight):
    # 2 degrees a frame: 6, 10 and 6 degrees at the ends, over 1, 2 and 1 m.
    drift = segment_drift(straight(X), straight(X, 2.0 * np.arange(6)), **OPTIONS)
    assert drift.rot_deg_per_m == pytest.approx((6 + 5 + 6) / 3)


def test_both_ends_are_tracked_in_one_map(straight):
    ref_T, est_T = straight(X), straight(1.1 * X)
    last_lost = np.arange(6) < 5
    # Only the segment from 0 to 3 is left; what lies between its ends does not count.
    assert segment_drift(ref_T, est_T, **OPTIONS, tracked=last_lost)[0::2] == (pytest.approx(15.0), 1)
    between_lost = np.array([True, False, False, True, False, False])
    est_T[~between_lost] = np.nan
    assert segment_drift(ref_T, est_T, **OPTIONS, tracked=between_lost)[0::2] == (pytest.approx(15.0), 1)
    two_maps = np.array([0, 0, 1, 1, 1, 1])
    # From 0 on both end in the other map.
    assert segment_drift(ref_T, straight(1.1 * X), **OPTIONS, map_ids=two_maps)[0::2] == (pytest.approx(15.0), 1)


def test_a_segment_is_longer_than_its_length(straight):
    # Exactly 1 m on is not yet the end; at 2 m the error of 0.2 m is divided by the length asked for.
    drift = segment_drift(straight([0.0, 1.0, 2.0]), straight([0.0, 1.1, 2.2]), [1.0])
    assert drift[0::2] == (pytest.approx(20.0), 1)


@pytest.mark.parametrize("n", [0, 1, 5])
def test_no_segment_fits(n, straight):
    T = straight(0.1 * np.arange(n))
    drift = segment_drift(T, T)
    assert np.isnan([drift.trans_percent, drift.rot_deg_per_m]).all()
    assert drift.segments == 0


def test_nothing_tracked(straight):
    T = straight(np.arange(20.0))
    drift = segment_drift(T, T * np.nan, tracked=np.zeros(20, dtype=bool))
    assert np.isnan([drift.trans_percent, drift.rot_deg_per_m]).all()
    assert drift.segments == 0


@given(st.integers(0, 2**32 - 1), st.integers(2, 30), st.integers(1, 4))
@settings(deadline=None, max_examples=30)
def test_it_equals_its_definition(random_pair, seed, n, step):
    ref_T, est_T = random_pair(seed, n)
    lengths = (1.0, 3.0, 10.0)
    expected = []
    for i in range(0, n, step):
        for length in lengths:
            path, j = 0.0, i
            while path <= length and j + 1 < n:
                j += 1
                path += np.linalg.norm(ref_T[j, :3, 3] - ref_T[j - 1, :3, 3])
            if path > length:
                ref_step, est_step = np.linalg.inv(ref_T[i]) @ ref_T[j], np.linalg.inv(est_T[i]) @ est_T[j]
                error = np.linalg.inv(est_step) @ ref_step
                angle = np.degrees(Rotation.from_matrix(error[:3, :3]).magnitude())
                expected.append((100.0 * np.linalg.norm(error[:3, 3]) / length, angle / length))
    drift = segment_drift(ref_T, est_T, lengths, step=step)
    assert drift.segments == len(expected)
    if expected:
        assert drift[:2] == pytest.approx(np.mean(expected, axis=0))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"lengths_m": ()}, "lengths of segments above 0 m"),
        ({"lengths_m": (1.0, 0.0)}, "lengths of segments above 0 m"),
        ({"lengths_m": (np.nan,)}, "lengths of segments above 0 m"),
        ({"step": 0}, "at least 1 frame .* got 0"),
    ],
)
def test_options_that_make_no_sense(options, message, straight):
    with pytest.raises(ConfigError, match=message):
        segment_drift(straight([0, 1]), straight([0, 1]), **options)


def test_poses_that_are_none(straight):
    with pytest.raises(TrajectoryError, match="finite"):
        segment_drift(straight([0, 1]), straight([0, 1]) * np.nan)
