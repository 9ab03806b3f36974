"""The same paths at different levels of a factor: a line for each path."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from slamgym.errors import ConfigError
from slamgym.eval.plots.names import plain, plain_names
from slamgym.eval.plots.style import LOST, legend_below, new_figure, tidy
from slamgym.eval.plots.value_scale import (
    ValueScale,
    draw_failed_band,
    failed_runs,
    placed,
    set_value_axis,
    value_scale,
)
from slamgym.types import FloatArray

# More lines than this run into each other.
MAX_LINES = 150


def plot_level_pairs(
    values: ArrayLike, levels: Sequence[str], *, quantity: str = "ATE RMSE (m)", by: str = "", paths: str = "paths"
) -> Figure:
    """Lines of P paths over L levels, values (P, L), on a logarithmic axis, and their median, failed ones ranking last.

    A failure is NaN or infinite, and lies in the band "failed"; a line from or to a success is dashed there, and of
    another colour.
    Of more than MAX_LINES paths every so many are drawn, and the median is that of all. paths: what the rows are.
    Raises ConfigError.
    """
    numbers = np.asarray(values, dtype=np.float64)
    if numbers.ndim != 2 or not numbers.size or numbers.shape[1] != len(levels):
        raise ConfigError(f"plot_level_pairs: expected values (paths, {len(levels)} levels), got {numbers.shape}")
    drawn = numbers[np.unique(np.linspace(0, len(numbers) - 1, MAX_LINES).astype(int))]
    scale = value_scale([numbers])
    figure = new_figure(float(np.clip(1.6 * len(levels), 5.5, 11)), 5.0)
    axes = figure.add_subplot()
    set_value_axis(axes, "y", scale, quantity, failed=True)
    draw_failed_band(axes, scale)
    tidy(axes)
    _draw_paths(axes, drawn, scale)
    median = np.median(np.where(failed_runs(numbers), np.inf, numbers), axis=0)
    (line,) = axes.plot(
        placed(median, scale), color="black", linewidth=2.4, marker="s", markersize=7, zorder=5,
        label=f"median, failed ones last ({len(numbers)} {paths})",
    )  # fmt: skip
    failed = np.count_nonzero(failed_runs(numbers), axis=0)
    names = [f"{name}\n{k} failed" for name, k in zip(plain_names(levels, 20), failed, strict=True)]
    axes.set_xticks(np.arange(len(levels)), names)
    axes.set(xlim=(-0.3, len(levels) - 0.7), xlabel=plain(by, 60))
    legend_below(figure, [line])
    return figure


def _draw_paths(axes: Axes, values: FloatArray, scale: ValueScale) -> None:
    # Failures of several paths at one level are spread a little, so that their lines can be told apart.
    y = placed(values, scale)
    failed = failed_runs(values)
    spread = np.linspace(0.25, 0.75, len(values))[:, None]
    in_band = scale.high * (scale.top / scale.high) ** np.broadcast_to(spread, y.shape)
    y = np.where(failed, in_band, y)
    steps = np.stack([np.broadcast_to(np.arange(y.shape[1]), y.shape), y], axis=2)
    segments = np.stack([steps[:, :-1], steps[:, 1:]], axis=2).reshape(-1, 2, 2)
    failures = (failed[:, :-1].astype(int) + failed[:, 1:]).ravel()
    looks = (("0.55", "solid", 0.7), (LOST, "dashed", 0.7), ("0.55", "solid", 0.2))
    for at_ends, (colour, dash, alpha) in enumerate(looks):
        chosen = list(segments[failures == at_ends])
        lines = LineCollection(chosen, colors=colour, linestyles=dash, linewidths=0.9, alpha=alpha)
        axes.add_collection(lines, autolim=False)
    axes.plot(steps[..., 0].ravel(), steps[..., 1].ravel(), linestyle="none", marker="o", markersize=3.5, color="0.35")
