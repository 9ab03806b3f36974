"""Whether robots get through procedural homes."""

import numpy as np
import pytest
from scipy import ndimage

from slamgym.agents.planner import plan_path
from slamgym.scenes.home.division import SIZES, make_floor_plan
from slamgym.scenes.house import House
from slamgym.scenes.occupancy import free_space, occupancy_grid
from slamgym.scenes.procedural import HomeOptions, furnished_house


def test_a_wide_robot_reaches_every_room(home):
    """Routes of 0.7 m: a disc of radius 0.35 m, less a cell that it may be off, gets from every room to the others."""
    grid = occupancy_grid(home, robot_height=1.1)
    clearance = ndimage.distance_transform_edt(~grid.occupied, sampling=grid.resolution_m)
    labels, _ = ndimage.label(clearance > 0.35 - grid.resolution_m)
    sizes = np.bincount(labels.ravel())
    main = labels == 1 + sizes[1:].argmax()
    robot = free_space(grid, 0.25)
    for room in home.rooms:
        inside = np.zeros_like(main)
        (r0, c0), (r1, c1) = grid.cell_of([[room.x_min, room.y_min], [room.x_max, room.y_max]])
        inside[r0 : r1 + 1, c0 : c1 + 1] = True
        assert (main & inside).any(), room.name
        assert (robot & inside).sum() * grid.resolution_m**2 > 0.8, room.name


def assert_drivable(home: House, seed: int, most_triangles: int) -> None:
    grid = occupancy_grid(home, 0.9)
    path = plan_path(grid, free_space(grid, 0.25), 10.0, np.random.default_rng(seed))
    assert path.length_m > 10.0 - 1e-6
    assert sum(len(part.faces) for part in home.parts) <= most_triangles


def test_drivable(home, size_and_seed, most_triangles):
    size, seed = size_and_seed
    assert_drivable(home, seed, most_triangles[size])


@pytest.mark.slow
@pytest.mark.parametrize(("size", "first"), [("small", 0), ("medium", 50), ("large", 150)])
def test_two_hundred_drivable_homes(size, first, most_triangles):
    for seed in range(first, first + {"small": 50, "medium": 100, "large": 50}[size]):
        home = furnished_house(f"procedural:{seed}", seed, HomeOptions(size=size))
        assert_drivable(home, seed, most_triangles[size])


@pytest.mark.seeds
@pytest.mark.parametrize("first", range(0, 1000, 100))
def test_a_thousand_drivable_homes(first, most_triangles):
    for seed in range(first, first + 100):
        home = furnished_house(f"procedural:{seed}", seed, HomeOptions())
        assert_drivable(home, seed, most_triangles["medium"])


@pytest.mark.parametrize("size", SIZES)
def test_two_hundred_floor_plans(size):
    for seed in range(200):
        plan = make_floor_plan(np.random.default_rng(seed), size)
        joined = {0}
        for _ in plan.rooms:
            for doorway in plan.doorways:
                if joined & {*doorway.rooms}:
                    joined |= {*doorway.rooms}
        assert len(joined) == len(plan.rooms)
        bathroom = next(i for i, p in enumerate(plan.rooms) if p.room.kind == "bathroom")
        assert sum(bathroom in doorway.rooms for doorway in plan.doorways) == 1
        doors = sum(o.kind == "door" for p in plan.rooms for w in p.walls for o in w.openings)
        assert doors == 2 * len(plan.doorways)
