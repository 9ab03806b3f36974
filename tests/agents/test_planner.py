import numpy as np
import pytest
from scipy.ndimage import distance_transform_edt

from slamgym.agents.planner import plan_path
from slamgym.errors import ConfigError, SceneError
from slamgym.scenes.occupancy import OccupancyGrid

SEEDS = range(8)


def plan(house, length_m=12.0, seed=0, tour="one_way"):
    return plan_path(*house, length_m, np.random.default_rng(seed), tour)


def curvature(path):
    """1/m at the inner points."""
    step = np.diff(path.xy, axis=0)
    heading = np.unwrap(np.arctan2(step[:, 1], step[:, 0]))
    return np.abs(np.diff(heading)) / 0.05


@pytest.mark.parametrize("tour", ["one_way", "round_trip", "lap"])
@pytest.mark.parametrize("seed", SEEDS)
def test_the_robot_fits_everywhere_on_the_path(flat, seed, tour):
    grid, free = flat(seed)
    path = plan((grid, free), seed=seed, tour=tour)
    assert free[tuple(grid.cell_of(path.xy).T)].mean() > 0.98
    to_occupied = distance_transform_edt(~grid.occupied, sampling=0.05)
    # Neighbouring cells of free ones, at the most: half a cell nearer than free space is.
    assert to_occupied[tuple(grid.cell_of(path.xy).T)].min() >= 0.225
    assert np.diff(path.arc_m).max() < 0.055


@pytest.mark.parametrize("length_m", [0.5, 3.0, 10.0, 33.3])
def test_one_way_is_exactly_as_long_as_asked(flat, length_m):
    for seed in SEEDS:
        assert plan(flat(seed), length_m, seed).length_m == pytest.approx(length_m, abs=1e-9)


@pytest.mark.parametrize(("length_m", "excess"), [(3.0, 3.0), (10.0, 1.0), (33.3, 2.0)])
def test_a_round_trip_ends_where_it_starts_and_is_little_longer_than_asked(flat, length_m, excess):
    lengths = []
    for seed in SEEDS:
        path = plan(flat(seed), length_m, seed, "round_trip")
        assert np.linalg.norm(path.xy[0] - path.xy[-1]) < 1e-6
        lengths.append(path.length_m)
    assert min(lengths) >= length_m
    assert np.median(lengths) <= length_m + excess


def test_a_lap_takes_its_first_metres_once_more_in_the_same_direction(flat):
    for seed in SEEDS:
        path = plan(flat(seed), 14.0, seed, "lap")
        assert 14.0 <= path.length_m < 20.0
        # The joint at the start may curve for up to 0.8 m, and the end is smoothed.
        begin, end = path.between(1.2, 2.5), path.between(path.length_m - 2.2, path.length_m)
        nearest = np.linalg.norm(begin.xy[:, None] - end.xy[None], axis=2)
        assert nearest.min(axis=1).max() < 0.1
        assert (np.diff(nearest.argmin(axis=1)) >= 0).all()


def test_paths_bend_smoothly_where_there_is_room(flat):
    bends = np.concatenate([curvature(plan(flat(seed), 20.0, seed)) for seed in SEEDS])
    assert np.mean(bends < 1 / 0.25) > 0.99
    assert np.median(bends) < 1.0


def test_paths_keep_away_from_obstacles(flat):
    grid, free = flat(0)
    clearance = distance_transform_edt(~grid.occupied, sampling=0.05)
    on_path = np.concatenate([clearance[tuple(grid.cell_of(plan((grid, free), 15.0, seed).xy).T)] for seed in range(4)])
    assert np.mean(on_path < 0.35) < 0.1


def test_paths_lead_far_and_through_doors(flat):
    house = flat(1)
    spans = [np.ptp(plan(house, 15.0, seed).xy, axis=0).max() for seed in SEEDS]
    assert min(spans) > 2.4
    assert max(spans) > 6.0


def test_the_path_depends_on_grid_and_seed_alone(flat):
    house = flat(2)
    first, again, other = plan(house, seed=5), plan(house, seed=5), plan(house, seed=6)
    assert np.array_equal(first.xy, again.xy)
    assert np.linalg.norm(first.xy[0] - other.xy[0]) > 0.1
    # A longer path of the same seed begins as the shorter one.
    longer = plan(house, 14.0, seed=5)
    assert np.allclose(longer.point_at(np.arange(5)), first.point_at(np.arange(5)), atol=1e-6)


def test_where_no_curve_fits_the_path_turns_on_the_spot(corridor):
    path = plan(corridor, 12.0, seed=1)
    assert path.length_m == pytest.approx(12.0)
    assert curvature(path).max() > 20
    assert np.ptp(path.xy[:, 1]) < 0.4


def test_a_small_house_has_paths_too():
    free = np.zeros((60, 60), dtype=bool)
    free[20:40, 20:40] = True
    for tour in ("one_way", "round_trip", "lap"):
        assert plan((OccupancyGrid(~free, np.zeros(2), 0.05), free), 6.0, tour=tour).length_m >= 6.0 - 1e-9


def test_a_lap_too_short_to_close_a_loop_is_refused(flat):
    assert plan(flat(0), 6.0, tour="lap").length_m >= 6.0
    with pytest.raises(
        ConfigError, match=r"^path_length_m: expected at least 6 m for a lap, .* got 5\.9 m; ask for"
    ) as short:
        plan(flat(0), 5.9, tour="lap")
    assert "\n" not in str(short.value)


def test_errors():
    free = np.zeros((20, 20), dtype=bool)
    grid = OccupancyGrid(~free, np.zeros(2), 0.05)
    with pytest.raises(ConfigError, match="did you mean 'round_trip'"):
        plan((grid, free), tour="roundtrip")
    free[10, 10] = True
    with pytest.raises(SceneError, match="no path"):
        plan((grid, free))
