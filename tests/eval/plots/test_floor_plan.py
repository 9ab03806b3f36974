from dataclasses import dataclass

import numpy as np
import pytest

from slamgym.eval.plots.floor_plan import plot_floor_plan
from slamgym.types import BoolArray, FloatArray


@dataclass(frozen=True)
class Grid:
    occupied: BoolArray
    origin_xy: FloatArray
    resolution_m: float


@dataclass(frozen=True)
class Room:
    name: str
    kind: str
    x_min: float = 10.0
    y_min: float = -1.5
    x_max: float = 11.0
    y_max: float = -0.5


PATH_XY = np.array([[10.25, -1.75], [10.75, -1.25]])
VIEWS_XY = np.array([[10.5, -1.5], [10.75, -1.25]])


@pytest.fixture
def plan():
    """Of 3 x 2 cells of 0.5 m: the lower row occupied, free, cut off; the upper one occupied but for its last cell."""
    occupied = np.array([[True, False, False], [True, True, False]])
    free = np.array([[False, True, False], [False, False, False]])
    grid = Grid(occupied, np.array([10.0, -2.0]), 0.5)
    rooms = [Room("fr_0rm_2", "living_room"), Room("bedroom_1", "bedroom")]
    return plot_floor_plan(grid, free, rooms, PATH_XY, VIEWS_XY)


def test_cells_lie_where_they_are_and_each_state_has_its_shade(plan):
    image = plan.axes[0].images[0]
    assert np.asarray(image.get_array()).tolist() == [[0, 2, 1], [0, 0, 1]]
    assert image.get_extent() == [10.0, 11.5, -2.0, -1.0]
    assert image.origin == "lower"
    grey = image.cmap(image.norm([0, 1, 2]))[:, 0]
    assert grey.tolist() == pytest.approx([0.45, 0.88, 1.0])


def test_rooms_are_drawn_with_their_names_and_kinds_that_these_do_not_tell(plan, texts_of):
    boxes = [patch.get_bbox().extents.tolist() for patch in plan.axes[0].patches]
    assert boxes == [[10.0, -1.5, 11.0, -0.5]] * 2
    labels = [text.get_text() for text in plan.axes[0].texts]
    assert labels[:2] == ["fr 0rm 2\nliving room", "bedroom 1"]
    assert {"living room", "bedroom 1"} <= set(texts_of(plan))


def test_the_path_and_its_numbered_views(plan):
    path, views = plan.axes[0].lines
    assert np.array_equal(path.get_xydata(), PATH_XY)
    assert np.array_equal(views.get_xydata(), VIEWS_XY)
    marks = {text.get_text(): text.xy for text in plan.axes[0].texts[2:]}
    assert {number: tuple(xy) for number, xy in marks.items()} == {"1": (10.5, -1.5), "2": (10.75, -1.25)}
