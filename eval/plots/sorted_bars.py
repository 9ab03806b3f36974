"""Every run as one bar, sorted: the good ones, the bad ones, the failed ones, and the gap between them."""

from collections.abc import Mapping, Sequence

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


def plot_sorted_bars(
    values: Mapping[str, ArrayLike],
    *,
    quantity: str = "ATE RMSE (m)",
    names: Sequence[str] = (),
    threshold: float = np.nan,
    gap: tuple[float, float] = (np.nan, np.nan),
    failed_when: str = "",
) -> Figure:
    """A panel for each system: its values (R,), sorted, on a logarithmic axis that all panels share.

    A failed run is NaN or infinite: a hatched bar at the right, up to the top, and counted in the panel's title.
    names: what the R runs are, the same for all systems. threshold: separates good runs from failed ones, in the
    values' unit; gap: the values below and above it, between which the panel is shaded; NaN for none. failed_when: what
    failed means, said above the panels. Raises ConfigError.
    """
    runs = as_runs(values)
    _check_names(runs, names)
    scale = value_scale([*runs.values(), [threshold, *gap]])
    labels = plain_names(names, 24) if len(names) <= MAX_NAMES else []
    figure = _figure(runs, labels)
    all_axes = figure.subplots(len(runs), sharey=True, squeeze=False)[:, 0]
    handles: list[Artist] = []
    for i, (axes, title, numbers) in enumerate(zip(all_axes, plain_names(runs), runs.values(), strict=True)):
        set_value_axis(axes, "y", scale, quantity, failed=True)
        handles = _draw_threshold(axes, threshold, gap)
        _draw_bars(axes, numbers, scale, look(i).colour)
        _label_bars(axes, numbers, labels)
        axes.set_title(f"{title}: {failed_of(numbers)}", loc="left")
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
    good = len(values) - np.count_nonzero(failed_runs(values))
    axes.bar(np.arange(good), heights[:good] - scale.low, bottom=scale.low, color=colour, width=0.8)
    failed = np.arange(good, len(values))
    axes.bar(
        failed, scale.top - scale.low, bottom=scale.low, width=0.8, facecolor="white", edgecolor=LOST, hatch="/////"
    )
    axes.set_ylim(scale.low, scale.top)
    axes.set_xlim(-0.8, max(len(values), 1) - 0.2)
    tidy(axes, grid=False)


def _label_bars(axes: Axes, values: FloatArray, labels: Sequence[str]) -> None:
    if labels:
        order = np.argsort(np.where(failed_runs(values), np.inf, values), kind="stable")
        axes.set_xticks(np.arange(len(labels)), [labels[k] for k in order], rotation=90, fontsize=7)
    else:
        axes.set_xticks([])
        axes.set_xlabel(f"{len(values)} runs, sorted")
