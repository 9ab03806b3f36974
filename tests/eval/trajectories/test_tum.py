import numpy as np
import pytest
from evo.core.sync import matching_time_indices
from hypothesis import given
from hypothesis import strategies as st

from slamgym.errors import OutputError, TrajectoryError
from slamgym.eval.trajectories import Trajectory, associate, read_tum, write_tum
from slamgym.geometry import from_quaternion

POSE = "1.0 2.0 3.0 0 0 0 1"


def trajectory_at(stamps_ns):
    stamps_ns = np.array(stamps_ns, dtype=np.int64)
    return Trajectory(stamps_ns, np.tile(np.eye(4), (len(stamps_ns), 1, 1)))


def random_trajectory(n, seed=0):
    rng = np.random.default_rng(seed)
    stamps_ns = np.cumsum(rng.integers(1, 10**8, size=n)) + 1_305_031_102_160_407_003
    return Trajectory(stamps_ns, from_quaternion(rng.normal(size=(n, 3)), rng.normal(size=(n, 4))))


@pytest.mark.parametrize(
    ("stamps_ns", "T", "message"),
    [
        (np.array([0.0, 1.0]), np.tile(np.eye(4), (2, 1, 1)), "int64 nanoseconds"),
        (np.array([[0, 1]]), np.tile(np.eye(4), (1, 1, 1)), "shape"),
        (np.array([0, 1]), np.tile(np.eye(4), (3, 1, 1)), r"got shape \(3, 4, 4\)"),
        (np.array([0, 1]), np.zeros((2, 7)), r"got shape \(2, 7\)"),
        (np.array([0, 1]), np.array([np.eye(4), np.full((4, 4), np.nan)]), "pose 1"),
        (np.array([0, 5, 5]), np.tile(np.eye(4), (3, 1, 1)), "5 ns at pose 2"),
        (np.array([7, 5]), np.tile(np.eye(4), (2, 1, 1)), "5 ns at pose 1"),
    ],
)
def test_a_malformed_trajectory_is_refused(stamps_ns, T, message):
    with pytest.raises(TrajectoryError, match=message):
        Trajectory(stamps_ns, T)


def test_written_and_read_again_it_is_the_same(tmp_path):
    trajectory = random_trajectory(50)
    write_tum(tmp_path / "t.txt", trajectory)
    again = read_tum(tmp_path / "t.txt")
    np.testing.assert_array_equal(again.stamps_ns, trajectory.stamps_ns)
    np.testing.assert_allclose(again.T, trajectory.T, atol=1e-8)


def test_an_empty_trajectory_can_be_written(tmp_path):
    write_tum(tmp_path / "t.txt", trajectory_at([]))
    assert (tmp_path / "t.txt").read_text() == "# timestamp tx ty tz qx qy qz qw\n"


def test_writing_where_there_is_no_folder(tmp_path):
    with pytest.raises(OutputError, match="No such file"):
        write_tum(tmp_path / "none" / "t.txt", random_trajectory(2))


@pytest.mark.parametrize(
    ("word", "stamp_ns"),
    [
        ("1305031102.160407", 1_305_031_102_160_407_000),
        ("1305031102.123456789", 1_305_031_102_123_456_789),
        ("1.305031102160407123e+09", 1_305_031_102_160_407_123),
        ("7", 7_000_000_000),
        (".5", 500_000_000),
        ("-0.000000001", -1),
    ],
)
def test_stamps_are_exact_to_the_nanosecond(tmp_path, word, stamp_ns):
    (tmp_path / "t.txt").write_text(f"{word} {POSE}\n")
    trajectory = read_tum(tmp_path / "t.txt")
    assert trajectory.stamps_ns.tolist() == [stamp_ns]
    write_tum(tmp_path / "u.txt", trajectory)
    assert read_tum(tmp_path / "u.txt").stamps_ns.tolist() == [stamp_ns]


def test_comments_blank_lines_tabs_and_unnormalised_quaternions(tmp_path):
    (tmp_path / "t.txt").write_bytes(b"\xef\xbb\xbf# head\r\n\r\n1 1 2 3 0 0 0 2 # first\r\n2\t1\t2\t3\t0\t0\t2\t0\r\n")
    trajectory = read_tum(tmp_path / "t.txt")
    assert len(trajectory) == 2
    np.testing.assert_allclose(trajectory.positions, [[1, 2, 3], [1, 2, 3]])
    np.testing.assert_allclose(trajectory.T[0, :3, :3], np.eye(3))
    np.testing.assert_allclose(trajectory.T[1, :3, :3], np.diag([-1, -1, 1]), atol=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "t.txt: expected lines .* no pose"),
        ("# only a comment\n", "no pose"),
        (f"1 {POSE}\n2 1 2 3\n", r"t.txt:2: expected the 8 columns .* got 4"),
        (f"# head\n1 {POSE} 9\n", "t.txt:2: .* got 9"),
        ("1 a 2 3 0 0 0 1\n", "t.txt:1: expected a number, got 'a'"),
        ("1 nan 2 3 0 0 0 1\n", "t.txt:1: expected a finite number, got 'nan'"),
        ("1 1 2 3 0 0 inf 1\n", "t.txt:1: expected a finite number, got 'inf'"),
        ("1 1 2 3 0 0 0 0\n", "t.txt:1: expected a rotation"),
        (f"now {POSE}\n", "t.txt:1: expected a stamp in seconds, got 'now'"),
        (f"nan {POSE}\n", "t.txt:1: expected a stamp in seconds"),
        (f"inf {POSE}\n", "t.txt:1: expected a stamp in seconds"),
        (f"1403636580838555648 {POSE}\n", "t.txt:1: .* nanoseconds?"),
        (f"2 {POSE}\n1 {POSE}\n", "t.txt:2: expected stamps in increasing order"),
        (f"1 {POSE}\n1 {POSE}\n", "t.txt:2: expected every stamp once"),
    ],
)
def test_errors_name_file_and_line(tmp_path, text, message):
    (tmp_path / "t.txt").write_text(text)
    with pytest.raises(TrajectoryError, match=message):
        read_tum(tmp_path / "t.txt")


def test_files_that_are_missing_or_binary(tmp_path):
    with pytest.raises(TrajectoryError, match="No such file"):
        read_tum(tmp_path / "none.txt")
    (tmp_path / "t.png").write_bytes(b"\x89PNG\xff\xfe")
    with pytest.raises(TrajectoryError, match="binary"):
        read_tum(tmp_path / "t.png")


def test_of_repeated_stamps_the_last_pose_can_be_kept(tmp_path):
    (tmp_path / "t.txt").write_text("1 1 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n2 3 0 0 0 0 0 1\n")
    assert read_tum(tmp_path / "t.txt", repeated_stamps="last").positions[:, 0].tolist() == [2.0, 3.0]
    with pytest.raises(TrajectoryError, match="did you mean 'last'"):
        read_tum(tmp_path / "t.txt", repeated_stamps="lst")


def tum_associate(ref_ns, est_ns, max_difference_ns):
    """associate.py of the TUM tools, written out."""
    candidates = sorted((abs(a - b), a, b) for a in ref_ns for b in est_ns if abs(a - b) < max_difference_ns)
    free_ref, free_est, matches = set(ref_ns), set(est_ns), []
    for _, a, b in candidates:
        if a in free_ref and b in free_est:
            free_ref.remove(a)
            free_est.remove(b)
            matches.append((ref_ns.index(a), est_ns.index(b)))
    return sorted(matches)


STAMPS = st.lists(st.integers(0, 60), min_size=1, max_size=30, unique=True).map(sorted)


@given(STAMPS, STAMPS, st.integers(0, 20))
def test_association_as_the_tum_tools_do_it(ref_ns, est_ns, max_difference_ns):
    expected = tum_associate(ref_ns, est_ns, max_difference_ns)
    if not expected:
        with pytest.raises(TrajectoryError, match="same clock"):
            associate(trajectory_at(ref_ns), trajectory_at(est_ns), max_difference_ns)
        return
    ref, est = associate(trajectory_at(ref_ns), trajectory_at(est_ns), max_difference_ns)
    assert list(zip(ref.tolist(), est.tolist(), strict=True)) == expected


@given(STAMPS, STAMPS, st.integers(0, 20))
def test_association_as_evo_does_it(ref_ns, est_ns, max_difference_ns):
    ref_s, est_s = np.array(ref_ns, dtype=float), np.array(est_ns, dtype=float)
    if len(est_ns) > len(ref_ns):
        expected_ref, expected_est = matching_time_indices(ref_s, est_s, max_difference_ns)
    else:
        expected_est, expected_ref = matching_time_indices(est_s, ref_s, max_difference_ns)
    if not expected_ref:
        with pytest.raises(TrajectoryError, match="same clock"):
            associate(trajectory_at(ref_ns), trajectory_at(est_ns), max_difference_ns, "evo")
        return
    ref, est = associate(trajectory_at(ref_ns), trajectory_at(est_ns), max_difference_ns, "evo")
    assert (ref.tolist(), est.tolist()) == (expected_ref, expected_est)


@pytest.mark.parametrize("convention", ["tum", "evo"])
def test_nothing_matches_an_empty_trajectory(convention):
    for ref, est in (([], [1, 2]), ([1, 2], []), ([], [])):
        with pytest.raises(TrajectoryError, match="no pose"):
            associate(trajectory_at(ref), trajectory_at(est), 10, convention)


def test_an_unknown_convention():
    with pytest.raises(TrajectoryError, match="did you mean 'tum'"):
        associate(trajectory_at([1]), trajectory_at([1]), 1, "tun")
