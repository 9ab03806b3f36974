"""The truth and what each system made of it, seen from above."""

from collections.abc import Mapping

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from slamgym.errors import TrajectoryError
from slamgym.eval.plots.names import plain_names
from slamgym.eval.plots.style import Look, legend_below, look, new_figure, tidy
from slamgym.eval.plots.top_view import LOST_CROSS, draw_lost, draw_truth, extent, from_above, set_top_view, upward_axis
from slamgym.eval.plots.tracked import marked_frames, posed_frames, tracked_frames, tracked_share
from slamgym.eval.robustness import untracked_runs
from slamgym.types import BoolArray, FloatArray


def plot_trajectory_top(
    truth: FloatArray, estimates: Mapping[str, FloatArray], tracked: Mapping[str, BoolArray] | None = None
) -> Figure:
    """True positions (N, 2) or (N, 3), metres, and each estimate of the same frames and shape, aligned to them.

    A position is NaN where there is none: a gap in the line. tracked: the frames of each estimate that count as
    tracked, bool (N,); by default those with a position. Where tracking ended, the true path bears a cross in the
    estimate's colour, at the last known position before it where the truth has none, and a band up to where it went on.
    The legend says what share of the frames was tracked. Three coordinates of which y hardly changes are those of a
    camera's frame, as KITTI has them, y down: then x and z are drawn. Raises TrajectoryError.
    """
    _check(truth, estimates)
    frames = tracked_frames(estimates, tracked)
    upwards = upward_axis(truth)
    true_xy, *paths = (from_above(positions, upwards) for positions in (truth, *estimates.values()))
    figure = new_figure(8.0, _height(true_xy, 8.0))
    axes = figure.add_subplot()
    set_top_view(axes, upwards)
    tidy(axes)
    handles: list[Artist] = [*draw_truth(axes, true_xy)]
    for i, (name, xy, flags) in enumerate(zip(plain_names(estimates), paths, frames.values(), strict=True)):
        handles.append(_draw_path(axes, xy, look(i), f"{name}, {tracked_share(flags)}", i))
        for start, after in untracked_runs(flags):
            draw_lost(axes, true_xy, start, after, look(i).colour)
    handles.append(Line2D([], [], color="white", **LOST_CROSS))
    legend_below(figure, handles)
    return figure


def _check(truth: FloatArray, estimates: Mapping[str, FloatArray]) -> None:
    shape = np.shape(truth)
    if len(shape) != 2 or shape[1] not in (2, 3):
        raise TrajectoryError(f"plot_trajectory_top: expected true positions (N, 2) or (N, 3), got {shape}")
    for name, positions in estimates.items():
        if np.shape(positions) != shape:
            raise TrajectoryError(
                f"plot_trajectory_top: expected positions {shape} of {name!r}, as of the truth, NaN where not tracked, "
                f"got {np.shape(positions)}"
            )


def _height(xy: FloatArray, width_in: float) -> float:
    """Inches in which the path's proportions fill the width, within what a page holds."""
    size = extent(xy) + 1e-9
    return float(np.clip(width_in * size[1] / size[0], 3.0, 8.0)) + 1.0


def _draw_path(axes: Axes, xy: FloatArray, style: Look, label: str, i: int) -> Line2D:
    (line,) = axes.plot(
        *xy.T, color=style.colour, linestyle=style.dash, linewidth=1.6, marker=style.marker, markersize=5,
        markeredgecolor="white", markeredgewidth=0.5, markevery=marked_frames(posed_frames(xy), i), zorder=2.5,
        label=label,
    )  # fmt: skip
    return line
