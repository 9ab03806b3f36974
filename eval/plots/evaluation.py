"""The pictures of estimates that were compared with one truth: what `slamgym eval --plots` writes."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from slamgym.eval.evaluation import Evaluation
from slamgym.eval.plots.cumulative import plot_cumulative
from slamgym.eval.plots.sorted_bars import plot_sorted_bars
from slamgym.eval.plots.trajectory_time import plot_trajectory_time
from slamgym.eval.plots.trajectory_top import plot_trajectory_top
from slamgym.geometry import inverse
from slamgym.types import FloatArray


def evaluation_plots(evaluations: Mapping[str, Evaluation]) -> dict[str, Figure]:
    """Pictures by name, for estimates by name, all evaluated at the same frames.

    "top": from above; "time": over time; "errors": share of the frames within an error; "ate": ATE of each
    that got through without a loss.
    """
    first = next(iter(evaluations.values()))
    stamps_ns, true_T = first.frames.stamps_ns[first.real], first.frames.ref_T[first.real]
    shown = {name: carried_poses(evaluation)[first.real] for name, evaluation in evaluations.items()}
    losses = {name: evaluation.losses for name, evaluation in evaluations.items()}
    ate = [e.summary["ate_rmse_m"] if e.summary["success"] else np.nan for e in evaluations.values()]
    return {
        "top": plot_trajectory_top(true_T[:, :3, 3], {name: T[:, :3, 3] for name, T in shown.items()}),
        "time": plot_trajectory_time((stamps_ns - stamps_ns[0]) * 1e-9, true_T, shown, losses),
        "errors": plot_cumulative(
            {name: _errors_m(evaluation) for name, evaluation in evaluations.items()},
            quantity="position error (m)",
            counted="frames",
        ),
        "ate": plot_sorted_bars({"estimates": ate}, names=list(evaluations)),
    }


def carried_poses(evaluation: Evaluation) -> FloatArray:
    """Estimated poses (N, 4, 4) of all tracked frames, NaN elsewhere, so that a line has gaps only where it was lost.

    A tracked frame without a pose of its own, as in a gap that is bridged, takes the error of the last pose before it.
    """
    _, ref_T, est_T, posed, aligned = evaluation.frames
    if not (posed.any() and aligned):
        return np.full_like(ref_T, np.nan)
    last = np.maximum.accumulate(np.where(posed, np.arange(len(posed)), np.argmax(posed)))
    carried = ref_T @ inverse(ref_T[last]) @ est_T[last]
    return np.where(evaluation.tracked[:, None, None], carried, np.nan)


def _errors_m(evaluation: Evaluation) -> FloatArray:
    """Position errors of frames, metres, NaN where not tracked; without those that lie in a hole of the truth and were
    tracked: they cannot be judged.
    """
    judged = ~evaluation.tracked
    judged[evaluation.real] = True
    ref_T, est_T = evaluation.frames.ref_T[judged], carried_poses(evaluation)[judged]
    return np.asarray(np.linalg.norm(ref_T[:, :3, 3] - est_T[:, :3, 3], axis=1))
