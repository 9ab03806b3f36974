import numpy as np
import pytest

from slamgym.scenes.house import House, Material, Part, Room
from slamgym.scenes.indoors import _closed, indoors
from slamgym.scenes.occupancy import free_space, occupancy_grid

BOX_FACES = [
    [0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4],
    [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7],
]  # fmt: skip
GARDEN_M = 15.0


def box(x0, y0, z0, x1, y1, z1):
    base = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    vertices = np.array([(x, y, z) for z in (z0, z1) for x, y in base], np.float32)
    return Part("x", Material("m"), vertices, np.array(BOX_FACES, np.int32))


def wall(x0, y0, x1, y1, z0=0.0, z1=2.5):
    return box(min(x0, x1) - 0.05, min(y0, y1) - 0.05, z0, max(x0, x1) + 0.05, max(y0, y1) + 0.05, z1)


GARDEN = box(-GARDEN_M, -GARDEN_M, -0.1, GARDEN_M, GARDEN_M, 0.0)
HOUSE = [  # 6 x 4 m with an open front door of 1 m, no lintel, and another right opposite
    wall(-3, -2, -0.5, -2), wall(0.5, -2, 3, -2), wall(-3, 2, -0.5, 2), wall(0.5, 2, 3, 2),
    wall(-3, -2, -3, 2), wall(3, -2, 3, 2),
]  # fmt: skip
FENCE = [wall(-12, -12, 12, -12, z1=1.5), wall(-12, 12, 12, 12, z1=1.5), wall(-12, -12, -12, 12, z1=1.5)]
TREE = box(8, 5, 0, 8.4, 5.4, 4)


def turned(parts, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    R = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]], np.float32)
    return [Part(part.name, part.material, part.vertices @ R, part.faces) for part in parts]


def free_m2(parts, rooms=()):
    grid = occupancy_grid(House("test", tuple(parts), rooms), 0.9)
    return np.count_nonzero(free_space(grid, 0.25)) * 0.05**2


@pytest.mark.parametrize("degrees", [0, 20, 45, 70])
def test_the_robot_stays_in_the_house_though_the_garden_is_larger(degrees):
    # 5.9 x 3.9 m between the walls, less 0.3 m or so all around.
    assert free_m2(turned([GARDEN, *HOUSE], degrees)) == pytest.approx(5.3 * 3.3, abs=2.0)


def test_fences_are_no_walls_and_a_tree_is_no_house():
    assert free_m2([GARDEN, *HOUSE, *FENCE, TREE]) == pytest.approx(5.3 * 3.3, abs=2.0)


def test_a_house_with_corners():
    """L-shaped: 6 x 4 m and 3 x 4 m beside it."""
    legs = [wall(-3, -2, 3, -2), wall(3, -2, 3, 6), wall(0, 6, 3, 6), wall(0, 2, 0, 6), wall(-3, 2, 0, 2)]
    assert free_m2([GARDEN, *legs, wall(-3, -2, -3, 2)]) == pytest.approx(5.3 * 3.3 + 2.3 * 4, abs=2.5)


def test_a_ground_plane_without_end_costs_nothing():
    parts = [box(-500, -500, -0.1, 500, 500, 0.0), *HOUSE]
    grid = occupancy_grid(House("test", tuple(parts)), 0.9)
    assert max(grid.occupied.shape) < 140
    assert free_m2(parts) == pytest.approx(5.3 * 3.3, abs=2.0)


def test_rooms_tell_it_where_walls_are_hidden():
    rooms = (Room("a", "living", -3, -2, 0, 2), Room("b", "kitchen", 0.2, -2, 3, 2))
    assert free_m2([GARDEN], rooms) == pytest.approx(5.5 * 3.5, abs=0.7)
    # Two that are far apart: the larger one.
    rooms = (rooms[0], Room("b", "kitchen", 2.0, -2, 4, 2))
    assert free_m2([GARDEN], rooms) == pytest.approx(2.5 * 3.5, abs=0.5)


def test_a_corridor_that_is_no_room_is_indoors_too():
    rooms = (Room("a", "living", -2.95, -1.95, -1, 1.95), Room("b", "kitchen", 1, -1.95, 2.95, 1.95))
    assert free_m2([GARDEN, *HOUSE], rooms) == pytest.approx(5.3 * 3.3, abs=2.0)


def test_cells_in_rooms_are_those_whose_centres_are():
    bounds = np.round(np.random.default_rng(0).uniform(-1, 6, (9, 4)), 2)  # some end before they begin
    rooms = tuple(Room("r", "living", *map(float, room)) for room in [*bounds, (0.0, 0.0, 3.0, 2.0)])
    raster, inside = indoors(House("test", (), rooms), 0.05)
    y, x = ((np.arange(n) + 0.5) * 0.05 + o for n, o in zip(raster.shape, raster.origin_xy[::-1], strict=True))
    expected = np.zeros(raster.shape, bool)
    for room in rooms:
        expected |= ((y >= room.y_min) & (y <= room.y_max))[:, None] & ((x >= room.x_min) & (x <= room.x_max))
    # Gaps between rooms, as wide as walls, are closed besides.
    assert inside[expected].all()
    assert np.array_equal(inside, _closed(expected, 12.0))


@pytest.mark.parametrize(
    "parts",
    [
        [],
        [wall(-3, 2, 3, 2), wall(-3, -2, -3, 2)],  # a stage with two walls
        [wall(-3, 2, 3, 2), wall(0, 1, 1, 1.5)],  # one, and a wardrobe
        [box(-1, -1, 0, 1, 0, 2.2)],  # a wardrobe alone
    ],
)
def test_without_walls_around_it_the_whole_floor_counts(parts):
    stage = box(-3, -2, -0.1, 3, 2, 0.0)
    assert indoors(House("test", (stage, *parts)), 0.05) is None
    assert free_m2([stage, *parts]) > 10
