from decimal import getcontext, localcontext

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from slamgym.errors import OutputError, TrajectoryError, TrajectoryWarning
from slamgym.eval.trajectories import Trajectory, read_tum, write_tum
from slamgym.geometry import from_quaternion

POSE = "1.0 2.0 3.0 0 0 0 1"


def test_written_and_read_again_it_is_the_same(tmp_path, random_trajectory):
    trajectory = random_trajectory(50)
    write_tum(tmp_path / "t.txt", trajectory)
    again = read_tum(tmp_path / "t.txt")
    np.testing.assert_array_equal(again.stamps_ns, trajectory.stamps_ns)
    np.testing.assert_allclose(again.T, trajectory.T, atol=1e-8)


LIMIT_NS = 4_600_000_000 * 10**9  # differences still fit into 64 bits
COORDINATES = arrays(np.float64, (3, 3), elements=st.floats(-1e5, 1e5))
QUATERNIONS = arrays(np.float64, (3, 4), elements=st.floats(-1, 1)).filter(lambda q: (abs(q).max(axis=1) > 0.01).all())
STAMPS = st.lists(st.integers(1 - LIMIT_NS, LIMIT_NS - 1), min_size=3, max_size=3, unique=True).map(sorted)


@given(STAMPS, COORDINATES, QUATERNIONS)
def test_any_trajectory_comes_back(tmp_path_factory, stamps_ns, positions, quaternions):
    path = tmp_path_factory.mktemp("round") / "t.txt"
    trajectory = Trajectory(np.array(stamps_ns), from_quaternion(positions, quaternions))
    write_tum(path, trajectory)
    again = read_tum(path)
    assert again.stamps_ns.tolist() == stamps_ns
    # 9 decimals: half of 1e-9 off in each coordinate, and the last bit of numbers up to 1e5 (1.5e-11).
    np.testing.assert_allclose(again.positions, trajectory.positions, rtol=0, atol=0.52e-9)
    # An error e in each of four components of a unit quaternion turns entries of R by at most 4 * 2 * e.
    np.testing.assert_allclose(again.T[:, :3, :3], trajectory.T[:, :3, :3], rtol=0, atol=4e-9)


def test_an_empty_trajectory_can_be_written(tmp_path, trajectory_at):
    write_tum(tmp_path / "t.txt", trajectory_at([]))
    assert (tmp_path / "t.txt").read_text() == "# timestamp tx ty tz qx qy qz qw\n"


def test_writing_where_there_is_no_folder(tmp_path, random_trajectory):
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
        ("-0", 0),
        ("1e-999999999", 0),
        ("0." + "1" * 5000, 111_111_111),
    ],
)
def test_stamps_are_exact_to_the_nanosecond(tmp_path, write, word, stamp_ns):
    trajectory = read_tum(write(f"{word} {POSE}\n"))
    assert trajectory.stamps_ns.tolist() == [stamp_ns]
    write_tum(tmp_path / "u.txt", trajectory)
    assert read_tum(tmp_path / "u.txt").stamps_ns.tolist() == [stamp_ns]


def test_stamps_are_exact_whatever_the_decimal_context_of_the_program_is(write):
    path = write(f"1305031102.123456789 {POSE}\n")
    with localcontext():
        getcontext().prec = 4
        assert read_tum(path).stamps_ns.tolist() == [1_305_031_102_123_456_789]


def test_comments_blank_lines_tabs_and_line_ends(tmp_path):
    text = b"\xef\xbb\xbf# head \xc3\xa9\r\n\r\n1 1 2 3 0 0 0 1 # first\r\n2\t1\t2\t3\t0\t0\t1\t0\r\n"
    (tmp_path / "t.txt").write_bytes(text)
    trajectory = read_tum(tmp_path / "t.txt")
    np.testing.assert_allclose(trajectory.positions, [[1, 2, 3], [1, 2, 3]])
    np.testing.assert_allclose(trajectory.T[0, :3, :3], np.eye(3))
    np.testing.assert_allclose(trajectory.T[1, :3, :3], np.diag([-1, -1, 1]), atol=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f"1 {POSE}\n2 1 2 3\n", "t.txt:2: expected the 8 columns .* got 4 columns; is the line cut off"),
        (f"# head\n1 {POSE} 9\n", "t.txt:2: .* got 9"),
        ("1 a 2 3 0 0 0 1\n", "t.txt:1: expected a number, got 'a'"),
        (f"1 {POSE}\n2 1_0 2 3 0 0 0 1\n", "t.txt:2: expected plain numbers"),
        ("1 \u0661 2 3 0 0 0 1\n", "t.txt:1: expected plain numbers"),
        (f"now {POSE}\n", "t.txt:1: expected a stamp in seconds, got 'now'"),
        (f"nan {POSE}\n", "t.txt:1: expected a stamp in seconds"),
        (f"inf {POSE}\n", "t.txt:1: expected a stamp in seconds"),
        (f"1e999999999 {POSE}\n", "t.txt:1: expected a stamp in seconds"),
        (f"1e99999 {POSE}\n", "t.txt:1: .* in nanoseconds"),
        (f"1 {POSE}\n{'9' * 5000} {POSE}\n", r"t.txt:2: expected a stamp in seconds, got '9+\.\.\.'"),
        (f"4600000000 {POSE}\n", "t.txt:1: expected a stamp in seconds below 4600000000"),
        (f"1403636580838555648 {POSE}\n1403636580 {POSE}\n", "t.txt:2: .* in nanoseconds like the first"),
        (f"1 {POSE}\n1403636580838555648 {POSE}\n", "t.txt:2: .* divide it by 1e9"),
        (f"1403636580838555648.5 {POSE}\n", "t.txt:1: expected a stamp in whole nanoseconds"),
    ],
)
@pytest.mark.parametrize("repair", [False, True])
def test_what_cannot_be_read_is_an_error_with_file_and_line(write, text, message, repair):
    with pytest.raises(TrajectoryError, match=message):
        read_tum(write(text), repair=repair)


# Each file is wrong in one way: the strict error, the warning, and what is left after the repair: x by stamp in ns.
FAULTS = [
    ("1 7 0 0 0 0 0 1\n2 nan 0 0 0 0 0 1\n3 8 inf 0 0 0 0 1\n", r":2: .*NaN or infinity \(2 of 3", {1: 7.0}),
    ("1 7 0 0 0 0 0 1\n2 8 0 0 nan 0 0 1\n", r":2: .*NaN or infinity \(1 of 2", {1: 7.0}),
    ("1 7 0 0 0 0 0 1\n2 1e999 0 0 0 0 0 1\n", r":2: .*NaN or infinity \(1 of 2", {1: 7.0}),
    ("1 7 0 0 0 0 0 1\n2 8 0 0 0 0 -0 0\n", r":2: .*length 0 \(1 of 2", {1: 7.0}),
    ("1 7 0 0 0 0 0 1\n2 8 0 0 0 0 0 1.011\n", r":2: .*more than 1 % \(1 of 2", {1: 7.0, 2: 8.0}),
    ("1 7 0 0 0 0 0 0.989\n2 8 0 0 0 0 0 1\n", r":1: .*more than 1 % \(1 of 2", {1: 7.0, 2: 8.0}),
    ("1 7 0 0 1.5e308 0 0 1.5e308\n2 8 0 0 1e-310 0 0 0\n", r":1: .*more than 1 % \(2 of 2", {1: 7.0, 2: 8.0}),
    ("2 8 0 0 0 0 0 1\n1 7 0 0 0 0 0 1\n", r":2: .*increasing order.*\(1 of 2", {1: 7.0, 2: 8.0}),
    ("1 6 0 0 0 0 0 1\n1 7 0 0 0 0 0 1\n2 8 0 0 0 0 0 1\n", r":2: .*comes again \(1 of 3", {1: 7.0, 2: 8.0}),
]


@pytest.mark.parametrize(("text", "message", "left"), FAULTS)
def test_a_fault_is_refused_or_repaired_with_one_warning(write, text, message, left):
    path = write(text)
    with pytest.raises(TrajectoryError, match=message.split(r" \(")[0].split(r".*\(")[0]):
        read_tum(path)
    with pytest.warns(TrajectoryWarning, match=message) as warned:
        trajectory = read_tum(path, repair=True)
    assert len(warned) == 1
    assert warned[0].filename == __file__
    assert dict(zip((trajectory.stamps_ns // 10**9).tolist(), trajectory.positions[:, 0].tolist(), strict=True)) == left


@pytest.mark.parametrize("unusable", ["1 nan 0 0 0 0 0 1", "1 inf 0 0 0 0 0 1", "1 8 0 0 0 0 0 0"])
def test_a_valid_pose_stays_where_an_unusable_one_follows_at_its_stamp(write, unusable):
    path = write(f"1 7 0 0 0 0 0 1\n{unusable}\n")
    with pytest.raises(TrajectoryError, match=r"t\.txt:2: .*; correct the file, or have it repaired \(pose left out"):
        read_tum(path)
    # One warning: what is left comes once.
    with pytest.warns(TrajectoryWarning, match=r"t\.txt:2: .*pose left out") as warned:
        assert read_tum(path, repair=True).positions[:, 0].tolist() == [7.0]
    assert len(warned) == 1


@pytest.mark.filterwarnings("error")
def test_a_norm_off_by_less_than_a_percent_is_normalised_without_a_word(write):
    # 0.6, 0.8 and 0.606, 0.808 are the same rotation: half the angle has the sine 0.6, so cos = 1 - 2 * 0.36 = 0.28.
    trajectory = read_tum(write("1 0 0 0 0 0 0.6 0.8\n2 0 0 0 0 0 0.605 0.80666666666667\n"))
    np.testing.assert_allclose(trajectory.T[:, 0, 0], [0.28, 0.28], atol=1e-12)


def test_all_kinds_at_once_give_a_warning_each(write):
    lines = ["5 1 0 0 0 0 0 1", "1 2 0 0 0 0 0 1", "5 3 0 0 0 0 0 1", "6 nan 0 0 0 0 0 1", "7 1 0 0 0 0 0 0"]
    with pytest.warns(TrajectoryWarning) as warned:
        trajectory = read_tum(write("\n".join([*lines, "8 4 0 0 0 0 0 2"])), repair=True)
    assert len(warned) == 5
    # Of the two poses at 5 s the one further down in the file stays.
    assert trajectory.positions[:, 0].tolist() == [2.0, 3.0, 4.0]


def test_stamps_in_nanoseconds_as_of_orbslam3(write):
    path = write(f"1403636579763555584.000000 {POSE}\n1403636579813555456.000000 {POSE}\n")
    with pytest.raises(TrajectoryError, match=r"t.txt:1: expected stamps in seconds, got stamps in nanoseconds"):
        read_tum(path)
    with pytest.warns(TrajectoryWarning, match="taken as nanoseconds") as warned:
        trajectory = read_tum(path, repair=True)
    assert len(warned) == 1
    assert trajectory.stamps_ns.tolist() == [1_403_636_579_763_555_584, 1_403_636_579_813_555_456]


def test_real_ground_truth_with_repeated_stamps(shared_data):
    path = shared_data / "trajectories" / "fr2_desk_groundtruth.txt"
    with pytest.raises(TrajectoryError, match="every stamp once"):
        read_tum(path)
    with pytest.warns(TrajectoryWarning, match="comes again") as warned:
        trajectory = read_tum(path, repair=True)
    words = [line.split()[0] for line in path.read_text().splitlines() if not line.startswith("#")]
    assert len(trajectory) == len(set(words)) < len(words)
    assert f"{len(words) - len(set(words))} of {len(words)}" in str(warned[0].message)


def test_microseconds_are_not_taken_for_nanoseconds(write):
    path = write("".join(f"{1_403_636_580_000_000 + 33_333 * k} {POSE}\n" for k in range(5)))
    with pytest.raises(TrajectoryError, match="in nanoseconds"):
        read_tum(path)
    with (
        pytest.raises(TrajectoryError, match="33333 apart: are they in microseconds"),
        pytest.warns(TrajectoryWarning, match="taken as nanoseconds"),
    ):
        read_tum(path, repair=True)


def test_positions_out_of_this_world_are_left_out_or_refused(write):
    path = write(f"1 {POSE}\n2 1e200 0 0 0 0 0 1\n3 {POSE}\n")
    with pytest.raises(TrajectoryError, match=r"t.txt:2: expected positions within 1e9 m"):
        read_tum(path)
    with pytest.warns(TrajectoryWarning, match="left out as not tracked"):
        assert read_tum(path, repair=True).stamps_ns.tolist() == [10**9, 3 * 10**9]
