"""How often runs fail at each pair of levels of two factors."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from slamgym.errors import ConfigError
from slamgym.eval.plots.names import plain, plain_names
from slamgym.eval.plots.style import new_figure
from slamgym.types import FloatArray, IntArray

# Counts in more cells than this cannot be read.
MAX_COUNTED_CELLS = 240
MAX_TICKS = 24


def plot_heat_map(
    failed: ArrayLike,
    runs: ArrayLike,
    x_levels: Sequence[str],
    y_levels: Sequence[str],
    *,
    x_factor: str = "speed (m/s)",
    y_factor: str = "stride",
) -> Figure:
    """A cell for each pair of levels, the darker the more of its runs failed, with "failed/runs" in it.

    failed, runs: how many runs failed and how many there were (Y, X), the first row at the bottom. A cell without a run
    stays white, with a dash. Raises ConfigError.
    """
    k, n = _checked(failed, runs, (len(y_levels), len(x_levels)))
    figure = new_figure(float(np.clip(3.0 + 0.75 * len(x_levels), 6, 12)), float(np.clip(2.0 + 0.5 * k.shape[0], 3, 9)))
    axes = figure.add_subplot()
    share = np.divide(k, n, out=np.full(k.shape, np.nan), where=n > 0)
    axes.set_facecolor("white")
    # Its lightness falls evenly: what is darker in colour is darker in grey.
    cells = axes.pcolormesh(share, cmap="cividis_r", vmin=0.0, vmax=1.0, edgecolors="white", linewidth=1.0)
    bar = figure.colorbar(cells, ax=axes, format="{x:.0%}")
    bar.set_label("share of failed runs")
    if k.size <= MAX_COUNTED_CELLS:
        _write_counts(axes, k, n, share)
    _name_levels(axes, x_levels, y_levels)
    axes.set(xlabel=plain(x_factor, 60), ylabel=plain(y_factor, 40))
    axes.set_title(f"{k.sum()} of {n.sum()} runs failed", loc="left")
    return figure


def _checked(failed: ArrayLike, runs: ArrayLike, shape: tuple[int, int]) -> tuple[IntArray, IntArray]:
    k, n = np.asarray(failed, dtype=np.int64), np.asarray(runs, dtype=np.int64)
    if not k.shape == n.shape == shape or not k.size:
        raise ConfigError(f"plot_heat_map: expected counts of shape {shape}, got {k.shape} failed and {n.shape} runs")
    if not ((k >= 0) & (k <= n)).all():
        raise ConfigError("plot_heat_map: expected 0 <= failed <= runs in each cell; check the counts")
    return k, n


def _write_counts(axes: Axes, failed: IntArray, runs: IntArray, share: FloatArray) -> None:
    size = 9 if runs.shape[1] <= 12 else 7
    for (y, x), n in np.ndenumerate(runs):
        text = f"{failed[y, x]}/{n}" if n else "-"
        colour = "white" if share[y, x] > 0.5 else "black"
        axes.text(x + 0.5, y + 0.5, text, ha="center", va="center", color=colour, fontsize=size)


def _name_levels(axes: Axes, x_levels: Sequence[str], y_levels: Sequence[str]) -> None:
    for axis, levels in ((axes.xaxis, x_levels), (axes.yaxis, y_levels)):
        every = -(-len(levels) // MAX_TICKS)
        shown = range(0, len(levels), every)
        axis.set_ticks([i + 0.5 for i in shown], plain_names([levels[i] for i in shown], 18))
        axis.set_tick_params(length=0)
    if max(map(len, x_levels)) > 8:
        axes.tick_params(axis="x", rotation=90)
    axes.spines[:].set_visible(False)
