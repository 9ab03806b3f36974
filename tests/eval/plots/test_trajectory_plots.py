import matplotlib.pyplot as plt
import numpy as np
import pytest

from slamgym.errors import TrajectoryError
from slamgym.eval.plots import plot_trajectory_time, plot_trajectory_top, save_figure
from slamgym.eval.plots.tracked import marked_frames
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


def test_a_top_view_has_gaps_losses_and_shares(texts_of):
    T = estimate("xx......xxx.....")
    figure = plot_trajectory_top(drive(16)[:, :3, 3], {"a": T[:, :3, 3], "b": np.full((16, 3), np.nan)})
    texts = set(texts_of(figure))
    # 11 of 16 frames: 68.75 %.
    assert {"a, 69 % tracked", "b, 0 % tracked", "x (m)", "y (m)", "start", "end"} <= texts
    axes = figure.axes[0]
    assert axes.get_aspect() == 1.0
    crosses = [line for line in axes.get_lines() if line.get_marker() == "X"]
    assert [line.get_xydata().tolist() for line in crosses] == [[drive(16)[8, :2, 3].tolist()]]
    (line,) = [line for line in axes.get_lines() if line.get_label() == "a, 69 % tracked"]
    assert np.isnan(line.get_ydata()).tolist() == np.isnan(T[:, 0, 3]).tolist()


def crosses(figure):
    return [line.get_xydata()[0].tolist() for line in figure.axes[0].get_lines() if line.get_marker() == "X"]


def test_the_tracked_frames_and_not_the_lines_tell_shares_and_losses(texts_of):
    # 8 frames, tracked in all but the fourth and the last two; a line only in the first.
    T, tracked = estimate(".xxxxxxx"), np.array([1, 1, 1, 0, 1, 1, 0, 0], dtype=np.bool_)
    figure = plot_trajectory_top(drive(8)[:, :2, 3], {"a": T[:, :2, 3]}, {"a": tracked})
    assert crosses(figure) == [drive(8)[3, :2, 3].tolist(), drive(8)[6, :2, 3].tolist()]
    assert "a, 62 % tracked" in texts_of(figure)


def test_a_loss_in_a_hole_of_the_truth_is_at_the_last_known_position():
    truth = drive(10)[:, :2, 3]
    truth[[0, *range(4, 8), 9]] = np.nan
    figure = plot_trajectory_top(truth, {"a": estimate("......xxxx")[:, :2, 3]})
    assert crosses(figure) == [truth[3].tolist()]
    ends = {line.get_label(): line.get_xydata()[0].tolist() for line in figure.axes[0].get_lines()}
    assert (ends["start"], ends["end"]) == (truth[1].tolist(), truth[8].tolist())


@pytest.mark.parametrize(
    ("extent", "axes"),
    [
        ((10, 0.4, 20), "xz"),  # KITTI: y down
        ((10, 4.9, 10), "xz"),
        ((10, 5.0, 10), "xy"),
        ((10, 20, 0.4), "xy"),  # z up
        ((0.3, 0.2, 10), "xy"),
        ((10, 0), "xy"),
    ],
)
def test_a_camera_frame_is_drawn_in_x_and_z(extent, axes):
    truth = np.array([np.zeros(len(extent)), extent])
    figure = plot_trajectory_top(truth, {"a": truth + 1.0})
    assert (figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()) == (f"{axes[0]} (m)", f"{axes[1]} (m)")
    ends = {line.get_label(): line.get_xydata()[-1] for line in figure.axes[0].get_lines()}
    shown = truth[1][["xyz".index(letter) for letter in axes]]
    np.testing.assert_array_equal([ends["true path"], ends["a, 100 % tracked"]], [shown, shown + 1.0])


@pytest.mark.parametrize("estimates", [[""], [".", "x"], [".x", "x.", "xx"]])
def test_hardly_any_pose(estimates):
    truth = drive(len(estimates[0]))
    T = {tracked: estimate(tracked) for tracked in estimates}
    plot_trajectory_top(truth[:, :2, 3], {name: T[name][:, :2, 3] for name in T}).draw_without_rendering()
    plot_trajectory_time(stamps(truth), truth, T, {name: [] for name in T}).draw_without_rendering()


def test_markers_are_a_dozen_and_on_every_pose_that_stands_alone():
    assert marked_frames(np.array([0, 1, 0, 1, 1, 0, 1], dtype=np.bool_)) == [1, 3, 4, 6]
    lone = np.array([i == 7 or i >= 60 for i in range(300)])
    # 241 frames, every 20th of them, from the second on: 60, 61, 81, ... and frame 7, which has no neighbour.
    assert marked_frames(lone, 1)[:3] == [7, 60, 80]
    assert len(marked_frames(lone, 1)) == 13
    assert marked_frames(np.zeros(0, dtype=np.bool_)) == []


def test_only_the_truth(texts_of):
    assert "true path" in texts_of(plot_trajectory_top(drive(5)[:, :2, 3], {}))
    assert "truth" in texts_of(plot_trajectory_time(stamps(drive(5)), drive(5), {}, {}))


def test_hostile_names_come_out_as_they_are(hostile_names, texts_of):
    T = estimate("......")
    texts = texts_of(plot_trajectory_top(drive(6)[:, :2, 3], dict.fromkeys(hostile_names, T[:, :2, 3])))
    assert {"_hidden, 100 % tracked", "$x_1$ & <b>, 100 % tracked"} <= set(texts)
    estimates, losses = dict.fromkeys(hostile_names, T), {name: [] for name in hostile_names}
    texts = texts_of(plot_trajectory_time(stamps(T), drive(6), estimates, losses))
    assert {"_hidden, 100 % tracked, 0 losses", "_hidden", "lost"} <= set(texts)


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


def hatched(figure, panel):
    """Begin and end of what is hatched in a panel, seconds."""
    panel = figure.axes[panel]
    patches = [patch for patch in panel.patches if patch.get_hatch()]
    boxes = [patch.get_extents().transformed(panel.transData.inverted()) for patch in patches]
    return np.round([(box.x0, box.x1) for box in boxes], 6).tolist()


def test_before_its_first_pose_a_system_is_not_yet_tracked(texts_of):
    estimates = {"late": estimate("xx..x."), "never": estimate("xxxxxx"), "good": estimate("......")}
    figure = plot_trajectory_time(stamps(drive(6)), drive(6), estimates, {name: [] for name in estimates})
    assert hatched(figure, 5) == [[0.0, 0.2], [0.0, 0.5]]
    texts = texts_of(figure)
    assert {"late, 50 % tracked, 0 losses", "never, never tracked", "not yet tracked"} <= set(texts)
    good = plot_trajectory_time(stamps(drive(6)), drive(6), {"good": estimates["good"]}, {"good": []})
    assert "not yet tracked" not in texts_of(good)


def test_holes_of_the_truth_are_hatched_and_have_no_errors(texts_of):
    truth, T = drive(8), estimate("........")
    truth[[0, 3, 4, 7]] = np.nan
    figure = plot_trajectory_time(stamps(T), truth, {"a": T}, {"a": []})
    # From the last true pose before to the first one after.
    assert [hatched(figure, panel) for panel in range(5)] == [[[0.0, 0.1], [0.2, 0.5], [0.6, 0.7]]] * 5
    assert np.isnan(figure.axes[3].get_lines()[0].get_ydata()).tolist() == np.isnan(truth[:, 0, 3]).tolist()
    texts = texts_of(figure)
    assert {"a, 100 % tracked, 0 losses", "no truth"} <= set(texts)
    assert "no truth" not in texts_of(plot_trajectory_time(stamps(T), drive(8), {"a": T}, {"a": []}))


def test_tracked_frames_and_losses_of_other_systems_or_frames_are_refused():
    T, time_s = estimate("..."), stamps(drive(3))
    with pytest.raises(TrajectoryError, match=r"losses of \['a'\], got those of \['b'\]"):
        plot_trajectory_time(time_s, drive(3), {"a": T}, {"b": []})
    with pytest.raises(TrajectoryError, match=r"tracked frames of \['a'\], got those of \[\]"):
        plot_trajectory_time(time_s, drive(3), {"a": T}, {"a": []}, {})
    for flags in (np.ones(2, dtype=np.bool_), np.ones(3)):
        with pytest.raises(TrajectoryError, match=r"tracked frames of 'a' as bool \(3,\)"):
            plot_trajectory_top(drive(3)[:, :2, 3], {"a": T[:, :2, 3]}, {"a": flags})


def test_other_numbers_of_frames_are_refused():
    for shape in ((3, 2), (4, 3)):
        with pytest.raises(TrajectoryError, match=rf"\(4, 2\) of 'a'.*got \({shape[0]}, {shape[1]}\)"):
            plot_trajectory_top(np.zeros((4, 2)), {"a": np.zeros(shape)})
    with pytest.raises(TrajectoryError, match=r"\(N, 2\) or \(N, 3\), got \(4, 4\)"):
        plot_trajectory_top(np.zeros((4, 4)), {})
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
