import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial import cKDTree

from slamgym.errors import SceneError
from slamgym.scenes.house import House, Material, Part
from slamgym.scenes.occupancy import OccupancyGrid, free_space, occupancy_grid

BOX_FACES = [
    [0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4],
    [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7],
]  # fmt: skip


def mesh(vertices, faces, solid=True):
    return Part("x", Material("m"), np.array(vertices, np.float32), np.array(faces, np.int32), solid=solid)


def box(x0, y0, z0, x1, y1, z1, solid=True):
    base = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    return mesh([(x, y, z) for z in (z0, z1) for x, y in base], BOX_FACES, solid)


def floor(x0=0.0, y0=0.0, x1=6.0, y1=4.0, z=0.0):
    return mesh([(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)], [[0, 1, 2], [0, 2, 3]])


def grid_of(*parts, robot_height=0.9):
    return occupancy_grid(House("test", tuple(parts)), robot_height)


def occupied_at(grid, x, y):
    return bool(grid.occupied[tuple(grid.cell_of((x, y)))])


def two_rooms(door_m, offset=0.0):
    """A wall of 0.1 m at x = 3 with a door that begins at y = 1.5."""
    y0, y1 = 1.5 + offset, 1.5 + offset + door_m
    return [
        floor(), box(2.95, 0, 0, 3.05, y0, 2.5), box(2.95, y1, 0, 3.05, 4, 2.5), box(2.95, y0, 2.0, 3.05, y1, 2.5)
    ]  # fmt: skip


@pytest.mark.parametrize("offset", [0.0, 0.013, 0.025, 0.04])
@pytest.mark.parametrize("door_m", [0.7, 0.8, 0.9])
def test_doors_stay_as_wide_as_they_are_and_can_be_passed(door_m, offset):
    grid = grid_of(*two_rooms(door_m, offset))
    first, last = grid.cell_of([(2.95, 0.0), (3.05, 0.0)])[:, 1]
    wall = grid.occupied[1:-1, first : last + 1].any(axis=1)
    assert abs(np.count_nonzero(~wall) * 0.05 - door_m) <= 0.1 + 1e-9
    free = free_space(grid, 0.25)
    assert free[tuple(grid.cell_of((1.0, 2.0)))]
    assert free[tuple(grid.cell_of((5.0, 2.0)))]


@pytest.mark.parametrize("degrees", [0, 11, 22.5, 30, 45, 60, 77, 90])
def test_doors_of_070_can_be_passed_at_any_angle(degrees):
    for offset in (0.0, 0.013, 0.027, 0.041):
        parts = [turned(part, degrees, offset) for part in two_rooms(0.7)]
        grid = grid_of(*parts)
        free = free_space(grid, 0.25)
        for x in (1.0, 5.0):
            assert free[tuple(grid.cell_of(turned_xy(np.array([x, 2.0]), degrees, offset)))]


@pytest.mark.parametrize("degrees", [0, 22.5, 45])
def test_gaps_of_half_a_metre_cannot_be_passed_at_any_angle(degrees):
    grid = grid_of(*(turned(part, degrees, 0.0) for part in two_rooms(0.5)))
    free = free_space(grid, 0.25)
    reached = [free[tuple(grid.cell_of(turned_xy(np.array([x, 2.0]), degrees, 0.0)))] for x in (1.0, 5.0)]
    assert sum(reached) == 1


def turned_xy(xy, degrees, offset):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return xy @ np.array([[c, s], [-s, c]]) + offset


def turned(part, degrees, offset):
    xy = turned_xy(part.vertices[:, :2], degrees, offset)
    return mesh(np.column_stack([xy, part.vertices[:, 2]]), part.faces)


def test_free_space_is_the_larger_room_where_the_door_is_too_narrow():
    wall = [box(1.95, 0, 0, 2.05, 1.8, 2.5), box(1.95, 2.2, 0, 2.05, 4, 2.5)]
    free = free_space(grid := grid_of(floor(), *wall), 0.25)
    assert free[tuple(grid.cell_of((4.0, 2.0)))]
    assert not free[tuple(grid.cell_of((1.0, 2.0)))]


def test_only_what_is_in_the_way_of_the_robot_counts():
    rug, lamp = box(1, 1, 0, 2, 2, 0.01), box(1, 1, 2, 2, 2, 2.2)
    table = [box(3, 1, 0.7, 5, 3, 0.75), box(3, 1, 0, 3.04, 1.04, 0.7)]
    plant = box(1, 3, 0, 1.4, 3.4, 1, solid=False)
    tall = grid_of(floor(), rug, lamp, *table, plant, robot_height=0.9)
    low = grid_of(floor(), rug, lamp, *table, plant, robot_height=0.3)
    assert not occupied_at(tall, 1.5, 1.5)
    assert not occupied_at(tall, 1.2, 3.2)
    assert occupied_at(tall, 4.0, 2.0)
    assert not occupied_at(low, 4.0, 2.0)
    assert occupied_at(low, 3.02, 1.02)  # the leg, thinner than a cell


def test_no_floor_no_drive():
    grid = grid_of(floor(0, 0, 2, 4), floor(3, 0, 6, 4), floor(2, 0, 3, 4, z=-0.2))
    assert occupied_at(grid, 2.5, 2.0)
    assert not occupied_at(grid, 1.0, 2.0)
    assert not occupied_at(grid, 5.0, 2.0)


def test_floors_as_real_meshes_have_them():
    slab = box(0, 0, -0.3, 3, 4, 0)
    next_room = floor(3, 0, 6, 4, z=-0.02)
    threshold, carpet = box(2.9, 0, 0, 3.1, 4, 0.03), floor(1, 1, 2, 3, z=0.012)
    doubled = floor(4, 1, 6, 3, z=-0.0201)
    step = box(5, 0, 0, 6, 0.5, 0.05)
    grid = grid_of(slab, next_room, threshold, carpet, doubled, step)
    occupied = grid.occupied & ~grid_of(floor(5, 0, 6, 0.5), floor()).occupied
    rows, columns = np.nonzero(occupied)
    x, y = grid.centre_of(np.column_stack([rows, columns])).T
    # Nothing but the step is in the way.
    assert (x > 4.94).all()
    assert (y < 0.56).all()
    assert len(rows) >= 20 * 10


def test_the_grid_covers_the_floor_with_an_occupied_margin():
    grid = grid_of(floor(-1.0, 2.0, 2.0, 4.0))
    assert grid.occupied.shape == (43, 63)
    assert np.allclose(grid.origin_xy, (-1.075, 1.925))
    assert grid.occupied[[0, -1]].all()
    assert grid.occupied[:, [0, -1]].all()
    assert not grid.occupied[1:-1, 1:-1].any()


@settings(max_examples=60, deadline=None)
@given(arrays(np.float64, (3, 2), elements=st.floats(0.2, 3.8)), st.integers(0, 2**32 - 1))
def test_a_triangle_occupies_the_cells_it_touches_and_no_others(corners, seed):
    triangle = np.column_stack([corners, [0.1, 0.5, 0.8]])
    grid = grid_of(floor(0, 0, 4, 4), mesh(triangle, [[0, 1, 2]]))
    weights = np.random.default_rng(seed).dirichlet([0.7] * 3, 300)
    inside = weights @ corners
    # Sampled at 0.02 m: a cell may be missed where the triangle cuts less than that off its corner.
    shifts = 0.02 * np.array([(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1)])
    rows, columns = np.moveaxis(grid.cell_of(inside[:, None] + shifts), -1, 0)
    assert grid.occupied[rows, columns].any(axis=1).all()
    centres = grid.centre_of(np.argwhere(grid.occupied[1:-1, 1:-1]) + 1)
    dense = np.vstack([corners, np.random.default_rng(0).dirichlet([0.7] * 3, 30_000) @ corners])
    assert cKDTree(dense).query(centres)[0].max(initial=0.0) < 0.05 * np.sqrt(0.5) + 0.03


@given(st.floats(-50, 50), st.floats(-50, 50), st.floats(0.01, 0.3))
def test_cells_and_points_agree(x, y, resolution_m):
    grid = OccupancyGrid(np.zeros((2, 2), bool), np.array([x, y]), resolution_m)
    cells = np.array([[0, 0], [3, 1], [-2, 40]])
    assert np.array_equal(grid.cell_of(grid.centre_of(cells)), cells)
    assert np.allclose(grid.centre_of((0, 3)) - (x, y), np.array([3.5, 0.5]) * resolution_m)


def test_free_space_keeps_the_robot_clear_of_everything():
    grid = grid_of(*two_rooms(0.9), box(4, 1, 0, 4.6, 1.5, 1))
    free = grid.centre_of(np.argwhere(free_space(grid, 0.25)))
    occupied = grid.centre_of(np.argwhere(grid.occupied))
    distance = np.linalg.norm(free[:, None] - occupied[None], axis=2).min()
    assert 0.25 < distance < 0.35


def test_what_lies_beyond_the_grid_is_not_free():
    free = free_space(OccupancyGrid(np.zeros((60, 80), bool), np.zeros(2), 0.05), 0.25)
    rows, columns = np.nonzero(free)
    # The centre of the sixth cell is 0.275 m from the border, and 0.3 m from the centre of the first cell beyond it.
    assert (rows.min(), rows.max(), columns.min(), columns.max()) == (5, 54, 5, 74)


def test_errors_say_what_is_wrong_with_the_scene():
    with pytest.raises(SceneError, match="no floor"):
        grid_of(floor(z=0.5))
    with pytest.raises(SceneError, match="no floor"):
        grid_of(mesh([(0, 0, 0), (6, 0, 0), (6, 4, 0)], [[0, 2, 1]]))  # faces down
    with pytest.raises(SceneError, match="no floor"):
        grid_of()
    with pytest.raises(SceneError, match="600 x 400; check that it is in metres"):
        grid_of(floor(0, 0, 600, 400))
    with pytest.raises(SceneError, match="'test': too large"):
        grid_of(floor(0, 0, 1e30, 1e30))
    with pytest.raises(SceneError, match="'test': expected corners at finite places"):
        grid_of(floor(), floor(0, 0, np.inf, 1))
    with pytest.raises(SceneError, match=r"no room for the robot.*got 0\.\d\d m2 out of 2\.\d\d m2"):
        free_space(grid_of(floor(0, 0, 1.5, 1.5)), 0.3)


def test_a_sky_around_the_house_is_no_wall():
    sky = box(-1e6, -1e6, -1e6, 1e6, 1e6, 1e6)
    assert np.array_equal(grid_of(floor(), sky, *two_rooms(0.9)).occupied, grid_of(floor(), *two_rooms(0.9)).occupied)


def test_a_detailed_house_takes_less_than_a_second():
    rng = np.random.default_rng(0)
    corners = rng.uniform((0, 0, 0), (20, 12, 2.5), (50_000, 1, 3)) + rng.normal(0, 0.02, (50_000, 3, 3))
    clutter = mesh(corners.reshape(-1, 3), np.arange(150_000).reshape(-1, 3))
    grid = grid_of(floor(0, 0, 20, 12), clutter)
    assert grid.occupied.any()
