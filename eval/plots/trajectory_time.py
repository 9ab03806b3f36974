"""Position and errors over time, with the losses."""

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from slamgym.errors import TrajectoryError
from slamgym.eval.plots.names import plain_names
from slamgym.eval.plots.style import TRUTH, Look, legend_below, look, new_figure, tidy
from slamgym.eval.plots.trajectory_top import tracked_rows, tracked_share
from slamgym.geometry import inverse, rotation_angle
from slamgym.types import FloatArray


class Loss(Protocol):
    """A time without tracking, seconds since the first frame, such as `slamgym.types.LossEvent`."""

    @property
    def start_s(self) -> float: ...
    @property
    def duration_s(self) -> float: ...


def plot_trajectory_time(
    time_s: FloatArray,
    T_world_cam: FloatArray,
    estimates: Mapping[str, FloatArray],
    losses: Mapping[str, Sequence[Loss]],
) -> Figure:
    """x, y, z (m), translation error (m) and rotation error (deg) over the time, and a strip of losses a system.

    time_s: seconds since the first frame (N,). T_world_cam: true poses (N, 4, 4). estimates: poses of the same frames,
    aligned (N, 4, 4), NaN where not tracked. losses: those of every system, [] for none. Raises TrajectoryError.
    """
    _check(time_s, [("truth", T_world_cam), *estimates.items()])
    if set(losses) != set(estimates):
        raise TrajectoryError(
            f"plot_trajectory_time: expected losses of {sorted(estimates)}, got those of {sorted(losses)}; "
            "give every estimate's losses, [] for none"
        )
    figure = new_figure(9.0, 8.6 + 0.25 * len(estimates))
    ratios = [1.0, 1.0, 1.0, 1.0, 1.0, 0.12 + 0.16 * len(estimates)]
    panels = list(figure.subplots(6, 1, sharex=True, height_ratios=ratios))
    handles: list[Artist] = [_draw_truth(panels, time_s, T_world_cam)]
    names = plain_names(estimates)
    for i, (key, T) in enumerate(estimates.items()):
        label = f"{names[i]}, {tracked_share(tracked_rows(T))}, {_count(losses[key])}"
        handles.append(_draw_estimate(panels, time_s, T_world_cam, T, look(i), label))
        _draw_losses(panels, losses[key], i)
    _label(panels, plain_names(estimates, 18))
    legend_below(figure, handles)
    return figure


def _check(time_s: FloatArray, poses: Sequence[tuple[str, FloatArray]]) -> None:
    for name, T in poses:
        if np.shape(T) != (len(time_s), 4, 4):
            raise TrajectoryError(
                f"plot_trajectory_time: expected poses ({len(time_s)}, 4, 4) of {name!r}, NaN where not tracked, "
                f"got {np.shape(T)}"
            )


def _count(losses: Sequence[Loss]) -> str:
    return f"{len(losses)} {'loss' if len(losses) == 1 else 'losses'}"


def _draw_truth(panels: Sequence[Axes], time_s: FloatArray, T_world_cam: FloatArray) -> Line2D:
    lines = [axes.plot(time_s, T_world_cam[:, k, 3], color=TRUTH, linewidth=2.0) for k, axes in enumerate(panels[:3])]
    lines[0][0].set_label("truth")
    return lines[0][0]


def _draw_estimate(
    panels: Sequence[Axes], time_s: FloatArray, T_world_cam: FloatArray, T: FloatArray, style: Look, label: str
) -> Line2D:
    curves = [*T[:, :3, 3].T, *_errors(T_world_cam, T)]
    every = max(len(time_s) // 12, 1)
    for axes, curve in zip(panels, curves, strict=False):
        (line,) = axes.plot(
            time_s, curve, color=style.colour, linestyle=style.dash, linewidth=1.4, marker=style.marker, markersize=4,
            markevery=every, label=label,
        )  # fmt: skip
    return line


def _errors(T_world_cam: FloatArray, T: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Distance (N,), metres, and angle (N,), degrees, between true and estimated poses; NaN where not tracked."""
    trans_m, rot_deg = np.full((2, len(T)), np.nan)
    tracked = tracked_rows(T)
    if tracked.any():
        error = inverse(T_world_cam[tracked]) @ T[tracked]
        trans_m[tracked] = np.linalg.norm(error[:, :3, 3], axis=1)
        rot_deg[tracked] = np.rad2deg(rotation_angle(error))
    return trans_m, rot_deg


def _draw_losses(panels: Sequence[Axes], losses: Sequence[Loss], i: int) -> None:
    """Shades over the curves, and a row of its own in the last panel, which tells the systems apart without colour."""
    for loss in losses:
        for axes in panels[:-1]:
            axes.axvspan(loss.start_s, loss.start_s + loss.duration_s, facecolor=look(i).colour, alpha=0.15, zorder=0)
    panels[-1].broken_barh(
        [(loss.start_s, loss.duration_s) for loss in losses], (i - 0.35, 0.7), facecolor=look(i).colour,
        edgecolor="black", linewidth=0.8,
    )  # fmt: skip


def _label(panels: Sequence[Axes], names: Sequence[str]) -> None:
    for axes, label in zip(panels, ("x (m)", "y (m)", "z (m)", "trans. error (m)", "rot. error (deg)"), strict=False):
        axes.set_ylabel(label)
        tidy(axes)
    for axes in panels[3:5]:
        axes.set_ylim(bottom=0.0)
    strip = panels[-1]
    tidy(strip, grid=False)
    strip.set_yticks(range(len(names)), [f"{name}, lost" for name in names], fontsize=8)
    strip.set_ylim(max(len(names), 1) - 0.4, -0.6)
    strip.set_xlabel("time (s)")
