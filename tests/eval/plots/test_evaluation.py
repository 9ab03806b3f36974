"""The pictures of an evaluation say what its figures say."""

import warnings

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from slamgym.errors import ConfigError, TrajectoryWarning
from slamgym.eval.evaluation import Evaluation, evaluate, evaluate_at
from slamgym.eval.plots import evaluation_plots
from slamgym.eval.plots.evaluation import carried_errors_m, carried_poses
from slamgym.eval.reference import EvalParams, prepare
from slamgym.eval.summary import FramePoses
from slamgym.eval.trajectories import Trajectory
from slamgym.geometry import planar_pose

N, FRAME_NS = 50, 100_000_000


def drive():
    """N true poses, 0.1 s, 0.1 m and 0.05 rad apart."""
    T = np.array([planar_pose(2.0 * np.sin(0.05 * i), -2.0 * np.cos(0.05 * i), 0.05 * i) for i in range(N)])
    return Trajectory(FRAME_NS * np.arange(N, dtype=np.int64), T)


def estimate(frames, error_m=0.05):
    """The truth at the frames, but to and fro in z."""
    truth, chosen = drive(), np.array(frames, dtype=np.int64)
    T = truth.T[chosen]
    T[:, 2, 3] += error_m * (-1.0) ** np.arange(len(chosen))
    return Trajectory(truth.stamps_ns[chosen], T)


ESTIMATES = {
    "ok": range(N),
    "late": range(20, N),
    "lost": [*range(10, 20), *range(30, N)],
    "lost in the hole": [*range(27), *range(35, N)],
    "never": [],
    "one pose": [5],
}


@pytest.fixture(scope="module", params=[False, True], ids=["whole truth", "truth with a hole"])
def evaluations(request):
    """All ESTIMATES, with frames; without or with a hole of the truth from frame 25 to 39, which `ok` has poses in."""
    kept = np.delete(np.arange(N), np.s_[25:40] if request.param else [])
    truth, params = drive(), EvalParams(alignment="se3")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", TrajectoryWarning)
        reference = prepare(Trajectory(truth.stamps_ns[kept], truth.T[kept]), params, truth.stamps_ns)
        return {name: evaluate_at(reference, estimate(frames), params) for name, frames in ESTIMATES.items()}


@pytest.fixture(scope="module")
def plots(evaluations):
    return evaluation_plots(evaluations)


def lines(axes):
    """The lines of the axes by the name that their label begins with."""
    named = {
        line.get_label().split(",")[0].split(":")[0]: line for line in axes.get_lines() if line.get_marker() != "X"
    }
    return {name: line for name, line in named.items() if name in ESTIMATES}


def texts(figure):
    return {text.get_text() for legend in figure.legends for text in legend.get_texts()}


def test_a_bar_is_the_ate_of_a_run_that_succeeded_and_failed_for_any_other(plots, evaluations):
    figure = plots["ate"]
    axes = figure.axes[0]
    names = [tick.get_text() for tick in axes.get_xticklabels()]
    bars = [bar for container in axes.containers for bar in container]
    shown = {name: bar.get_y() + bar.get_height() for name, bar in zip(names, bars, strict=True)}
    hatched = {name for name, bar in zip(names, bars, strict=True) if bar.get_hatch()}
    assert hatched == {"lost", "lost in the hole", "never", "one pose"}
    assert np.isfinite(evaluations["lost"].summary["ate_rmse_m"])
    for name in ("ok", "late"):
        assert shown[name] == pytest.approx(evaluations[name].summary["ate_rmse_m"])
    assert axes.get_title(loc="left") == "estimates: 4 of 6 runs failed"
    assert "failed: lost once, not tracked to the end, below 50 % complete" in figure.get_suptitle()


def test_each_curve_of_errors_ends_at_the_completion(plots, evaluations):
    ends = {name: line.get_ydata()[-1] for name, line in lines(plots["errors"].axes[0]).items()}
    completion = {name: evaluation.summary["completion"] for name, evaluation in evaluations.items()}
    # 30, 30 and 42 of 50 frames, in the hole or not; one pose cannot be aligned and has no error.
    assert completion == pytest.approx(
        {"ok": 1.0, "late": 0.6, "lost": 0.6, "lost in the hole": 0.84, "never": 0.0, "one pose": 0.02}
    )
    assert ends == pytest.approx(completion | {"one pose": 0.0})
    assert {"ok: 0 of 50 frames not tracked or not aligned", "never: 50 of 50 frames not tracked or not aligned"} <= (
        texts(plots["errors"])
    )


def test_where_all_are_aligned_only_untracked_frames_are_left_out(evaluations):
    aligned = {name: evaluation for name, evaluation in evaluations.items() if name != "one pose"}
    assert "late: 20 of 50 frames not tracked" in texts(evaluation_plots(aligned)["errors"])


def test_legends_give_the_figures_of_the_table(plots):
    assert {
        "ok, 100 % tracked, 0 losses",
        "late, 60 % tracked, 0 losses",
        "lost, 60 % tracked, 1 loss",
        "lost in the hole, 84 % tracked, 1 loss",
        "never, never tracked",
        "one pose, 2 % tracked, 1 loss",
    } <= texts(plots["time"])
    assert {"ok, 100 % tracked", "lost in the hole, 84 % tracked", "never, 0 % tracked"} <= texts(plots["top"])


def test_lines_have_gaps_in_holes_and_where_lost_and_none_without_an_alignment(plots, evaluations):
    hole = np.zeros(N, dtype=np.bool_)
    if "no truth" in texts(plots["time"]):
        hole[25:40] = True
    assert hole.any() == (not evaluations["ok"].real.all())
    truth = next(line for line in plots["top"].axes[0].get_lines() if line.get_label() == "true path")
    np.testing.assert_array_equal(np.isnan(truth.get_ydata()), hole)
    expected = {name: ~evaluation.tracked | hole for name, evaluation in evaluations.items()}
    expected["one pose"] = np.ones(N, dtype=np.bool_)
    for axes in (plots["top"].axes[0], *plots["time"].axes[:5]):
        for name, line in lines(axes).items():
            np.testing.assert_array_equal(np.isnan(line.get_ydata()), expected[name], err_msg=name)


def rms(values):
    return np.sqrt(np.nanmean(values**2))


def test_errors_over_time_are_those_of_the_table(plots, evaluations):
    trans, rot = (lines(panel) for panel in plots["time"].axes[3:5])
    for name in ("ok", "late", "lost", "lost in the hole"):
        summary = evaluations[name].summary
        assert rms(trans[name].get_ydata()) == pytest.approx(summary["ate_rmse_m"])
        assert rms(rot[name].get_ydata()) == pytest.approx(summary["ate_rot_rmse_deg"])


def test_a_turn_that_the_alignment_leaves_free_is_no_error_over_time():
    # Along a straight line, positions do not tell the turn about it: 0.5 rad would be 28.6 degrees.
    straight = np.tile(np.eye(4), (N, 1, 1))
    straight[:, 0, 3] = 0.1 * np.arange(N)
    stamps_ns, turned = drive().stamps_ns, straight.copy()
    turned[:, :3, :3] = Rotation.from_euler("x", 0.5).as_matrix()
    evaluation = evaluate(Trajectory(stamps_ns, straight), Trajectory(stamps_ns, turned), None, stamps_ns)
    rot = lines(evaluation_plots({"ok": evaluation})["time"].axes[4])["ok"].get_ydata()
    assert evaluation.summary["ate_rot_rmse_deg"] == pytest.approx(0.0, abs=1e-4)
    assert rot == pytest.approx(np.zeros(N), abs=1e-4)


def test_crosses_are_at_the_losses_or_at_the_last_true_position_before(plots, evaluations):
    crosses = [line.get_xydata()[0] for line in plots["top"].axes[0].get_lines() if line.get_marker() == "X"]
    in_hole = 27 if evaluations["ok"].real.all() else 24
    np.testing.assert_allclose(crosses, drive().T[[20, in_hole, 6], :2, 3], atol=1e-9)


def by_hand(true_x, est_x, *, tracked, real=None, aligned=True):
    """An evaluation of frames along x, NaN in `est_x` where there is no pose to judge."""
    n = len(true_x)
    ref_T, est_T = np.tile(np.eye(4), (2, n, 1, 1))
    ref_T[:, 0, 3], est_T[:, 0, 3] = true_x, est_x
    frames = FramePoses(FRAME_NS * np.arange(n, dtype=np.int64), ref_T, est_T, np.isfinite(est_x), aligned)
    summary = {"ate_rmse_m": np.nan, "success": False}
    real = np.ones(n, dtype=np.bool_) if real is None else np.array(real, dtype=np.bool_)
    return Evaluation(frames, real, np.array(tracked, dtype=np.bool_), [], summary)


NAN = np.nan


def test_a_tracked_frame_without_a_pose_is_as_far_off_as_the_last_one_with_one():
    # 0.3 m ahead at 1 m and 0.1 m behind at 3 m; frame 0 takes the error of the first, frame 5 is not tracked.
    evaluation = by_hand([0, 1, 2, 3, 4, 5], [NAN, 1.3, NAN, 2.9, NAN, NAN], tracked=[1, 1, 1, 1, 1, 0])
    carried_x = carried_poses(evaluation, evaluation.frames.ref_T)[:, 0, 3]
    assert carried_x == pytest.approx([0.3, 1.3, 2.3, 2.9, 3.9, NAN], nan_ok=True)
    assert carried_errors_m(evaluation) == pytest.approx([0.3, 0.3, 0.3, 0.1, 0.1, NAN], nan_ok=True)


def test_an_estimate_that_is_not_aligned_has_no_place_and_no_error():
    evaluation = by_hand([0, 1], [7.0, 8.0], tracked=[1, 1], aligned=False)
    assert np.isnan(carried_poses(evaluation, evaluation.frames.ref_T)).all()
    assert np.isnan(carried_errors_m(evaluation)).all()


def test_a_truth_at_a_lower_rate_than_the_frames_has_no_holes_for_that():
    x = np.arange(30.0)
    every_third = np.isin(np.arange(30), [3, 6, 9, 21, 24, 27])
    figure = evaluation_plots({"a": by_hand(x, x, tracked=np.ones(30), real=every_third)})["top"]
    truth = figure.axes[0].get_lines()[0].get_xdata()
    # Only the step from 9 to 21 is more than three usual ones; before frame 3 and after 27 nothing is known.
    assert np.flatnonzero(np.isnan(truth)).tolist() == [0, 1, 2, *range(10, 21), 28, 29]


def test_no_evaluation_is_refused():
    with pytest.raises(ConfigError, match="at least one evaluation"):
        evaluation_plots({})
