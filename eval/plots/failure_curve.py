"""How often runs fail as a factor grows, and where half of them do."""

from typing import Protocol

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from slamgym.errors import ConfigError
from slamgym.eval.plots.names import percent, plain
from slamgym.eval.plots.style import COLOURS, LOST, legend_below, new_figure, tidy
from slamgym.types import FloatArray, IntArray

# The counts of more levels than this stand upright above the axes.
MAX_LEVEL_COUNTS = 12
# Up to so many levels each has its tick, where they lie at least this share of their range apart.
MAX_LEVEL_TICKS, LEAST_TICK_STEP = 8, 0.05


class Midpoint(Protocol):
    """Where half of the runs fail, in the factor's unit, with the ends of its interval; NaN or infinite if unknown.

    `slamgym.eval.statistics.Interval` is one.
    """

    @property
    def estimate(self) -> float: ...
    @property
    def low(self) -> float: ...
    @property
    def high(self) -> float: ...
    @property
    def confidence(self) -> float: ...
    @property
    def range_text(self) -> str: ...


class Curve(Protocol):
    """What is drawn of a fitted curve of failures."""

    @property
    def midpoint(self) -> Midpoint: ...
    def probability(self, x: FloatArray, /) -> FloatArray: ...


def plot_failure_curve(
    levels: ArrayLike,
    failed: ArrayLike,
    runs: ArrayLike,
    curve: Curve | None = None,
    *,
    factor: str = "speed (m/s)",
    title: str = "",
) -> Figure:
    """Observed shares of failures with their 95 % Wilson intervals, the fitted curve, and its 50 % point.

    levels: values of the factor (L,). failed, runs: how many runs failed and how many there were at each level (L,).
    Raises ConfigError.
    """
    x, k, n = _checked(levels, failed, runs)
    figure = new_figure(7.5, 5.0)
    axes = figure.add_subplot()
    axes.set(xlim=_limits(x), ylim=(-0.02, 1.02), xlabel=plain(factor, 60), ylabel="share of failed runs")
    axes.yaxis.set_major_formatter("{x:.0%}")
    set_level_ticks(axes, x)
    tidy(axes)
    handles = [] if curve is None else _draw_curve(axes, curve)
    if len(x):
        handles.insert(0, _draw_observed(axes, x, k, n))
    heading = f"{plain(title)}: " if title else ""
    axes.set_title(
        f"{heading}{k.sum()} of {n.sum()} runs failed", loc="left", pad=20 if len(x) <= MAX_LEVEL_COUNTS else 34
    )
    legend_below(figure, handles)
    return figure


def _checked(levels: ArrayLike, failed: ArrayLike, runs: ArrayLike) -> tuple[FloatArray, IntArray, IntArray]:
    x, k, n = np.asarray(levels, dtype=np.float64), np.asarray(failed, dtype=np.int64), np.asarray(runs, dtype=np.int64)
    if x.ndim != 1 or not x.shape == k.shape == n.shape:
        raise ConfigError(
            f"plot_failure_curve: expected levels, failed and runs of one length, got {x.shape}, {k.shape}, {n.shape}"
        )
    if not (np.isfinite(x).all() and (k >= 0).all() and (k <= n).all()):
        raise ConfigError("plot_failure_curve: expected finite levels with 0 <= failed <= runs each; check the counts")
    return x[n > 0], k[n > 0], n[n > 0]


def set_level_ticks(axes: Axes, x: FloatArray) -> None:
    """Ticks at the levels (L,), of which some may be equal, where few are wide apart: a stride of 0.5 is none."""
    levels = np.unique(x)
    if 0 < len(levels) <= MAX_LEVEL_TICKS and np.all(np.diff(levels) >= LEAST_TICK_STEP * np.ptp(levels)):
        axes.set_xticks(levels, [f"{level:.10g}" for level in levels])


def _limits(x: FloatArray) -> tuple[float, float]:
    if not len(x):
        return 0.0, 1.0
    margin = 0.08 * np.ptp(x) or 0.5 * abs(float(x[0])) or 1.0
    return float(x.min() - margin), float(x.max() + margin)


def _draw_observed(axes: Axes, x: FloatArray, failed: IntArray, runs: IntArray) -> Artist:
    # Imported here: it brings statsmodels, which takes a second, and the other pictures do without.
    from slamgym.eval.statistics import proportion_interval

    intervals = [proportion_interval(int(k), int(n)) for k, n in zip(failed, runs, strict=True)]
    share = failed / runs
    below, above = share - [i.low for i in intervals], [i.high for i in intervals] - share
    bars = axes.errorbar(
        x, share, np.abs([below, above]), fmt="o", color="black", capsize=4, linewidth=1.3, zorder=4, clip_on=False
    )
    bars.set_label("observed, 95 % interval")
    for level, k, n in zip(x, failed, runs, strict=True):
        axes.annotate(
            f"{k}/{n}", (level, 1.0), (0, 6), xycoords=("data", "axes fraction"), textcoords="offset points",
            ha="center", va="bottom", fontsize=8, rotation=0 if len(x) <= MAX_LEVEL_COUNTS else 90,
        )  # fmt: skip
    return bars  # type: ignore[return-value]  # a container of artists, which a legend takes as one


def _draw_curve(axes: Axes, curve: Curve) -> list[Artist]:
    x = np.linspace(*axes.get_xlim(), 300)
    handles: list[Artist] = [*axes.plot(x, curve.probability(x), color=COLOURS[0], linewidth=1.8, label="fitted curve")]
    middle = curve.midpoint
    if np.isfinite(middle.estimate):
        label = f"half fail at {middle.estimate:.3g}"
        handles.append(axes.axvline(middle.estimate, color=LOST, linestyle="--", linewidth=1.5, label=label))
    if not np.isnan([middle.low, middle.high]).any():
        label = f"half fail, {percent(middle.confidence)} interval {middle.range_text}"
        ends = np.clip([middle.low, middle.high], x[0], x[-1])
        handles.append(axes.axvspan(*ends, facecolor=LOST, alpha=0.15, zorder=0, label=label))
    return handles
