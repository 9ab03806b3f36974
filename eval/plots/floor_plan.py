"""A picture of a house from above: rooms, where the robot can be, and a path through it."""

from collections.abc import Sequence
from math import ceil
from typing import Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from slamgym.eval.plots.drive_map import TopView
from slamgym.eval.plots.names import plain
from slamgym.eval.plots.style import COLOURS, new_figure
from slamgym.eval.plots.top_view import set_top_view
from slamgym.types import BoolArray, FloatArray

BLOCKED, FLOOR, FREE = "0.45", "0.88", "#FFFFFF"
LONGEST_NAME = 24


class RoomOutline(Protocol):
    """What is drawn of a room: its name and kind, and its bounds on the floor, metres."""

    @property
    def name(self) -> str: ...
    @property
    def kind(self) -> str: ...
    @property
    def x_min(self) -> float: ...
    @property
    def y_min(self) -> float: ...
    @property
    def x_max(self) -> float: ...
    @property
    def y_max(self) -> float: ...


def plot_floor_plan(
    grid: TopView, free: BoolArray, rooms: Sequence[RoomOutline], path_xy: FloatArray, views_xy: FloatArray
) -> Figure:
    """What is occupied (dark), floor too narrow or cut off for the robot (grey), where its centre can be (white, `free`
    of the grid's shape), rooms by name and kind, a path (P, 2), and numbered places of views (N, 2) on it, metres.
    """
    height, width = np.array(grid.occupied.shape) * grid.resolution_m
    figure = new_figure(9.5, float(np.clip(9.0 * height / width, 3.0, 10.0)) + 0.8)
    axes = figure.add_subplot()
    set_top_view(axes)
    cells = np.where(grid.occupied, 0, np.where(free, 2, 1))
    x, y = grid.origin_xy
    axes.imshow(
        cells, origin="lower", extent=(x, x + width, y, y + height), cmap=ListedColormap([BLOCKED, FLOOR, FREE]),
        vmin=0, vmax=2, interpolation="nearest",
    )  # fmt: skip
    for room in rooms:
        _draw_room(axes, room)
    axes.plot(*path_xy.T, color=COLOURS[0], linewidth=2.0)
    _draw_views(axes, views_xy)
    axes.set_title(
        "dark: occupied; grey: floor that the robot cannot reach; white: where its centre can be", loc="left"
    )
    return figure


def _draw_room(axes: Axes, room: RoomOutline) -> None:
    size = room.x_max - room.x_min, room.y_max - room.y_min
    axes.add_patch(Rectangle((room.x_min, room.y_min), *size, fill=False, edgecolor="0.2", linewidth=0.8))
    axes.annotate(
        _label(room), (room.x_min, room.y_max), (4, -4),
        textcoords="offset points", va="top", fontsize=8, color="0.1",
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.0},
    )  # fmt: skip


def _label(room: RoomOutline) -> str:
    """The name, and on a line of its own the kind where the name does not tell it."""
    told = [room.name] if room.kind in room.name else [room.name, room.kind]
    return "\n".join(plain(text.replace("_", " "), LONGEST_NAME) for text in told)


def _draw_views(axes: Axes, views_xy: FloatArray) -> None:
    axes.plot(*views_xy.T, marker="o", markersize=4, linestyle="none", color=COLOURS[0])
    every = max(1, ceil(len(views_xy) / 40))
    for number, xy in list(enumerate(views_xy, start=1))[::every]:
        axes.annotate(str(number), xy, (3, 3), textcoords="offset points", fontsize=8, color=COLOURS[0], weight="bold")
