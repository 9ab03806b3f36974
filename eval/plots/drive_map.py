"""A picture of one episode, seen from above."""

from math import isnan
from pathlib import Path
from typing import Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from slamgym.eval.accuracy import align_rigid
from slamgym.eval.robustness import estimate_by_frame, find_losses, most_frequent_map
from slamgym.types import BoolArray, FloatArray, SlamRecord, Summary

# Okabe and Ito's colours, which colour-blind people can tell apart.
TRUTH, ESTIMATE, LOST = "#000000", "#0072B2", "#D55E00"
OTHER_MAPS = ("#009E73", "#CC79A7", "#E69F00", "#56B4E9")


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
    figure = Figure(figsize=_figure_size(grid), dpi=120, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    _draw_grid(axes, grid)
    axes.plot(*path_xy.T, color="0.45", linestyle=":", linewidth=1.5, label="planned path")
    true_xy = T_world_cam[:, :2, 3]
    axes.plot(*true_xy.T, color=TRUTH, linewidth=2.0, label="true path")
    if slam is not None:
        _draw_estimate(axes, slam)
        _draw_losses(axes, slam)
    _draw_ends(axes, true_xy)
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
    axes.set_aspect("equal")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")


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
    if np.count_nonzero(frames) >= 3:
        estimate = T_map_cam[frames, :3, 3]
        T_world_map = align_rigid(estimate, T_world_cam[frames, :3, 3])
        xy[frames] = (estimate @ T_world_map[:3, :3].T + T_world_map[:3, 3])[:, :2]
    return xy


def _draw_losses(axes: Axes, slam: SlamRecord) -> None:
    xy = slam.T_world_cam[:, :2, 3]
    for i, loss in enumerate(find_losses(slam)):
        lost = xy[loss.start_frame : loss.end_frame + 2]
        # A broad band below the true path, and its start above all: a loss may be shorter than the line is wide.
        axes.plot(*lost.T, color=LOST, linewidth=7.0, solid_capstyle="butt", zorder=1.5)
        label = "lost, from the cross on" if i == 0 else None
        axes.plot(*lost[0], color=LOST, marker="X", markersize=9, markeredgecolor="white", zorder=4, label=label)


def _draw_ends(axes: Axes, true_xy: FloatArray) -> None:
    for label, marker, xy in (("start", "o", true_xy[0]), ("end", "s", true_xy[-1])):
        axes.plot(*xy, marker=marker, label=label, markersize=12, color=TRUTH, markerfacecolor="none", linestyle="none")


def _title(summary: Summary) -> str:
    if "status" not in summary:
        return "no SLAM"
    ate = "no ATE" if isnan(summary["ate_rmse_m"]) else f"ATE {summary['ate_rmse_m']:.3f} m"
    return f"{summary['status']}, {ate}, completion {summary['completion']:.0%}"
