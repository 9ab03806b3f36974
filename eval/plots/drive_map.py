"""A picture of one episode, seen from above."""

from math import isnan
from pathlib import Path
from typing import Protocol

import numpy as np
from matplotlib.axes import Axes

from slamgym.eval.accuracy import align, is_determined
from slamgym.eval.plots.names import percent
from slamgym.eval.plots.style import COLOURS, new_figure
from slamgym.eval.plots.top_view import draw_lost, draw_truth, set_top_view
from slamgym.eval.robustness import estimate_by_frame, find_losses, most_frequent_map
from slamgym.types import BoolArray, FloatArray, SlamRecord, Summary

ESTIMATE, OTHER_MAPS = COLOURS[0], COLOURS[1:]


class TopView(Protocol):
    """What is drawn of an occupancy grid: occupied bool (ny, nx), origin_xy (2,) of its lower left corner, metres."""

    @property
    def occupied(self) -> BoolArray: ...
    @property
    def origin_xy(self) -> FloatArray: ...
    @property
    def resolution_m(self) -> float: ...


def plot_map(
    png: Path,
    grid: TopView,
    path_xy: FloatArray,
    T_world_cam: FloatArray,
    slam: SlamRecord | None,
    summary: Summary,
) -> None:
    """Write a picture of the drive: grid, planned path (P, 2), true poses (N, 4, 4), and what the SLAM made of it.

    Every map of the SLAM is aligned to the truth on its own; the evaluated one is drawn solid, others dashed. The
    title takes `status`, `ate_rmse_m` and `completion` from `summary`. Raises OSError.
    """
    figure = new_figure(*_figure_size(grid))
    axes = figure.add_subplot()
    _draw_grid(axes, grid)
    axes.plot(*path_xy.T, color="0.45", linestyle=":", linewidth=1.5, label="planned path")
    draw_truth(axes, T_world_cam[:, :2, 3])
    if slam is not None:
        _draw_estimate(axes, slam)
        _draw_losses(axes, slam)
    axes.set_title(_title(summary), loc="left")
    figure.legend(loc="outside right upper", frameon=False)
    figure.savefig(png, format="png")


def _figure_size(grid: TopView) -> tuple[float, float]:
    """Width and height, inches, for a plot in the grid's proportions with a legend on its right."""
    ny, nx = grid.occupied.shape
    height = float(np.clip(7.0 * ny / nx, 3.0, 9.0))
    return 9.5, height + 0.8


def _draw_grid(axes: Axes, grid: TopView) -> None:
    ny, nx = grid.occupied.shape
    x_min, y_min = grid.origin_xy
    extent = (x_min, x_min + nx * grid.resolution_m, y_min, y_min + ny * grid.resolution_m)
    axes.imshow(grid.occupied, origin="lower", extent=extent, cmap="Greys", vmin=0.0, vmax=4.0, interpolation="nearest")
    set_top_view(axes)


def _draw_estimate(axes: Axes, slam: SlamRecord) -> None:
    T, maps = estimate_by_frame(slam)
    best = most_frequent_map(maps)
    if best >= 0:
        xy = _aligned_xy(slam.T_world_cam, T, maps == best)
        axes.plot(*xy.T, color=ESTIMATE, linewidth=1.8, label="estimate, evaluated map")
    others = [map_id for map_id in np.unique(maps[maps >= 0]) if map_id != best]
    for i, map_id in enumerate(others):
        label = "estimate, other maps" if i == 0 else None
        xy = _aligned_xy(slam.T_world_cam, T, maps == map_id)
        axes.plot(*xy.T, color=OTHER_MAPS[i % len(OTHER_MAPS)], linestyle="--", linewidth=1.8, label=label)


def _aligned_xy(T_world_cam: FloatArray, T_map_cam: FloatArray, frames: BoolArray) -> FloatArray:
    """Estimated positions (N, 2) in the world; NaN, a gap in the line, outside `frames` or where those are too few."""
    xy = np.full((len(frames), 2), np.nan)
    truth, estimate = T_world_cam[frames], T_map_cam[frames]
    if is_determined(truth, estimate, "se3"):
        xy[frames] = align(truth, estimate).apply(estimate)[:, :2, 3]
    return xy


def _draw_losses(axes: Axes, slam: SlamRecord) -> None:
    xy = slam.T_world_cam[:, :2, 3]
    for i, loss in enumerate(find_losses(slam)):
        cross = draw_lost(axes, xy, loss.start_frame, loss.end_frame + 1)
        if i > 0:
            cross.set_label(None)


def _title(summary: Summary) -> str:
    if "status" not in summary:
        return "no SLAM"
    ate = "no ATE" if isnan(summary["ate_rmse_m"]) else f"ATE {summary['ate_rmse_m']:.3f} m"
    return f"{summary['status']}, {ate}, completion {percent(summary['completion'])}"
