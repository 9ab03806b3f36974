import matplotlib.pyplot as plt
import numpy as np
import pytest

from slamgym.errors import TrajectoryError
from slamgym.eval.plots import plot_trajectory_time, plot_trajectory_top, save_figure
from slamgym.eval.plots.trajectory_top import lost_runs
from slamgym.eval.robustness import find_losses
from slamgym.eval.trajectories import read_tum
from slamgym.geometry import from_quaternion, planar_pose

FRAME_S = 0.1


def drive(n):
    """True poses (n, 4, 4) on a circle, 0.1 m and 0.05 rad a frame."""
    poses = [planar_pose(2.0 * np.sin(0.05 * i), -2.0 * np.cos(0.05 * i), 0.05 * i) for i in range(n)]
    return np.array(poses).reshape(n, 4, 4)


def estimate(tracked, offset_m=0.1):
    """The drive, off in z, NaN where `tracked` has an "x"."""
    T = drive(len(tracked))
    T[:, 2, 3] += offset_m
    T[[letter == "x" for letter in tracked]] = np.nan
    return T


def stamps(T):
    return FRAME_S * np.arange(len(T))


@pytest.mark.parametrize(
    ("tracked", "losses"),
    [
        # As in `find_losses`: a loss starts after the first tracked frame, and ends with the next one or the last.
        ("xx..xx.", [(4, 6)]),
        (".x.xx", [(1, 2), (3, 4)]),
        ("...", []),
        ("xxx", []),
        ("", []),
        (".", []),
        ("x.x", [(2, 2)]),
    ],
)
def test_losses_are_where_the_positions_end(tracked, losses):
    assert lost_runs(np.array([letter == "." for letter in tracked], dtype=np.bool_)) == losses


@pytest.mark.parametrize("online", ["00xx0x", "..0x", "x", ".....", "0"])
def test_losses_agree_with_those_of_a_record(online, make_record):
    record = make_record(online)
    expected = [loss.start_frame for loss in find_losses(record)]
    assert [start for start, _ in lost_runs(np.array([letter == "0" for letter in online]))] == expected


def test_a_top_view_has_gaps_losses_and_shares(texts_of):
    T = estimate("xx......xxx.....")
    figure = plot_trajectory_top(drive(16)[:, :3, 3], {"a": T[:, :3, 3], "b": np.full((16, 2), np.nan)})
    texts = set(texts_of(figure))
    # 11 of 16 frames: 68.75 %.
    assert {"a, 68 % tracked", "b, 0 % tracked", "x (m)", "y (m)", "start", "end"} <= texts
    axes = figure.axes[0]
    assert axes.get_aspect() == 1.0
    crosses = [line for line in axes.get_lines() if line.get_marker() == "X"]
    assert [line.get_xydata().tolist() for line in crosses] == [[drive(16)[8, :2, 3].tolist()]]
    (line,) = [line for line in axes.get_lines() if line.get_label() == "a, 68 % tracked"]
    assert np.isnan(line.get_ydata()).tolist() == np.isnan(T[:, 0, 3]).tolist()


@pytest.mark.parametrize("tracked", ["", ".", "x", ".x"])
def test_hardly_any_pose(tracked, texts_of):
    T = estimate(tracked)
    truth = drive(len(tracked))
    assert "x (m)" in texts_of(plot_trajectory_top(truth[:, :2, 3], {"a": T[:, :2, 3]}))
    assert "time (s)" in texts_of(plot_trajectory_time(stamps(T), truth, {"a": T}, {"a": []}))


def test_only_the_truth(texts_of):
    assert "true path" in texts_of(plot_trajectory_top(drive(5)[:, :2, 3], {}))
    assert "truth" in texts_of(plot_trajectory_time(stamps(drive(5)), drive(5), {}, {}))


def test_hostile_names_come_out_as_they_are(hostile_names, texts_of):
    T = estimate("......")
    texts = texts_of(plot_trajectory_top(drive(6)[:, :2, 3], dict.fromkeys(hostile_names, T[:, :2, 3])))
    assert {"_hidden, 100 % tracked", "$x_1$ & <b>, 100 % tracked"} <= set(texts)
    estimates, losses = dict.fromkeys(hostile_names, T), {name: [] for name in hostile_names}
    texts = texts_of(plot_trajectory_time(stamps(T), drive(6), estimates, losses))
    assert {"_hidden, 100 % tracked, 0 losses", "_hidden, lost"} <= set(texts)


def test_errors_over_time_are_those_worked_by_hand():
    # 0.3 m along z, and turned by 0.1 rad = 5.7296 degrees about the camera's own axis.
    T = estimate("...x", offset_m=0.3)
    T = T @ from_quaternion(np.zeros((4, 3)), np.tile([0.0, 0.0, np.sin(0.05), np.cos(0.05)], (4, 1)))
    figure = plot_trajectory_time(stamps(T), drive(4), {"a": T}, {"a": []})
    trans, rot = (panel.get_lines()[0].get_ydata() for panel in figure.axes[3:5])
    assert trans == pytest.approx([0.3, 0.3, 0.3, np.nan], nan_ok=True)
    assert rot == pytest.approx([5.7296, 5.7296, 5.7296, np.nan], abs=1e-4, nan_ok=True)
    assert [panel.get_ylabel() for panel in figure.axes[:5]] == [
        "x (m)",
        "y (m)",
        "z (m)",
        "trans. error (m)",
        "rot. error (deg)",
    ]


def test_losses_over_time_are_shaded_and_counted(make_record, texts_of):
    record = make_record("000xx00x00")
    losses = find_losses(record)
    figure = plot_trajectory_time(
        stamps(record.T_world_cam), record.T_world_cam, {"a": estimate("...xx..x..")}, {"a": losses}
    )
    assert "a, 70 % tracked, 2 losses" in texts_of(figure)
    spans = [patch.get_extents().transformed(figure.axes[0].transData.inverted()) for patch in figure.axes[0].patches]
    assert [(span.x0, span.x1) for span in spans] == [
        pytest.approx((0.3, 0.5)),
        pytest.approx((0.7, 0.8)),
    ]


def test_losses_of_no_or_another_system_are_refused():
    T = estimate("...")
    with pytest.raises(TrajectoryError, match=r"losses of \['a'\], got those of \['b'\]"):
        plot_trajectory_time(stamps(T), drive(3), {"a": T}, {"b": []})


def test_other_numbers_of_frames_are_refused():
    with pytest.raises(TrajectoryError, match=r"'a'.*\(3, 2\)"):
        plot_trajectory_top(np.zeros((4, 2)), {"a": np.zeros((3, 2))})
    with pytest.raises(TrajectoryError, match=r"\(3, 4, 4\) of 'a'.*\(2, 4, 4\)"):
        plot_trajectory_time(np.arange(3.0), drive(3), {"a": drive(2)}, {"a": []})


def test_a_real_trajectory(shared_data, texts_of):
    truth = read_tum(shared_data / "trajectories" / "freiburg1_xyz-groundtruth.txt")
    assert "x (m)" in texts_of(plot_trajectory_top(truth.T[:, :3, 3], {"itself": truth.T[:, :3, 3]}))


def test_the_same_data_give_the_same_svg_and_no_picture_of_pyplot_is_left(tmp_path):
    T, truth = estimate("..x.."), drive(5)
    for name, draw in {
        "top": lambda: plot_trajectory_top(truth[:, :2, 3], {"a": T[:, :2, 3]}),
        "time": lambda: plot_trajectory_time(stamps(T), truth, {"a": T}, {"a": []}),
    }.items():
        first, _ = save_figure(draw(), tmp_path / name)
        second, _ = save_figure(draw(), tmp_path / f"{name}2")
        assert first.read_bytes() == second.read_bytes()
    assert plt.get_fignums() == []
