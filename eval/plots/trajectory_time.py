"""Position and errors over time, with the losses."""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from slamgym.errors import TrajectoryError
from slamgym.eval.accuracy import absolute_errors
from slamgym.eval.plots.names import plain_names
from slamgym.eval.plots.style import TRUTH, Look, legend_below, look, new_figure, tidy
from slamgym.eval.plots.tracked import check_names, marked_frames, posed_frames, tracked_frames, tracked_share
from slamgym.types import BoolArray, FloatArray

NO_TRUTH: dict[str, Any] = {
    "facecolor": "0.96",
    "edgecolor": "0.85",
    "hatch": "////",
    "linewidth": 0.0,
    "label": "no truth",
}
NOT_YET: dict[str, Any] = {
    "facecolor": "white",
    "edgecolor": "0.5",
    "hatch": "....",
    "linewidth": 0.8,
    "label": "not yet tracked",
}


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
    tracked: Mapping[str, BoolArray] | None = None,
) -> Figure:
    """x, y, z (m), translation error (m) and rotation error (deg) over the time, and a strip of losses a system.

    time_s: seconds since the first frame (N,). T_world_cam: true poses (N, 4, 4), NaN where they are not known: a
    hatched band. estimates: poses of the same frames, aligned (N, 4, 4), NaN where there is none. losses: those of
    every system, [] for none. tracked: the frames of each that count as tracked, bool (N,); by default those with a
    pose. Before the first of them a system is not lost, but not yet tracked. Raises TrajectoryError.
    """
    _check(time_s, [("truth", T_world_cam), *estimates.items()])
    check_names("losses", estimates, losses)
    frames = tracked_frames(estimates, tracked)
    figure = new_figure(9.0, 8.3 + 0.15 * len(estimates))
    ratios = [1.0, 1.0, 1.0, 1.0, 1.0, 0.12 + 0.16 * len(estimates)]
    panels = list(figure.subplots(6, 1, sharex=True, height_ratios=ratios))
    handles = [_draw_truth(panels, time_s, T_world_cam), *_draw_holes(panels, time_s, posed_frames(T_world_cam))]
    for i, (name, (key, T)) in enumerate(zip(plain_names(estimates), estimates.items(), strict=True)):
        label = f"{name}, {_outcome(frames[key], losses[key])}"
        handles.append(_draw_estimate(panels, time_s, T_world_cam, T, look(i), label))
        _draw_losses(panels, losses[key], i)
    handles += _draw_not_yet(panels[-1], time_s, list(frames.values()))
    _label(panels, plain_names(estimates, 24))
    legend_below(figure, handles)
    return figure


def _check(time_s: FloatArray, poses: Sequence[tuple[str, FloatArray]]) -> None:
    for name, T in poses:
        if np.shape(T) != (len(time_s), 4, 4):
            raise TrajectoryError(
                f"plot_trajectory_time: expected poses ({len(time_s)}, 4, 4) of {name!r}, NaN where not tracked, "
                f"got {np.shape(T)}"
            )


def _outcome(tracked: BoolArray, losses: Sequence[Loss]) -> str:
    if not tracked.any():
        return "never tracked"
    return f"{tracked_share(tracked)}, {len(losses)} {'loss' if len(losses) == 1 else 'losses'}"


def _draw_truth(panels: Sequence[Axes], time_s: FloatArray, T_world_cam: FloatArray) -> Artist:
    lines = [axes.plot(time_s, T_world_cam[:, k, 3], color=TRUTH, linewidth=2.0) for k, axes in enumerate(panels[:3])]
    lines[0][0].set_label("truth")
    return lines[0][0]


def _draw_holes(panels: Sequence[Axes], time_s: FloatArray, known: BoolArray) -> list[Artist]:
    """A band over every run of frames without a true pose, from the last known one to the next; for the legend."""
    edges = np.flatnonzero(np.diff(np.concatenate([[True], known, [True]])))
    last = len(known) - 1
    for start, after in zip(edges[0::2], edges[1::2], strict=True):
        for axes in panels[:-1]:
            axes.axvspan(time_s[max(start - 1, 0)], time_s[min(after, last)], zorder=0, **NO_TRUTH)
    return [Patch(**NO_TRUTH)] if len(edges) else []


def _draw_estimate(
    panels: Sequence[Axes], time_s: FloatArray, T_world_cam: FloatArray, T: FloatArray, style: Look, label: str
) -> Line2D:
    curves = [*T[:, :3, 3].T, *_errors(T_world_cam, T)]
    for axes, curve in zip(panels, curves, strict=False):
        (line,) = axes.plot(
            time_s, curve, color=style.colour, linestyle=style.dash, linewidth=1.4, marker=style.marker, markersize=4,
            markevery=marked_frames(np.isfinite(curve)), label=label,
        )  # fmt: skip
    return line


def _errors(T_world_cam: FloatArray, T: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Distance (N,), metres, and angle (N,), degrees, between true and estimated poses; NaN where one is missing."""
    trans_m, rot_deg = np.full((2, len(T)), np.nan)
    judged = posed_frames(T_world_cam) & posed_frames(T)
    trans_m[judged], rot_deg[judged] = absolute_errors(T_world_cam[judged], T[judged])
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


def _draw_not_yet(strip: Axes, time_s: FloatArray, tracked: Sequence[BoolArray]) -> list[Artist]:
    """A bar up to each system's first tracked frame, or to the end; what the legend needs of it."""
    late = {i: flags for i, flags in enumerate(tracked) if len(flags) and not flags[0]}
    for i, flags in late.items():
        first_s = time_s[np.argmax(flags) if flags.any() else -1] - time_s[0]
        strip.barh(i, first_s, 0.7, left=time_s[0], **NOT_YET)
    return [Patch(**NOT_YET)] if late else []


def _label(panels: Sequence[Axes], names: Sequence[str]) -> None:
    for axes, label in zip(panels, ("x (m)", "y (m)", "z (m)", "trans. error (m)", "rot. error (deg)"), strict=False):
        axes.set_ylabel(label)
        tidy(axes)
    for axes in panels[3:5]:
        # Part of the data, or a constant error would lie on the frame of the axes.
        axes.axhline(0.0, color="0.9", linewidth=0.8, zorder=0)
        axes.set_ylim(bottom=0.0)
    strip = panels[-1]
    tidy(strip, grid=False)
    strip.set_yticks(range(len(names)), names, fontsize=8)
    strip.margins(x=0.01)
    strip.set(ylim=(max(len(names), 1) - 0.4, -0.6), xlabel="time (s)", ylabel="lost")
