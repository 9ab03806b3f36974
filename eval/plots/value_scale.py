"""The axis of a metric on which failed runs have a place of their own, above the largest value."""

from collections.abc import Iterable, Mapping
from typing import Literal, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import Locator, LogLocator, MaxNLocator, NullFormatter
from numpy.typing import ArrayLike

from slamgym.errors import ConfigError
from slamgym.eval.plots.names import plain
from slamgym.eval.plots.style import COLOURS, LOST
from slamgym.types import BoolArray, FloatArray

# Where all values are alike the axis still shows this many decades, so that noise does not look like a difference.
MIN_DECADES = 0.6
# More points than this are an image inside of an svg, which would be too large for a browser.
MAX_VECTOR_POINTS = 2000


class ValueScale(NamedTuple):
    """Range of an axis: values lie in low..high, failed runs at `failed` in the band from `high` to `top`."""

    log: bool
    low: float
    high: float
    failed: float
    top: float


def as_runs(values: Mapping[str, ArrayLike]) -> dict[str, FloatArray]:
    """The values of each system or level as float arrays (R,). Raises ConfigError without any or with other shapes."""
    runs = {name: np.asarray(numbers, dtype=np.float64) for name, numbers in values.items()}
    if not runs:
        raise ConfigError("plot: expected values of at least one system or level, got none; give {name: values}")
    for name, numbers in runs.items():
        if numbers.ndim != 1:
            raise ConfigError(f"plot: expected one value a run for {name!r}, shape (R,), got shape {numbers.shape}")
    return runs


def failed_runs(values: FloatArray) -> BoolArray:
    """Which runs failed: those whose value is NaN or infinite."""
    return ~np.isfinite(values)


def failed_of(values: FloatArray, counted: str = "runs", failed: str = "failed") -> str:
    """How many failed, in words, of the runs or what else is counted; failed: the word for it."""
    return f"{np.count_nonzero(failed_runs(values))} of {len(values)} {counted} {failed}"


def value_scale(values: Iterable[ArrayLike], *, log: bool = True) -> ValueScale:
    """The range that holds all finite values (with `log` all positive ones) and, above them, a band for failures."""
    numbers = np.concatenate([np.ravel(np.asarray(part, dtype=np.float64)) for part in values])
    shown = numbers[np.isfinite(numbers) & ((numbers > 0.0) | (not log))]
    ends = np.array([shown.min(), shown.max()]) if len(shown) else np.array([0.01, 1.0])
    low, high = np.log10(ends) if log else ends
    least = MIN_DECADES if log else max(0.1 * abs(high), 1e-9)
    missing = max(least - (high - low), 0.0)
    low, high = low - missing / 2, high + missing / 2
    marks = low + (high - low) * np.array([-0.06, 1.05, 1.11, 1.17])
    return ValueScale(log, *map(float, 10.0**marks if log else marks))


def placed(values: FloatArray, scale: ValueScale) -> FloatArray:
    """Where each run is drawn: failed ones in their band, and 0 on a logarithmic axis at its lower end."""
    return np.where(failed_runs(values), scale.failed, np.maximum(values, scale.low))


def set_value_axis(
    axes: Axes,
    which: Literal["x", "y"],
    scale: ValueScale,
    quantity: str,
    *,
    failed: bool = False,
    word: str = "failed",
) -> None:
    """Ticks as plain numbers, and with `failed` the word for failed runs where they are; `quantity` names the metric
    and its unit.
    """
    if scale.log:
        axes.set(**{f"{which}scale": "log"})
    axis = axes.xaxis if which == "x" else axes.yaxis
    ticks = _ticks(scale)
    labels = [f"{tick:.10g}" for tick in ticks]
    axis.set_ticks([*ticks, scale.failed] if failed else ticks, labels=[*labels, word] if failed else labels)
    axis.set_ticks(_minor_ticks(scale), minor=True)
    axis.set_minor_formatter(NullFormatter())
    axis.set_label_text(plain(quantity, 60))


def draw_failed_band(axes: Axes, scale: ValueScale) -> None:
    """Shade the place of the failed runs at the upper end of the y axis."""
    axes.axhspan(scale.high, scale.top, facecolor="0.92", zorder=0)
    axes.set_ylim(scale.low, scale.top)


def draw_runs(axes: Axes, x: FloatArray, values: FloatArray, scale: ValueScale) -> None:
    """Runs as points at x (R,), failed ones as crosses in their band."""
    y, failed = placed(values, scale), failed_runs(values)
    as_image = len(values) > MAX_VECTOR_POINTS
    axes.plot(
        x[~failed], y[~failed], linestyle="none", marker="o", markersize=4.5, color=COLOURS[0], markeredgecolor="white",
        markeredgewidth=0.5, zorder=3, rasterized=as_image,
    )  # fmt: skip
    axes.plot(
        x[failed], y[failed], linestyle="none", marker="x", markersize=6, color=LOST, mew=1.5, zorder=3,
        rasterized=as_image,
    )  # fmt: skip


def _ticks(scale: ValueScale) -> list[float]:
    few_decades = scale.high < 300 * scale.low
    subs = (1.0, 2.0, 5.0) if few_decades else (1.0,)
    return _within(scale, LogLocator(subs=subs, numticks=12) if scale.log else MaxNLocator(6))


def _minor_ticks(scale: ValueScale) -> list[float]:
    return _within(scale, LogLocator(subs=list(range(2, 10)), numticks=12)) if scale.log else []


def _within(scale: ValueScale, locator: Locator) -> list[float]:
    """No ticks outside low..high: the band above holds no values."""
    return [float(tick) for tick in locator.tick_values(scale.low, scale.high) if scale.low <= tick <= scale.high]
