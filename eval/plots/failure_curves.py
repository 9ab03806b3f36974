"""How often runs fail as a factor grows, at each level of another factor."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from slamgym.errors import ConfigError
from slamgym.eval.plots.failure_curve import Curve, set_level_ticks
from slamgym.eval.plots.names import plain, plain_names
from slamgym.eval.plots.style import Look, legend_below, look, new_figure, tidy
from slamgym.types import FloatArray, IntArray


class FailureCounts(NamedTuple):
    """How many runs failed, of how many, at levels of a factor (L,) each; and the curve fitted to them, if one is."""

    levels: FloatArray
    failed: IntArray
    runs: IntArray
    curve: Curve | None = None


def plot_failure_curves(series: Mapping[str, FailureCounts], *, factor: str = "speed (m/s)", by: str = "") -> Figure:
    """A series of points and its fitted curve for each level of a second factor; by: what that factor is.

    A vertical line of the same look is where half of the runs fail. Raises ConfigError.
    """
    if not series or not all(len(counts.levels) for counts in series.values()):
        raise ConfigError("plot_failure_curves: expected counts at one level or more of each series, got none")
    x = np.concatenate([counts.levels for counts in series.values()])
    margin = 0.06 * float(np.ptp(x)) or 0.5
    limits = float(x.min()) - margin, float(x.max()) + margin
    figure = new_figure(7.5, 4.8)
    axes = figure.add_subplot()
    axes.set(xlim=limits, ylim=(-0.02, 1.02), xlabel=plain(factor, 60), ylabel="share of failed runs")
    axes.yaxis.set_major_formatter("{x:.0%}")
    set_level_ticks(axes, x)
    tidy(axes)
    handles = list[Artist]()
    for i, (name, counts) in enumerate(zip(plain_names(series), series.values(), strict=True)):
        label = f"{name}: {counts.failed.sum()} of {counts.runs.sum()} failed"
        handles.append(_draw(axes, counts, look(i), label))
    if by:
        axes.set_title(f"by {plain(by, 60)}", loc="left")
    legend_below(figure, handles)
    return figure


def _draw(axes: Axes, counts: FailureCounts, style: Look, label: str) -> Artist:
    share = counts.failed / counts.runs
    if counts.curve is None:
        axes.plot(counts.levels, share, color=style.colour, linestyle=style.dash, linewidth=1.5)
    else:
        x = np.linspace(*axes.get_xlim(), 200)
        axes.plot(x, counts.curve.probability(x), color=style.colour, linestyle=style.dash, linewidth=1.8)
        if axes.get_xlim()[0] < counts.curve.midpoint.estimate < axes.get_xlim()[1]:
            axes.axvline(counts.curve.midpoint.estimate, color=style.colour, linestyle=style.dash, linewidth=0.9)
    (points,) = axes.plot(
        counts.levels, share, color=style.colour, linestyle=style.dash, linewidth=0, marker=style.marker, markersize=7,
        label=label, clip_on=False, zorder=4,
    )  # fmt: skip
    return points
