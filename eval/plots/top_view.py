"""What all pictures of a drive from above have in common."""

from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from slamgym.eval.plots.style import LOST, TRUTH
from slamgym.eval.plots.tracked import posed_frames
from slamgym.eval.robustness import last_posed
from slamgym.eval.trajectories import Trajectory, find_holes
from slamgym.types import BoolArray, FloatArray, IntArray

LOST_CROSS: dict[str, Any] = {
    "marker": "X",
    "markersize": 9,
    "markeredgecolor": "black",
    "markeredgewidth": 0.8,
    "linestyle": "none",
    "label": "lost, from the cross on",
}


Upwards = Literal["y", "z"]


def upward_axis(positions: FloatArray) -> Upwards:
    """The axis that a picture of positions (N, 2) or (N, 3) has upwards beside x: z where they are those of a camera's
    frame, y down, so that y hardly changes, or of a camera in a hand that moved in that plane.
    """
    size = extent(positions)
    return "z" if len(size) == 3 and 2.0 * size[1] < min(size[0], size[2]) else "y"


def from_above(positions: FloatArray, upwards: Upwards) -> FloatArray:
    """What the picture shows (N, 2) of positions (N, 2) or (N, 3)."""
    return np.asarray(positions, dtype=np.float64)[:, [0, 1 if upwards == "y" else 2]]


def extent(positions: FloatArray) -> FloatArray:
    """How far the positions (N, d) reach along each axis (d,), metres; 0 without any."""
    known = positions[posed_frames(positions)]
    return np.ptp(known, axis=0) if len(known) else np.zeros(positions.shape[1])


def with_holes(stamps_ns: IntArray, true_T: FloatArray, real: BoolArray) -> FloatArray:
    """True poses (N, 4, 4), NaN beyond the first and last real one and in holes between them. A truth at a lower rate
    than the frames has none for that: what fills it is drawn.
    """
    rows = np.flatnonzero(real)
    known = np.logical_or.accumulate(real) & np.logical_or.accumulate(real[::-1])[::-1]
    before = find_holes(Trajectory(stamps_ns[rows], true_T[rows]), 0.0)
    for start, after in zip(rows[before], rows[before + 1], strict=True):
        known[start + 1 : after] = False
    return np.where(known[:, None, None], true_T, np.nan)


def set_top_view(axes: Axes, upwards: Upwards = "y") -> None:
    """One metre is as long in x as upwards."""
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
