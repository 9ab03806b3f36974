import numpy as np
import pytest

from slamgym.errors import TrajectoryError, TrajectoryWarning
from slamgym.eval.trajectories import read_trajectory

IDENTITY = "1 0 0 0 0 1 0 0 0 0 1 0\n"
# A quarter turn about z: x goes to y.
TURNED = "0 -1 0 4 1 0 0 5 0 0 1 6\n"


def test_rows_of_matrices_with_times(write):
    times = write("0.000000e+00\n1.036224e-01\n", "times.txt")
    trajectory = read_trajectory(write(IDENTITY + TURNED), "kitti", times=times)
    assert trajectory.stamps_ns.tolist() == [0, 103_622_400]
    expected = [[0, -1, 0, 4], [1, 0, 0, 5], [0, 0, 1, 6], [0, 0, 0, 1]]
    np.testing.assert_allclose(trajectory.T, [np.eye(4), expected], atol=1e-15)


def test_a_rotation_with_few_digits_becomes_the_nearest_one(write):
    # Stretched by 1.0004: the nearest rotation is the one without the stretch.
    line = "0 -1.0004 0 4 1.0004 0 0 5 0 0 1.0004 6\n"
    trajectory = read_trajectory(write(line), times=write("3\n", "times.txt"))
    np.testing.assert_allclose(trajectory.T[0, :3, :3], [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-12)


@pytest.mark.parametrize(
    "line",
    [
        "1.01 0 0 0 0 1.01 0 0 0 0 1.01 0\n",
        "1 0 0 0 0 1 0 0 0 0 -1 0\n",
        "1 0 0 0 0 1 0 0 0 0 0 0\n",
        "1 0.01 0 0 0 1 0 0 0 0 1 0\n",
        "1e300 0 0 0 0 1e300 0 0 0 0 1e300 0\n",
    ],
)
@pytest.mark.parametrize("repair", [False, True])
@pytest.mark.filterwarnings("error")
def test_what_is_no_rotation_is_refused_with_its_line(write, line, repair):
    times = write("1\n2\n", "times.txt")
    with pytest.raises(TrajectoryError, match=r"t\.txt:3: expected a rotation matrix"):
        read_trajectory(write(f"# head\n{IDENTITY}{line}"), "kitti", times=times, repair=repair)


def test_poses_that_are_not_finite_are_left_out_with_their_times(write):
    times, path = write("1\n2\n3\n", "times.txt"), write(IDENTITY + "nan " * 12 + "\n" + TURNED)
    with pytest.raises(TrajectoryError, match=r"t.txt:2: .* NaN"):
        read_trajectory(path, times=times)
    with pytest.warns(TrajectoryWarning, match=r"t.txt:2: .*\(1 of 3 lines\); pose left out"):
        trajectory = read_trajectory(path, times=times, repair=True)
    assert trajectory.stamps_ns.tolist() == [1_000_000_000, 3_000_000_000]


def test_times_that_are_missing_or_of_another_length(write):
    path = write(IDENTITY + TURNED)
    with pytest.raises(
        TrajectoryError, match="its format has no stamps; got none: name the file with the seconds of its poses"
    ):
        read_trajectory(path, "kitti")
    with pytest.raises(TrajectoryError, match=r"each of the 3 stamps of .*times.txt, got 2"):
        read_trajectory(path, "kitti", times=write("1\n2\n3\n", "times.txt"))
    with pytest.raises(TrajectoryError, match=r"times.txt:2: expected increasing"):
        read_trajectory(path, "kitti", times=write("2\n1\n", "times.txt"))


def test_a_line_that_is_cut_off(write):
    with pytest.raises(TrajectoryError, match=r"t.txt:2: expected the 12 columns .*, got 11 columns; is the line cut"):
        read_trajectory(write(IDENTITY + TURNED[:-3]), times=write("1\n2\n", "times.txt"))
    # With 8 columns left it may be a mix-up or a cut: both are named.
    with pytest.raises(TrajectoryError, match=r"t.txt:2: .* is it in the format tum, or is the line cut off"):
        read_trajectory(write(IDENTITY + "0 -1 0 4 1 0 0 5\n"), times=write("1\n2\n", "times.txt"))
