import numpy as np
import pytest

from slamgym.errors import TrajectoryError, TrajectoryWarning
from slamgym.eval.trajectories import read_trajectory

HEAD = "timestamp,p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []"
# Half a turn about x: w first would otherwise be read as half a turn about another axis.
LINES = "1403636580838555648,4.5,-1.5,0.75,0,1,0,0\n1403636580843555328,4.5,-1.5,0.75,1,0,0,0\n"


@pytest.mark.parametrize("head", ["", f"#{HEAD}\n", f"{HEAD}\n", f"\n{HEAD}\n", f"# by hand\n{HEAD}\n"])
@pytest.mark.parametrize("format_", ["euroc", None])
def test_the_quaternion_has_its_w_first_and_a_header_is_optional(write, head, format_):
    trajectory = read_trajectory(write(head + LINES), format_)
    assert trajectory.stamps_ns.tolist() == [1_403_636_580_838_555_648, 1_403_636_580_843_555_328]
    np.testing.assert_array_equal(trajectory.positions, [[4.5, -1.5, 0.75]] * 2)
    np.testing.assert_allclose(trajectory.T[:, :3, :3], [np.diag([1, -1, -1]), np.eye(3)], atol=1e-15)


def test_further_columns_and_spaces_do_not_matter(write):
    text = LINES.replace("\n", ",0.1,0.2,0.3\n").replace(",", ", ")
    assert len(read_trajectory(write(text))) == 2


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (LINES + "1403636580848555520,4.5,-1.5", r":3: expected 8 columns .* got 3"),
        (LINES.replace("\n", ",1,2\n")[:-3], ":2: expected 10 columns .* got 9"),
        ("1,2,3,4,5,6,7\n", r":1: expected 8 columns .* got 7 columns; is the line cut off\?"),
        ("1403636580.838,4.5,-1.5,0.75,0,1,0,0\n", ":1: .* whole nanoseconds, .*: is it in seconds"),
        (f"{LINES}{HEAD}\n", ":3: expected plain numbers"),
        (f"{HEAD}\n{HEAD}\n{LINES}", ":2: expected plain numbers"),
        ("9223372036854775808,4.5,-1.5,0.75,0,1,0,0\n", ":1: expected a stamp in nanoseconds below"),
        ("1403636580838555648,4.5,x,0.75,0,1,0,0\n", ":1: expected a number, got 'x'"),
    ],
)
def test_errors_name_the_line(write, text, message):
    with pytest.raises(TrajectoryError, match=f"t.txt{message}"):
        read_trajectory(write(text), "euroc", repair=True)


def test_repeated_stamps(write):
    path = write(LINES + LINES.splitlines()[1].replace("4.5", "9.0"))
    with pytest.raises(TrajectoryError, match=r"t\.txt:3: expected every stamp once"):
        read_trajectory(path)
    with pytest.warns(TrajectoryWarning, match=r"t.txt:3: .*\(1 of 3 lines\)"):
        assert read_trajectory(path, repair=True).positions[:, 0].tolist() == [4.5, 9.0]
