"""Two systems on the same paths: a point for each, and how far apart they are, sorted."""

from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter
from numpy.typing import ArrayLike

from slamgym.errors import ConfigError
from slamgym.eval.plots.names import plain
from slamgym.eval.plots.style import COLOURS, LOST, new_figure, tidy
from slamgym.eval.plots.value_scale import ValueScale, failed_runs, placed, set_value_axis, value_scale
from slamgym.types import BoolArray, FloatArray


def plot_paired(
    baseline: ArrayLike, new: ArrayLike, *, quantity: str = "ATE RMSE (m)", names: tuple[str, str] = ("baseline", "new")
) -> Figure:
    """A point for each pair: `baseline` (P,) to the right, `new` (P,) upwards, both on one scale; lower is better.

    Above the diagonal `new` is worse. A failure is NaN or infinite, and has a band at the end of either axis.
    names: of the two systems. Raises ConfigError.
    """
    x, y = (np.asarray(values, dtype=np.float64) for values in (baseline, new))
    if x.ndim != 1 or x.shape != y.shape:
        raise ConfigError(f"plot_paired: expected two arrays (P,), a value a pair, got shapes {x.shape} and {y.shape}")
    scale = value_scale([x, y])
    figure = new_figure(5.6, 5.6)
    axes = figure.add_subplot()
    for which, name in (("x", names[0]), ("y", names[1])):
        set_value_axis(axes, which, scale, f"{quantity}, {name}", failed=True)  # type: ignore[arg-type]
    _draw_ground(axes, scale)
    _draw_pairs(axes, x, y, scale)
    axes.set_title(_counts(x, y), loc="left", fontsize=10)
    return figure


def plot_differences(
    values: ArrayLike, *, quantity: str, worse: Literal["above", "below"], ratio: bool = False
) -> Figure:
    """Bars of the differences (P,), sorted, from zero on, those for the worse in another colour and hatched.

    ratio: the values are ratios, drawn from 1 on, on a logarithmic axis, and must be above 0. worse: where worse values
    lie. Values that are not finite are left out. Raises ConfigError.
    """
    numbers = np.asarray(values, dtype=np.float64)
    if numbers.ndim != 1:
        raise ConfigError(f"plot_differences: expected differences (P,), got shape {numbers.shape}")
    shown = np.sort(numbers[np.isfinite(numbers)])
    start = 1.0 if ratio else 0.0
    is_worse = shown > start if worse == "above" else shown < start
    figure = new_figure(float(np.clip(0.2 * len(shown), 6.0, 11.0)), 3.4)
    axes = figure.add_subplot()
    if ratio:
        _set_ratio_axis(axes, shown)
    _draw_bars(axes, shown, start, is_worse)
    axes.set_ylabel(plain(quantity, 60))
    same = np.count_nonzero(shown == start)
    counts = (
        f"{np.count_nonzero(is_worse)} worse, {len(shown) - np.count_nonzero(is_worse) - same} better, {same} equal"
    )
    axes.set_title(counts, loc="left", fontsize=10)
    return figure


def _draw_ground(axes: Axes, scale: ValueScale) -> None:
    axes.axhspan(scale.high, scale.top, facecolor="0.92", zorder=0)
    axes.axvspan(scale.high, scale.top, facecolor="0.92", zorder=0)
    axes.plot([scale.low, scale.high], [scale.low, scale.high], color="0.4", linewidth=1.0, zorder=1)
    axes.set(xlim=(scale.low, scale.top), ylim=(scale.low, scale.top), aspect="equal")
    tidy(axes)
    for at, align, text in (((0.02, 0.84), "left", "worse"), ((0.88, 0.02), "right", "better")):
        axes.text(*at, text, transform=axes.transAxes, ha=align, va="bottom", color="0.35", fontsize=9)


def _draw_pairs(axes: Axes, x: FloatArray, y: FloatArray, scale: ValueScale) -> None:
    failed = failed_runs(x) | failed_runs(y)
    at_x, at_y = placed(x, scale), placed(y, scale)
    axes.plot(
        at_x[~failed], at_y[~failed], linestyle="none", marker="o", markersize=5, color=COLOURS[0], alpha=0.75,
        markeredgecolor="white", markeredgewidth=0.5, zorder=3,
    )  # fmt: skip
    axes.plot(at_x[failed], at_y[failed], linestyle="none", marker="x", markersize=6, color=LOST, mew=1.5, zorder=3)


def _counts(x: FloatArray, y: FloatArray) -> str:
    x, y = (np.where(failed_runs(values), np.inf, values) for values in (x, y))
    worse, better = np.count_nonzero(y > x), np.count_nonzero(y < x)
    both = np.count_nonzero(np.isinf(x) & np.isinf(y))
    failed = f"; failed in both: {both}" if both else ""
    return f"{len(x)} pairs: {better} better, {worse} worse, {len(x) - better - worse} equal{failed}"


def _set_ratio_axis(axes: Axes, shown: FloatArray) -> None:
    """At least from half to twice, so that noise does not look like a difference."""
    axes.set_yscale("log", base=2)
    reach = max(2.0, 1.1 * float(np.max(np.maximum(shown, 1 / shown), initial=1.0)))
    axes.set_ylim(1 / reach, reach)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.3g}"))


def _draw_bars(axes: Axes, shown: FloatArray, start: float, is_worse: BoolArray) -> None:
    at = np.arange(len(shown))
    axes.bar(at[~is_worse], shown[~is_worse] - start, bottom=start, color=COLOURS[0], width=0.8)
    axes.bar(
        at[is_worse], shown[is_worse] - start, bottom=start, width=0.8, facecolor="white", edgecolor=LOST, hatch="/////"
    )
    axes.axhline(start, color="black", linewidth=0.8)
    axes.set_xticks([])
    axes.set_xlabel(f"{len(shown)} paths, sorted")
    axes.set_xlim(-0.8, max(len(shown), 1) - 0.2)
    tidy(axes)
