"""The truth and what each system made of it, seen from above."""

from collections.abc import Mapping

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from slamgym.errors import TrajectoryError
from slamgym.eval.plots.names import percent, plain_names
from slamgym.eval.plots.style import Look, legend_below, look, new_figure, tidy
from slamgym.eval.plots.top_view import LOST_CROSS, draw_lost, draw_truth, set_top_view
from slamgym.types import BoolArray, FloatArray


def plot_trajectory_top(truth: FloatArray, estimates: Mapping[str, FloatArray]) -> Figure:
    """True positions (N, 2) or (N, 3), metres, and each estimate of the same frames, aligned to them.

    An estimate is NaN where it was not tracked: a gap in its line. Where tracking ended, the true path bears a cross
    in the estimate's colour and a band up to where it went on. The legend says what share of the frames was tracked.
    Raises TrajectoryError.
    """
    true_xy = _checked("truth", truth, len(truth))
    paths = {name: _checked(name, positions, len(truth)) for name, positions in estimates.items()}
    figure = new_figure(8.0, _height(true_xy, 8.0) + 0.25 * len(paths))
    axes = figure.add_subplot()
    set_top_view(axes)
    tidy(axes)
    handles: list[Artist] = [*draw_truth(axes, true_xy)]
    for i, (name, xy) in enumerate(zip(plain_names(paths), paths.values(), strict=True)):
        tracked = tracked_rows(xy)
        handles.append(_draw_path(axes, xy, look(i), f"{name}, {tracked_share(tracked)}", i))
        for start, end in lost_runs(tracked):
            draw_lost(axes, true_xy[start : end + 1], look(i).colour)
    handles.append(Line2D([], [], color="white", **LOST_CROSS))
    legend_below(figure, handles)
    return figure


def tracked_rows(values: FloatArray) -> BoolArray:
    """Whether a frame's pose or position is there, for each frame (N,) of arrays (N, ...)."""
    return np.asarray(np.isfinite(values).all(axis=tuple(range(1, values.ndim))))


def tracked_share(tracked: BoolArray) -> str:
    """How much of the frames (N,) was tracked, in words."""
    return f"{percent(float(np.mean(tracked)) if len(tracked) else 0.0)} tracked"


def lost_runs(tracked: BoolArray) -> list[tuple[int, int]]:
    """First lost frame of each loss after the first tracked one, and the next tracked frame, or the last of all."""
    first = int(np.argmax(tracked)) if tracked.any() else len(tracked)
    edges = first + 1 + np.flatnonzero(np.diff(np.append(tracked[first:], True)))
    last = len(tracked) - 1
    return [(int(start), min(int(end), last)) for start, end in zip(edges[0::2], edges[1::2], strict=True)]


def _checked(name: str, positions: FloatArray, n: int) -> FloatArray:
    """Positions from above (N, 2)."""
    shape = np.shape(positions)
    if len(shape) != 2 or shape[0] != n or shape[1] not in (2, 3):
        raise TrajectoryError(
            f"plot_trajectory_top: expected positions ({n}, 2) or ({n}, 3) of {name!r}, NaN where not tracked, "
            f"got {shape}"
        )
    return np.asarray(positions, dtype=np.float64)[:, :2]


def _height(xy: FloatArray, width_in: float) -> float:
    """Inches in which the path's proportions fill the width, within what a page holds."""
    if not np.isfinite(xy).any():
        return width_in / 2
    size = np.nanmax(xy, axis=0) - np.nanmin(xy, axis=0) + 1e-9
    return float(np.clip(width_in * size[1] / size[0], 3.0, 8.0)) + 1.0


def _draw_path(axes: Axes, xy: FloatArray, style: Look, label: str, i: int) -> Line2D:
    every = max(len(xy) // 12, 1)
    (line,) = axes.plot(
        *xy.T, color=style.colour, linestyle=style.dash, linewidth=1.6, marker=style.marker, markersize=5,
        markeredgecolor="white", markeredgewidth=0.5, markevery=(i % every, every), zorder=2.5, label=label,
    )  # fmt: skip
    return line
