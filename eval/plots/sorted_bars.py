"""Every run as one bar, sorted: the good ones, the bad ones, the failed ones, and the gap between them."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from slamgym.errors import ConfigError
from slamgym.eval.plots.names import plain_names
from slamgym.eval.plots.style import LOST, legend_below, look, new_figure, tidy
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

# More names than this side by side cannot be read, and are left out.
MAX_NAMES = 60
MAX_BARS = 400


def plot_sorted_bars(
    values: Mapping[str, ArrayLike],
    *,
    quantity: str = "ATE RMSE (m)",
    names: Sequence[str] = (),
    threshold: float = np.nan,
    gap: tuple[float, float] = (np.nan, np.nan),
    failed_when: str = "",
    counted: str = "runs",
    failed: str = "failed",
) -> Figure:
    """A panel for each system: its values (R,), sorted, on a logarithmic axis that all panels share.

    A failed run is NaN or infinite: a hatched bar at the right, up to the top, and counted in the panel's title.
    names: what the R runs are, the same for all systems. threshold: separates good runs from failed ones, in the
    values' unit; gap: the values below and above it, between which the panel is shaded; NaN for none. failed_when: what
    failed means, said above the panels. counted: what the values are of, for example "paths"; failed: the
    word for those that failed, in the titles and beside their bars. Raises ConfigError.
    """
    runs = as_runs(values)
    _check_names(runs, names)
    scale = value_scale([*runs.values(), [threshold, *gap]])
    labels = plain_names(names, 24) if len(names) <= MAX_NAMES else []
    figure = _figure(runs, labels)
    all_axes = figure.subplots(len(runs), sharey=True, squeeze=False)[:, 0]
    handles: list[Artist] = []
    for i, (axes, title, numbers) in enumerate(zip(all_axes, plain_names(runs), runs.values(), strict=True)):
        set_value_axis(axes, "y", scale, quantity, failed=True, word=failed)
        handles = _draw_threshold(axes, threshold, gap)
        _draw_bars(axes, numbers, scale, look(i).colour)
        _label_bars(axes, numbers, labels, counted)
        axes.set_title(f"{title}: {failed_of(numbers, counted, failed)}", loc="left")
    if failed_when:
        figure.suptitle(f"failed: {failed_when}", x=0.01, ha="left", fontsize=9)
    legend_below(figure, handles)
    return figure


def _check_names(runs: Mapping[str, FloatArray], names: Sequence[str]) -> None:
    for system, numbers in runs.items():
        if names and len(numbers) != len(names):
            raise ConfigError(
                f"plot_sorted_bars: expected {len(names)} values of {system!r}, one for each name, got {len(numbers)}"
            )


def _figure(runs: Mapping[str, FloatArray], labels: Sequence[str]) -> Figure:
    bars = max(map(len, runs.values()))
    panel_in = 2.4 + 0.07 * max(map(len, labels), default=0)
    return new_figure(float(np.clip(0.2 * bars, 6.0, 11.0)), 0.5 + panel_in * len(runs))


def _draw_threshold(axes: Axes, threshold: float, gap: tuple[float, float]) -> list[Artist]:
    handles: list[Artist] = []
    if np.isfinite(threshold):
        label = f"failure threshold {threshold:.3g}"
        handles.append(axes.axhline(threshold, color="black", linestyle="--", linewidth=1.2, zorder=3, label=label))
    if np.isfinite(gap).all():
        label = f"gap from {gap[0]:.3g} to {gap[1]:.3g}"
        handles.append(axes.axhspan(*gap, facecolor="0.85", zorder=0, label=label))
    return handles


def _draw_bars(axes: Axes, values: FloatArray, scale: ValueScale, colour: str) -> None:
    heights = np.sort(placed(values, scale))
    good = len(values) - int(np.count_nonzero(failed_runs(values)))
    draw = _draw_each if len(values) <= MAX_BARS else _draw_outline
    draw(axes, 0, heights[:good], scale, {"color": colour})
    at_top = np.full(len(values) - good, scale.top)
    draw(axes, good, at_top, scale, {"facecolor": "white", "edgecolor": LOST, "hatch": "/////"})
    axes.set_ylim(scale.low, scale.top)
    axes.set_xlim(-0.8, max(len(values), 1) - 0.2)
    tidy(axes, grid=False)


def _draw_each(axes: Axes, first: int, heights: FloatArray, scale: ValueScale, style: Mapping[str, Any]) -> None:
    axes.bar(first + np.arange(len(heights)), heights - scale.low, bottom=scale.low, width=0.8, **style)


def _draw_outline(axes: Axes, first: int, heights: FloatArray, scale: ValueScale, style: Mapping[str, Any]) -> None:
    """One area in place of bars that are narrower than a pixel, of as many heights as can be seen."""
    if len(heights):
        shown = np.linspace(0, len(heights) - 1, min(len(heights), MAX_BARS)).astype(int)
        axes.fill_between(first + shown, scale.low, heights[shown], **style)


def _label_bars(axes: Axes, values: FloatArray, labels: Sequence[str], counted: str) -> None:
    if labels:
        order = np.argsort(np.where(failed_runs(values), np.inf, values), kind="stable")
        axes.set_xticks(np.arange(len(labels)), [labels[k] for k in order], rotation=90, fontsize=7)
    else:
        axes.set_xticks([])
        axes.set_xlabel(f"{len(values)} {counted}, sorted")
