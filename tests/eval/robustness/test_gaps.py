import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from slamgym.errors import ConfigError, TrajectoryError
from slamgym.eval.robustness import covered_frames, evaluated_frames, find_gaps, find_losses
from slamgym.geometry import mast_camera_pose


def flags(text):
    """The frames "T" have a pose, "." have none."""
    return np.array([c == "T" for c in text], dtype=np.bool_)


def every_100_ms(n):
    return np.arange(n, dtype=np.int64) * 100_000_000


@pytest.mark.parametrize(
    ("posed", "max_gap_s", "expected"),
    [
        ("..T.T..T...T...", 0.0, "..............."),
        ("..T.T..T...T...", 0.19, "..............."),
        ("..T.T..T...T...", 0.2, "TTTTT.........."),  # the first frame, and the next pose, are exactly 0.2 s away
        ("..T.T..T...T...", 0.3, "TTTTTTTT...TTTT"),  # the last frame is 0.3 s away
        ("..T.T..T...T...", np.inf, "TTTTTTTTTTTTTTT"),
        ("...T.", 0.2, "...TT"),
        (".....", np.inf, "....."),
        ("", 1.0, ""),
    ],
)
def test_frames_in_short_gaps_between_poses_are_covered(posed, max_gap_s, expected):
    stamps_ns = every_100_ms(len(posed))
    assert covered_frames(stamps_ns, stamps_ns[flags(posed)], max_gap_s).tolist() == flags(expected).tolist()


def test_poses_need_not_be_at_frames():
    # Poses at 0.45, 0.75 and 2 s: frames 0.5, 0.6 and 0.7 lie between the two that are 0.3 s apart.
    poses_ns = np.array([450, 750, 2000], dtype=np.int64) * 1_000_000
    assert np.flatnonzero(covered_frames(every_100_ms(20), poses_ns, 0.3)).tolist() == [5, 6, 7]


def test_frames_without_a_truth_leave_no_hole_that_the_estimate_does_not_have():
    # The truth has nothing from 0.2 to 5 s, where the estimate has a pose every 0.1 s.
    frames_ns = np.array([0, 100, 200, 5000, 5100], dtype=np.int64) * 1_000_000
    assert covered_frames(frames_ns, every_100_ms(52), 0.1).all()


@settings(deadline=None)
@given(st.lists(st.booleans(), max_size=40), st.floats(0, 2), st.floats(0, 2))
def test_a_longer_gap_covers_more(posed, one, other):
    stamps_ns = every_100_ms(len(posed))
    poses_ns = stamps_ns[np.array(posed, dtype=np.bool_)]
    short, long = (covered_frames(stamps_ns, poses_ns, gap) for gap in sorted([one, other]))
    assert (short <= long).all()
    assert long.any() <= (len(poses_ns) > 0)


@pytest.mark.parametrize("max_gap_s", [-0.1, np.nan])
def test_a_negative_gap_is_refused(max_gap_s):
    with pytest.raises(ConfigError, match="0 s or more"):
        covered_frames(every_100_ms(3), every_100_ms(3), max_gap_s)


@pytest.mark.parametrize("tracked", [flags("TT"), np.ones(3)])
def test_flags_that_do_not_fit_the_frames_are_refused(tracked):
    with pytest.raises(TrajectoryError, match=r"bool \(N,\)"):
        find_gaps(every_100_ms(3), np.tile(np.eye(4), (3, 1, 1)), tracked)


def test_stamps_out_of_order_are_refused():
    with pytest.raises(TrajectoryError, match="increasing"):
        covered_frames(every_100_ms(3), every_100_ms(3)[::-1], 1.0)


def test_gaps_of_plain_frames_measure_time_and_true_motion():
    # x = 0, 1, 2, 3, 3, 3 m; the last three headings are 0, 90 and 45 degrees.
    poses = [(0, 0), (1, 0), (2, 0), (3, 0), (3, 90), (3, 45)]
    T = np.array([mast_camera_pose(x, 0.0, np.deg2rad(yaw), 1.0) for x, yaw in poses])
    first, last = find_gaps(every_100_ms(6) + 5, T, flags("T.T..."))
    assert (first.start_frame, first.end_frame, first.outcome) == (1, 1, "relocalized")
    assert (first.start_s, first.duration_s, first.distance_m) == pytest.approx((0.1, 0.1, 1.0))
    assert (last.start_frame, last.end_frame, last.outcome) == (3, 5, "never")
    assert (last.start_s, last.duration_s, last.distance_m) == pytest.approx((0.3, 0.2, 0.0))
    assert (first.rotation_deg, last.rotation_deg) == pytest.approx((0.0, 90 + 45), abs=1e-9)


@pytest.mark.parametrize(
    ("tracked", "expected"),
    [
        ("", []),
        ("....", []),  # never initialised
        ("...T", []),
        ("TTTT", []),
        ("T...", [(1, 3, "never")]),  # lost at once
        (".T.T.", [(2, 2, "relocalized"), (4, 4, "never")]),
    ],
)
def test_which_gaps_there_are(tracked, expected):
    gaps = find_gaps(every_100_ms(len(tracked)), np.tile(np.eye(4), (len(tracked), 1, 1)), flags(tracked))
    assert [(gap.start_frame, gap.end_frame, gap.outcome) for gap in gaps] == expected


@pytest.mark.parametrize("online", ["..000xx00x0", "0x0x0xxx", "....", "0"])
def test_a_run_in_one_map_has_the_same_losses_as_its_plain_frames(make_record, online):
    record = make_record(online)
    assert find_gaps(record.stamps_ns, record.T_world_cam, evaluated_frames(record)) == find_losses(record)
