"""The pictures of estimates that were compared with one truth: what `slamgym eval --plots` writes."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from slamgym.errors import ConfigError
from slamgym.eval.accuracy import absolute_errors
from slamgym.eval.evaluation import Evaluation
from slamgym.eval.plots.cumulative import plot_cumulative
from slamgym.eval.plots.names import percent
from slamgym.eval.plots.sorted_bars import plot_sorted_bars
from slamgym.eval.plots.top_view import with_holes
from slamgym.eval.plots.trajectory_time import plot_trajectory_time
from slamgym.eval.plots.trajectory_top import plot_trajectory_top
from slamgym.eval.robustness import SUCCESS_COMPLETION, last_posed
from slamgym.geometry import inverse
from slamgym.types import FloatArray

FAILED_WHEN = f"lost once, not tracked to the end, below {percent(SUCCESS_COMPLETION)} complete, or without an ATE"


def evaluation_plots(evaluations: Mapping[str, Evaluation]) -> dict[str, Figure]:
    """Pictures by name, for estimates by name, all evaluated at the same N frames.

    "top": from above; "time": over time; "errors": share of all frames within a position error; "ate": ATE of each that
    succeeded. Lines have gaps in holes of the truth; what counts as tracked or lost is told by the evaluations alone.
    Raises ConfigError without any.
    """
    if not evaluations:
        raise ConfigError("evaluation_plots: expected at least one evaluation, got none; give {name: evaluation}")
    frames = next(iter(evaluations.values())).frames
    real = np.any([evaluation.real for evaluation in evaluations.values()], axis=0)
    true_T = with_holes(frames.stamps_ns, frames.ref_T, real)
    shown = {name: carried_poses(evaluation, true_T) for name, evaluation in evaluations.items()}
    tracked = {name: evaluation.tracked for name, evaluation in evaluations.items()}
    losses = {name: evaluation.losses for name, evaluation in evaluations.items()}
    positions = {name: T[:, :3, 3] for name, T in shown.items()}
    time_s = (frames.stamps_ns - frames.stamps_ns[0]) * 1e-9
    return {
        "top": plot_trajectory_top(true_T[:, :3, 3], positions, tracked),
        "time": plot_trajectory_time(time_s, true_T, shown, losses, tracked),
        "errors": _plot_errors(evaluations),
        "ate": _plot_ate(evaluations),
    }


def carried_poses(evaluation: Evaluation, true_T: FloatArray) -> FloatArray:
    """Estimated poses (N, 4, 4) of all tracked frames, NaN elsewhere and where true_T (N, 4, 4) is NaN.

    A tracked frame that has no pose to judge, as in a gap that is bridged, is as far off as the last one that has.
    """
    frames = evaluation.frames
    if not _has_errors(evaluation):
        return np.full_like(true_T, np.nan)
    last = last_posed(frames.judged)
    carried = true_T @ inverse(frames.ref_T[last]) @ frames.turned_T[last]
    return np.where(evaluation.tracked[:, None, None], carried, np.nan)


def carried_errors_m(evaluation: Evaluation) -> FloatArray:
    """Position errors of all frames (N,), metres, NaN where not tracked.

    A tracked frame that cannot be judged, for want of a true or an estimated pose, takes the error of the last that
    can, or before it of the first. NaN everywhere when the estimate could not be aligned.
    """
    frames = evaluation.frames
    errors_m = np.full(len(frames.judged), np.nan)
    if _has_errors(evaluation):
        errors_m[frames.judged], _ = absolute_errors(frames.ref_T[frames.judged], frames.est_T[frames.judged])
        errors_m = errors_m[last_posed(frames.judged)]
    return np.where(evaluation.tracked, errors_m, np.nan)


def _has_errors(evaluation: Evaluation) -> bool:
    return bool((evaluation.frames.judged & evaluation.frames.aligned).any())


def _plot_errors(evaluations: Mapping[str, Evaluation]) -> Figure:
    all_judged = all(_has_errors(evaluation) or not evaluation.tracked.any() for evaluation in evaluations.values())
    return plot_cumulative(
        {name: carried_errors_m(evaluation) for name, evaluation in evaluations.items()},
        quantity="position error (m)",
        counted="frames",
        failed="not tracked" if all_judged else "not tracked or not aligned",
    )


def _plot_ate(evaluations: Mapping[str, Evaluation]) -> Figure:
    ate_m = [e.summary["ate_rmse_m"] if e.summary["success"] else np.nan for e in evaluations.values()]
    return plot_sorted_bars({"estimates": ate_m}, names=list(evaluations), failed_when=FAILED_WHEN)
