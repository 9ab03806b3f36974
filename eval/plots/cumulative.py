"""The share of all runs whose error is at most x: a failed run never gets there."""

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from slamgym.eval.plots.names import percent, plain_names
from slamgym.eval.plots.style import Look, legend_below, look, new_figure, tidy
from slamgym.eval.plots.value_scale import (
    ValueScale,
    as_runs,
    failed_of,
    failed_runs,
    placed,
    set_value_axis,
    value_scale,
)
from slamgym.types import FloatArray

# Least distance of two labels at the curves' ends, in shares of the axis, as long as all have room.
LABEL_STEP = 0.055
# Of more values than this every so many make a step: finer ones cannot be seen.
MAX_STEPS = 1000


def plot_cumulative(
    values: Mapping[str, ArrayLike],
    *,
    quantity: str = "ATE RMSE (m)",
    counted: str = "runs",
    failed: str = "failed",
) -> Figure:
    """A curve for each system over its values (R,), on a logarithmic x axis; its end is the share that did not fail.

    A failed run is NaN or infinite, and counts in the total. counted: what the values are of, for example "frames";
    failed: the word for those that failed. Raises ConfigError.
    """
    runs = as_runs(values)
    scale = value_scale(runs.values())
    figure = new_figure(8.0, 5.0)
    axes = figure.add_subplot()
    set_value_axis(axes, "x", scale, quantity)
    axes.set(xlim=(scale.low, scale.high), ylim=(0.0, 1.02), ylabel=f"share of all {counted}")
    axes.yaxis.set_major_formatter("{x:.0%}")
    tidy(axes)
    lines = [
        _draw_curve(axes, numbers, scale, look(i), f"{name}: {failed_of(numbers, counted, failed)}")
        for i, (name, numbers) in enumerate(zip(plain_names(runs), runs.values(), strict=True))
    ]
    _label_ends(axes, [_share(numbers) for numbers in runs.values()])
    legend_below(figure, lines)
    return figure


def _share(values: FloatArray) -> float:
    """Share of the runs that did not fail; 0 without any run."""
    return float(np.mean(~failed_runs(values))) if len(values) else 0.0


def _draw_curve(axes: Axes, values: FloatArray, scale: ValueScale, style: Look, label: str) -> Line2D:
    errors = np.sort(placed(values[~failed_runs(values)], scale))
    shares = np.arange(len(errors) + 1) / max(len(values), 1)
    if len(errors) > MAX_STEPS:
        kept = np.linspace(0, len(errors) - 1, MAX_STEPS).astype(int)
        errors, shares = errors[kept], np.append(0.0, shares[1:][kept])
    # The curve comes from 0 and stays at its end, up to both sides of the axes.
    x, y = np.concatenate([[scale.low], errors, [scale.high]]), np.append(shares, shares[-1])
    every = max(len(x) // 8, 1)
    (line,) = axes.plot(
        x, y, color=style.colour, linestyle=style.dash, drawstyle="steps-post", linewidth=1.8, label=label,
        marker=style.marker, markersize=5, markevery=(every, every), clip_on=False,
    )  # fmt: skip
    return line


def _label_ends(axes: Axes, shares: list[float]) -> None:
    """The shares at the right of the axes, each with its curve's marker, moved apart where they would overlap."""
    beside = axes.get_yaxis_transform()
    for i, y in enumerate(_apart(shares)):
        axes.plot(1.025, y, transform=beside, clip_on=False, color=look(i).colour, marker=look(i).marker)
        axes.text(1.045, y, percent(shares[i]), transform=beside, va="center")


def _apart(shares: list[float]) -> FloatArray:
    """Heights of the labels, in the order of the shares, apart from each other and none below 0 or above 1."""
    step = min(LABEL_STEP, 1.0 / max(len(shares) - 1, 1))
    order = np.argsort(shares, kind="stable")
    heights: FloatArray = np.array(shares)
    for below, above in pairwise(order):
        heights[above] = max(heights[above], heights[below] + step)
    highest = 1.0
    for k in order[::-1]:
        heights[k] = min(heights[k], highest)
        highest = heights[k] - step
    return heights
