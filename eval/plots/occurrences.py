"""In which repeats something happened, for several cases under several conditions."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from slamgym.errors import ConfigError
from slamgym.eval.plots.names import plain
from slamgym.eval.plots.style import LOST, legend_below, new_figure

Counts = Mapping[str, tuple[int, int]]
"""Condition -> in how many repeats it happened, and of how many."""

MOST_DOTS = 10
"""A row of more would not fit its column, and is written in figures."""
TRACKED = "0.35"
NOT_TRIED = "\N{EN DASH}"


def plot_occurrences(cases: Mapping[str, Counts], *, happened: str = "lost", did_not: str = "tracked") -> Figure:
    """A column for each case, a row for each condition, and a dot for each repeat: filled where it happened.

    A condition that a case was not tried under has a dash. Raises ConfigError where there is nothing to draw, and for
    counts that cannot be.
    """
    conditions = list(dict.fromkeys(name for counts in cases.values() for name in counts))
    if not conditions:
        raise ConfigError("plot_occurrences: expected at least one case with a condition, got none")
    letters = max(len(name) for name in conditions)
    figure = new_figure(0.6 + 0.075 * letters + 1.25 * len(cases), 0.9 + 0.27 * len(conditions))
    axes = figure.add_subplot()
    for x, counts in enumerate(cases.values()):
        for y, name in enumerate(conditions):
            _draw_cell(axes, x, y, counts.get(name))
    axes.set_xticks(range(len(cases)), ["\n".join(plain(line) for line in name.splitlines()) for name in cases])
    axes.set_yticks(range(len(conditions)), [plain(name) for name in conditions])
    axes.set(xlim=(-0.5, len(cases) - 0.5), ylim=(len(conditions) - 0.5, -0.5))
    axes.xaxis.tick_top()
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    axes.hlines(np.arange(len(conditions) - 1) + 0.5, -0.5, len(cases) - 0.5, color="0.9", linewidth=0.8)
    legend_below(figure, [_dots([], [], True, happened), _dots([], [], False, did_not)])
    return figure


def _draw_cell(axes: Axes, x: int, y: int, count: tuple[int, int] | None) -> None:
    if count is None:
        axes.text(x, y, NOT_TRIED, ha="center", va="center", color=TRACKED)
        return
    times, repeats = count
    if not 0 <= times <= repeats:
        raise ConfigError(f"plot_occurrences: expected a count of 0 or more and at most the repeats, got {count}")
    if repeats > MOST_DOTS:
        axes.text(x, y, f"{times} of {repeats}", ha="center", va="center", color=LOST if times else TRACKED)
        return
    places = x + 0.085 * (np.arange(repeats) - (repeats - 1) / 2)
    axes.add_line(_dots(places[:times], np.full(times, y), True))
    axes.add_line(_dots(places[times:], np.full(repeats - times, y), False))


def _dots(x: object, y: object, filled: bool, label: str = "") -> Line2D:
    colour = LOST if filled else TRACKED
    return Line2D(
        np.asarray(x, dtype=np.float64),
        np.asarray(y, dtype=np.float64),
        linestyle="none",
        marker="o",
        markersize=6,
        color=colour,
        markerfacecolor=colour if filled else "white",
        label=label,
    )
