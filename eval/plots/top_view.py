"""What all pictures of a drive from above have in common."""

from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from slamgym.eval.plots.style import LOST, TRUTH
from slamgym.types import FloatArray

LOST_CROSS: dict[str, Any] = {
    "marker": "X",
    "markersize": 9,
    "markeredgecolor": "black",
    "markeredgewidth": 0.8,
    "linestyle": "none",
    "label": "lost, from the cross on",
}


def set_top_view(axes: Axes) -> None:
    """One metre is as long in x as in y."""
    axes.set_aspect("equal")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")


def draw_truth(axes: Axes, xy: FloatArray) -> list[Line2D]:
    """The true path (N, 2) with its ends; what the legend needs of it."""
    (line,) = axes.plot(*xy.T, color=TRUTH, linewidth=2.0, zorder=1.8, label="true path")
    if not len(xy):
        return [line]
    ends = (("start", "o", xy[0]), ("end", "s", xy[-1]))
    return [line, *(_draw_end(axes, label, marker, end) for label, marker, end in ends)]


def _draw_end(axes: Axes, label: str, marker: str, xy: FloatArray) -> Line2D:
    (end,) = axes.plot(
        *xy, marker=marker, markersize=12, color=TRUTH, markerfacecolor="none", linestyle="none", label=label
    )
    return end


def draw_lost(axes: Axes, xy: FloatArray, colour: str = LOST) -> Line2D:
    """A loss along the true positions (K, 2), K >= 1: a broad band below the true path, and its start above all."""
    axes.plot(*xy.T, color=colour, alpha=0.6, linewidth=7.0, solid_capstyle="butt", zorder=1.5)
    # A loss may be shorter than the line is wide.
    (cross,) = axes.plot(*xy[0], color=colour, zorder=4, **LOST_CROSS)
    return cross
