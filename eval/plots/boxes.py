"""Box plots in which failed runs rank last instead of vanishing."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from slamgym.eval.plots.names import plain, plain_names
from slamgym.eval.plots.style import new_figure, tidy
from slamgym.eval.plots.value_scale import (
    ValueScale,
    as_runs,
    draw_failed_band,
    draw_runs,
    failed_of,
    failed_runs,
    placed,
    set_value_axis,
    value_scale,
)
from slamgym.types import FloatArray


def plot_boxes(values: Mapping[str, ArrayLike], *, quantity: str = "ATE RMSE (m)", by: str = "") -> Figure:
    """A box for each level or system over its values (R,), on a logarithmic axis, and every run as a point.

    A failed run is NaN or infinite. Quartiles and median are those of all runs, failed ones ranking last: a box that
    reaches into the band "failed" says that a quarter of the runs failed, or more. The whiskers go to the extremes.
    by: what the names are, for example "speed (m/s)". Raises ConfigError.
    """
    runs = as_runs(values)
    scale = value_scale(runs.values())
    width_in = float(np.clip(1.0 * len(runs), 6.0, 14.0))
    fits = int(11 * width_in / len(runs)) - 1
    names = plain_names(runs, max(fits, 24))
    upright_letters = max(map(len, names)) if max(map(len, names)) > fits else 0
    figure = new_figure(width_in, 5.0 + 0.06 * upright_letters)
    axes = figure.add_subplot()
    set_value_axis(axes, "y", scale, quantity, failed=True)
    draw_failed_band(axes, scale)
    tidy(axes)
    axes.xaxis.grid(visible=False)
    for i, numbers in enumerate(runs.values()):
        _draw_box(axes, i, numbers, scale)
        _draw_points(axes, i, numbers, scale)
    counts = [f"{name}\nn = {len(n)}\n{_failed(n)}" for name, n in zip(names, runs.values(), strict=True)]
    axes.set_xticks(np.arange(len(runs)), counts, fontsize=9, rotation=90 if upright_letters else 0)
    axes.set(xlim=(-0.6, len(runs) - 0.4), xlabel=plain(by, 60))
    axes.set_title(f"{failed_of(np.concatenate(list(runs.values())))}; boxes rank them last", loc="left")
    return figure


def _failed(values: FloatArray) -> str:
    return f"{np.count_nonzero(failed_runs(values))} failed"


def quartiles(values: FloatArray) -> FloatArray:
    """Smallest, lower quartile, median, upper quartile, largest (5,); failed runs rank last, as infinite.

    Linear between neighbours, and infinite as soon as one of them is.
    """
    ranks = np.linspace(0.0, len(values) - 1.0, 5)
    ordered = np.sort(np.where(failed_runs(values), np.inf, values))
    below, above = ordered[np.floor(ranks).astype(int)], ordered[np.ceil(ranks).astype(int)]
    with np.errstate(invalid="ignore"):
        return np.asarray(np.where(below == above, below, below + (above - below) * (ranks % 1.0)))


def _draw_box(axes: Axes, i: int, values: FloatArray, scale: ValueScale) -> None:
    if not len(values):
        return
    low, q1, median, q3, high = placed(quartiles(values), scale)
    box = {"whislo": low, "q1": q1, "med": median, "q3": q3, "whishi": high}
    line = {"color": "black", "linewidth": 1.2}
    axes.bxp(
        [box], positions=[i], widths=0.55, showfliers=False, patch_artist=True, capprops=line, whiskerprops=line,
        boxprops={"facecolor": "0.88", "edgecolor": "black", "linewidth": 1.2}, medianprops=line | {"linewidth": 2.4},
    )  # fmt: skip


def _draw_points(axes: Axes, i: int, values: FloatArray, scale: ValueScale) -> None:
    # Side by side in the order of the runs, by the golden ratio: even, and the same in every picture.
    x = i + 0.4 * (0.618034 * np.arange(len(values), dtype=np.float64) % 1.0 - 0.5)
    draw_runs(axes, x, values, scale)
