"""What all pictures of a drive from above have in common."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from slamgym.eval.plots.style import LOST, TRUTH
from slamgym.eval.plots.tracked import posed_frames
from slamgym.eval.robustness import last_posed
from slamgym.types import FloatArray

LOST_CROSS: dict[str, Any] = {
    "marker": "X",
    "markersize": 9,
    "markeredgecolor": "black",
    "markeredgewidth": 0.8,
    "linestyle": "none",
    "label": "lost, from the cross on",
}


def set_top_view(axes: Axes, upwards: str = "y") -> None:
    """One metre is as long in x as upwards, where the picture has the axis y or, in a camera's frame, z."""
    axes.set_aspect("equal")
    axes.set_xlabel("x (m)")
    axes.set_ylabel(f"{upwards} (m)")


def draw_truth(axes: Axes, xy: FloatArray) -> list[Line2D]:
    """The true path (N, 2), NaN where it is not known, with its ends; what the legend needs of it."""
    (line,) = axes.plot(*xy.T, color=TRUTH, linewidth=2.0, zorder=1.8, label="true path")
    known = np.flatnonzero(posed_frames(xy))
    if not len(known):
        return [line]
    ends = (("start", "o", xy[known[0]]), ("end", "s", xy[known[-1]]))
    return [line, *(_draw_end(axes, label, marker, end) for label, marker, end in ends)]


def _draw_end(axes: Axes, label: str, marker: str, xy: FloatArray) -> Line2D:
    (end,) = axes.plot(
        *xy, marker=marker, markersize=12, color=TRUTH, markerfacecolor="none", linestyle="none", label=label
    )
    return end


def draw_lost(axes: Axes, xy: FloatArray, start: int, after: int, colour: str = LOST) -> Line2D:
    """A loss from frame `start` on, up to `after`, the next tracked one: a broad band below the true path (N, 2), and
    a cross above all where it started, or at the last known position before.
    """
    axes.plot(*xy[start : after + 1].T, color=colour, alpha=0.6, linewidth=7.0, solid_capstyle="butt", zorder=1.5)
    last_known = last_posed(posed_frames(xy))
    # A loss may be shorter than the line is wide.
    (cross,) = axes.plot(*xy[last_known[start]], color=colour, zorder=4, **LOST_CROSS)
    return cross
