"""Does an attribute of the sequences explain the errors? Every run is a point, failed ones at the upper edge."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from slamgym.errors import ConfigError
from slamgym.eval.plots.names import plain_names
from slamgym.eval.plots.style import new_figure, tidy
from slamgym.eval.plots.value_scale import (
    ValueScale,
    as_runs,
    draw_failed_band,
    draw_runs,
    failed_of,
    set_value_axis,
    value_scale,
)
from slamgym.types import FloatArray


class RankCorrelation(NamedTuple):
    """Spearman's coefficient over n runs, and its p-value, corrected for all the tests that were made."""

    rho: float
    n: int
    p: float


def plot_scatter(
    attributes: Mapping[str, ArrayLike],
    values: ArrayLike,
    *,
    quantity: str = "ATE RMSE (m)",
    correlations: Mapping[str, RankCorrelation] | None = None,
    log_y: bool = True,
    counted: str = "runs",
    can_fail: bool = True,
) -> Figure:
    """A panel for each attribute (R,), named with its unit, against the metric's values (R,) of the same runs.

    A failed run is NaN or infinite. Runs whose attribute is not finite have no place and are counted in the panel's
    title, which also takes the attribute's correlation where there is one. counted: what the points are, for example
    "paths". can_fail: False for a metric that every run has, such as its completion. Raises ConfigError.
    """
    columns, metric = as_runs(attributes), np.asarray(values, dtype=np.float64)
    for name, column in columns.items():
        if column.shape != metric.shape:
            raise ConfigError(
                f"plot_scatter: expected values of shape {metric.shape} of {name!r}, one a run, got {column.shape}"
            )
    scale = value_scale([metric], log=log_y)
    n_cols = min(len(columns), 3)
    n_rows = -(-len(columns) // n_cols)
    figure = new_figure(max(4.2 * n_cols, 6.0), 3.9 * n_rows + 0.4)
    panels = figure.subplots(n_rows, n_cols, squeeze=False, sharey=True)
    for axes, label, (name, column) in zip(panels.flat, plain_names(columns, 44), columns.items(), strict=False):
        _draw_panel(axes, column, metric, scale, can_fail)
        axes.set_xlabel(label)
        axes.set_title(_title(column, (correlations or {}).get(name)), loc="left", fontsize=9)
    for axes in panels.flat[len(columns) :]:
        axes.set_axis_off()
    for axes in panels[:, 0]:
        set_value_axis(axes, "y", scale, quantity, failed=can_fail)
    heading = failed_of(metric, counted) if can_fail else f"{len(metric)} {counted}"
    figure.suptitle(heading, x=0.01, ha="left", fontsize=11)
    return figure


def _draw_panel(axes: Axes, column: FloatArray, metric: FloatArray, scale: ValueScale, can_fail: bool) -> None:
    known = np.isfinite(column)
    if can_fail:
        draw_failed_band(axes, scale)
    tidy(axes)
    draw_runs(axes, column[known], metric[known], scale)


def _title(column: FloatArray, correlation: RankCorrelation | None) -> str:
    parts = []
    if correlation is not None:
        p = "p < 0.001" if correlation.p < 0.001 else f"p = {correlation.p:.3f}"
        parts.append(f"Spearman {correlation.rho:+.2f}, n = {correlation.n}, corrected {p}")
    if unknown := np.count_nonzero(~np.isfinite(column)):
        parts.append(f"{unknown} without this attribute")
    return "\n".join(parts)
