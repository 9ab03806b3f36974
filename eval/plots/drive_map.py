"""A picture of one run, a drive or a recorded sequence, seen from above."""

from math import isnan
from pathlib import Path
from typing import NamedTuple, Protocol

import numpy as np
from matplotlib.axes import Axes

from slamgym.eval.accuracy import align, is_determined
from slamgym.eval.plots.names import percent
from slamgym.eval.plots.style import COLOURS, new_figure, tidy
from slamgym.eval.plots.top_view import (
    Upwards,
    draw_lost,
    draw_truth,
    extent,
    from_above,
    set_top_view,
    upward_axis,
    with_holes,
)
from slamgym.eval.robustness import estimate_by_frame, evaluated_frames, find_losses, true_poses
from slamgym.eval.trajectories import Trajectory, find_holes
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


class _Path(NamedTuple):
    """Positions (N, 3) at the fed frames, metres, NaN where there is none."""

    positions: FloatArray
    label: str
    evaluated: bool = True


def plot_map(
    png: Path,
    grid: TopView | None,
    path_xy: FloatArray | None,
    truth: Trajectory | None,
    slam: SlamRecord | None,
    summary: Summary,
) -> None:
    """Write a picture of a run: grid and planned path (P, 2) of a drive, which a recorded sequence has not, the true
    path while the SLAM was fed, with gaps where it is not known, and what the SLAM made of it.

    Every map of the SLAM is aligned to the truth on its own; those that `map_policy` in `summary` evaluates are drawn
    solid, others dashed. Without a truth the first of them is drawn in its own frame, x and z, since that is the first
    camera's as a rule. With a grid the plane is that of x and y, else see `upward_axis`. The title takes `status`,
    `ate_rmse_m` and `completion` from `summary`. Raises OSError.
    """
    paths = [] if slam is None else _estimates(slam, summary["map_policy"])
    true_path = _true_path(truth, slam)
    shown = true_path if len(true_path) or not paths else paths[0].positions
    upwards = _upwards(grid, true_path)
    figure = new_figure(*_figure_size(extent(from_above(shown, upwards)) if grid is None else _extent(grid)))
    axes = figure.add_subplot()
    set_top_view(axes, upwards)
    _draw_ground(axes, grid, path_xy)
    if len(true_path):
        draw_truth(axes, from_above(true_path, upwards))
    _draw_estimates(axes, paths, upwards)
    if slam is not None:
        _draw_losses(axes, slam, paths, upwards)
    axes.set_title(_title(summary), loc="left")
    if axes.get_legend_handles_labels()[0]:
        figure.legend(loc="outside right upper", frameon=False)
    # The axes keep their proportions: only a second layout, that of the drawing, finds their place beside the legend.
    if (layout := figure.get_layout_engine()) is not None:
        layout.execute(figure)
    figure.savefig(png, format="png")


def _upwards(grid: TopView | None, true_path: FloatArray) -> Upwards:
    if grid is not None:
        return "y"
    return upward_axis(true_path) if len(true_path) else "z"


def _true_path(truth: Trajectory | None, slam: SlamRecord | None) -> FloatArray:
    """True positions (N, 3) from the first fed frame to the last, a NaN in every hole; none without a truth."""
    if truth is None:
        return np.empty((0, 3))
    fed = np.ones(len(truth), dtype=np.bool_)
    if slam is not None:
        # Motion capture often runs for longer than the camera.
        fed = (truth.stamps_ns >= slam.stamps_ns[0]) & (truth.stamps_ns <= slam.stamps_ns[-1])
    while_fed = Trajectory(truth.stamps_ns[fed], truth.T[fed])
    return np.insert(while_fed.positions, find_holes(while_fed, 0.0) + 1, np.nan, axis=0)


def _estimates(slam: SlamRecord, map_policy: str) -> list[_Path]:
    """What is drawn of the SLAM's maps, evaluated ones first."""
    T, map_id = estimate_by_frame(slam)
    evaluated = evaluated_frames(slam, map_policy)
    chosen, others = (dict.fromkeys(map_id[frames].tolist()) for frames in (evaluated, ~evaluated & (map_id >= 0)))
    if true_poses(slam)[0] is None:
        # Nothing tells how two maps lie to each other.
        in_map = [(map_id == one)[:, None] for one in chosen]
        return [_Path(np.where(frames, T[:, :3, 3], np.nan), "estimate, in its own frame") for frames in in_map[:1]]
    label = "estimate, evaluated map" if len(chosen) < 2 else "estimate, evaluated maps"
    return [
        *(_Path(_aligned(slam, T, map_id == one), label) for one in chosen),
        *(_Path(_aligned(slam, T, map_id == one), "estimate, other maps", evaluated=False) for one in others),
    ]


def _aligned(slam: SlamRecord, T_map_cam: FloatArray, frames: BoolArray) -> FloatArray:
    """Estimated positions (N, 3) in the world; NaN, a gap in the line, outside `frames` or where those are too few."""
    positions = np.full((len(frames), 3), np.nan)
    judged = frames & true_poses(slam)[1]
    ref_T, est_T = slam.T_world_cam[judged], T_map_cam[judged]
    if is_determined(ref_T, est_T, "se3"):
        positions[frames] = align(ref_T, est_T).apply(T_map_cam[frames])[:, :3, 3]
    return positions


def _figure_size(size_m: FloatArray) -> tuple[float, float]:
    """Width and height, inches, for a plot in the proportions of what it shows with a legend on its right."""
    width, height = size_m + 1e-9
    return 9.5, float(np.clip(7.0 * height / width, 3.0, 9.0)) + 0.8


def _extent(grid: TopView) -> FloatArray:
    return np.array(grid.occupied.shape[::-1]) * grid.resolution_m


def _draw_ground(axes: Axes, grid: TopView | None, path_xy: FloatArray | None) -> None:
    if grid is None:
        tidy(axes)
    else:
        (x_min, y_min), (width, height) = grid.origin_xy, _extent(grid)
        axes.imshow(
            grid.occupied, origin="lower", extent=(x_min, x_min + width, y_min, y_min + height), cmap="Greys",
            vmin=0.0, vmax=4.0, interpolation="nearest",
        )  # fmt: skip
    if path_xy is not None:
        axes.plot(*path_xy.T, color="0.45", linestyle=":", linewidth=1.5, label="planned path")


def _draw_estimates(axes: Axes, paths: list[_Path], upwards: Upwards) -> None:
    labels: set[str] = set()
    for i, path in enumerate(paths):
        axes.plot(
            *from_above(path.positions, upwards).T, color=COLOURS[i % len(COLOURS)], linewidth=1.8,
            linestyle="-" if path.evaluated else "--", label=None if path.label in labels else path.label,
        )  # fmt: skip
        labels.add(path.label)


def _draw_losses(axes: Axes, slam: SlamRecord, paths: list[_Path], upwards: Upwards) -> None:
    """On the true path, or on what is drawn of the estimate."""
    ref_T, real = true_poses(slam)
    positions = np.full((len(real), 3), np.nan) if not paths else paths[0].positions
    if ref_T is not None:
        positions = with_holes(slam.stamps_ns, ref_T, real)[:, :3, 3]
    for i, loss in enumerate(find_losses(slam)):
        cross = draw_lost(axes, from_above(positions, upwards), loss.start_frame, loss.end_frame + 1)
        if i > 0:
            cross.set_label(None)


def _title(summary: Summary) -> str:
    if "status" not in summary:
        return "no SLAM"
    ate = "no ATE" if isnan(summary["ate_rmse_m"]) else f"ATE {summary['ate_rmse_m']:.3f} m"
    return f"{summary['status']}, {ate}, completion {percent(summary['completion'])}"
