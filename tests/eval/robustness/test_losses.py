from dataclasses import replace

import numpy as np
import pytest

from slamgym.errors import ConfigError
from slamgym.eval.robustness import (
    MAP_POLICIES,
    estimate_by_frame,
    evaluated_frames,
    final_by_frame,
    find_losses,
    is_success,
    most_frequent_map,
    status,
    true_poses,
)
from slamgym.types import LossContext, SlamEvent


def share(frames):
    return frames.mean() if len(frames) else 0.0


def runs(record):
    return [(loss.start_frame, loss.end_frame, loss.outcome) for loss in find_losses(record)]


@pytest.mark.parametrize(
    ("online", "events", "expected"),
    [
        ("", {}, []),
        (".....", {}, []),
        ("..000", {2: SlamEvent.INITIALIZED}, []),
        ("0xxxx", {1: SlamEvent.LOST}, [(1, 4, "never")]),
        (".000x", {}, [(4, 4, "never")]),
        ("00x00", {3: SlamEvent.RELOCALIZED}, [(2, 2, "relocalized")]),
        ("00xx.11", {5: SlamEvent.NEW_MAP}, [(2, 4, "new_map")]),
        ("00xx.11", {5: SlamEvent.MAP_RESET}, [(2, 4, "map_reset")]),
        ("00x1", {3: SlamEvent.MAPS_MERGED}, [(2, 2, "relocalized")]),
        ("0x0x1", {2: SlamEvent.RELOCALIZED, 4: SlamEvent.NEW_MAP}, [(1, 1, "relocalized"), (3, 3, "new_map")]),
        ("00x00", {3: SlamEvent.LOOP_CLOSED}, [(2, 2, "relocalized")]),
        ("00.11", {3: SlamEvent.INITIALIZED}, [(2, 2, "new_map")]),
    ],
)
def test_losses_and_their_outcomes(make_record, online, events, expected):
    assert runs(make_record(online, events=events)) == expected


def test_a_loss_lasts_until_the_first_tracked_frame_and_measures_the_true_motion(make_record):
    (loss,) = find_losses(make_record(".00xx00"))
    assert (loss.start_s, loss.duration_s) == pytest.approx((0.3, 0.2))
    assert loss.distance_m == pytest.approx(0.2, abs=1e-9)
    assert loss.rotation_deg == pytest.approx(np.rad2deg(0.1), abs=1e-6)


def test_a_loss_that_never_ends_lasts_until_the_last_fed_frame(make_record):
    (loss,) = find_losses(make_record("00xxx"))
    assert (loss.duration_s, loss.distance_m) == pytest.approx((0.2, 0.2))
    (loss,) = find_losses(make_record("0000x"))
    assert (loss.duration_s, loss.distance_m, loss.rotation_deg) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("online", "outcome", "expected"),
    [
        ("", "", "init_failed"),
        ("...", "", "init_failed"),
        ("..000", "", "ok"),
        ("00x00", "", "ok"),
        ("000xx", "", "lost"),
        ("00000", "crashed", "crashed"),
        ("...", "timeout", "timeout"),
    ],
)
def test_status(make_record, online, outcome, expected):
    assert status(make_record(online, outcome=outcome)) == expected


@pytest.mark.parametrize(
    ("status", "loss_count", "completion", "expected"),
    [
        ("ok", 0, 1.0, True),
        ("ok", 0, 0.5, True),
        ("ok", 0, 0.49, False),  # initialised late, or took most of its trajectory back
        ("ok", 1, 0.99, False),
        ("lost", 0, 1.0, False),
        ("crashed", 0, 1.0, False),
    ],
)
def test_success(status, loss_count, completion, expected):
    assert is_success(status, loss_count, completion) is expected


@pytest.mark.parametrize(
    ("online", "final", "expected_map", "expected_share"),
    [
        ("", "", -1, 0.0),
        ("....", "....", -1, 0.0),
        ("..00000000", None, 0, 0.8),
        ("000x1111xx", None, 1, 0.4),
        ("000x111xxx", None, 0, 0.3),  # a tie: the first
        ("111x000xxx", None, 1, 0.3),
        ("000x1111xx", "0000000000", 0, 0.7),  # merged; final poses of lost frames are guesses
        ("000xxxxx11", "0000000011", 0, 0.3),
        ("0000000000", "....000000", 0, 0.6),  # the SLAM took the first frames back
        ("0000", "....", -1, 0.0),
    ],
)
def test_evaluated_map_and_its_frames(make_record, online, final, expected_map, expected_share):
    record = make_record(online, final)
    assert most_frequent_map(estimate_by_frame(record)[1]) == expected_map
    assert share(evaluated_frames(record)) == pytest.approx(expected_share)


def test_without_a_final_trajectory_a_crash_is_judged_by_the_emitted_poses(make_record):
    record = make_record("000x1111xx", final="..........", outcome="crashed")
    assert share(evaluated_frames(record)) == pytest.approx(0.4)
    T, maps = estimate_by_frame(record)
    assert maps.tolist() == [0, 0, 0, -1, 1, 1, 1, 1, -1, -1]
    assert np.isfinite(T[maps >= 0]).all()


def test_final_poses_are_matched_by_exact_stamp_and_guesses_left_out(make_record):
    record = make_record("00x00", final="000.0")
    record.final.stamps_ns[1] += 1
    T, maps = final_by_frame(record)
    assert maps.tolist() == [0, -1, -1, -1, 0]
    np.testing.assert_array_equal(np.isfinite(T).all(axis=(1, 2)), maps >= 0)
    np.testing.assert_allclose(T[4], record.final.T_map_cam[3])


@pytest.mark.parametrize(
    ("online", "final", "largest", "first", "each"),
    [
        ("....", None, "....", "....", "...."),
        ("..0000", None, "..TTTT", "..TTTT", "..TTTT"),
        ("00x111x2", None, "...TTT..", "TT......", "TT.TTT.T"),
        ("00x111x2", "11.111.2", "TT.TTT..", "TT.TTT..", "TT.TTT.T"),  # merged into the second
        ("00x111x22", "...111.22", "...TTT...", "...TTT...", "...TTT.TT"),  # the first map was taken back
        ("00x111x0", None, "TT.....T", "TT.....T", "TT.TTT.T"),  # a tie: the first
    ],
)
def test_frames_in_the_maps_of_a_policy(make_record, online, final, largest, first, each):
    record = make_record(online, final)
    for policy, expected in zip(MAP_POLICIES, (largest, first, each), strict=True):
        assert "".join("T" if frame else "." for frame in evaluated_frames(record, policy)) == expected


def test_an_unknown_map_policy_is_refused(make_record):
    with pytest.raises(ConfigError, match=r"did you mean 'each'\? Valid: each, first, largest"):
        evaluated_frames(make_record("00"), "eachh")


def test_a_loss_bears_the_context_of_its_first_frame(make_record):
    seen = LossContext(*[0.0] * 14, cause="dark")
    record = replace(make_record("00x0xx"), contexts={4: seen})
    assert [loss.context for loss in find_losses(record)] == [None, seen]


def test_true_poses_that_are_not_known_are_filled_but_not_judged_by(make_record):
    record = make_record("000000")
    before = record.T_world_cam.copy()
    T = before.copy()
    T[[0, 2, 3]] = np.nan
    filled, real = true_poses(replace(record, T_world_cam=T, has_truth=np.array([1, 1, 1, 1, 0, 1], dtype=np.bool_)))
    assert real.tolist() == [False, True, False, False, False, True]
    np.testing.assert_allclose(filled[[0, 1, 4, 5]], before[[1, 1, 4, 5]], atol=1e-12)
    # A third of the way from frame 1 to frame 4.
    np.testing.assert_allclose(filled[2, :3, 3], before[1, :3, 3] + (before[4, :3, 3] - before[1, :3, 3]) / 3)
    none, real = true_poses(replace(record, T_world_cam=np.full_like(T, np.nan)))
    assert none is None
    assert not real.any()


def test_without_a_truth_a_loss_has_a_duration_only(make_record):
    record = make_record("00xx0")
    (loss,) = find_losses(replace(record, T_world_cam=np.full_like(record.T_world_cam, np.nan)))
    assert (loss.start_frame, loss.end_frame, loss.duration_s) == (2, 3, pytest.approx(0.2))
    assert np.isnan([loss.distance_m, loss.rotation_deg]).all()
