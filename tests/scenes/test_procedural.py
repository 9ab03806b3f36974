"""Procedural houses: what every seed must give."""

import hashlib
import subprocess
import sys
from collections import defaultdict
from dataclasses import fields
from functools import cache
from itertools import combinations

import cv2
import numpy as np
import pytest
from scipy import ndimage

from slamgym.agents.planner import plan_path
from slamgym.errors import ConfigError, SceneError
from slamgym.scenes.home.division import SIZES, make_floor_plan
from slamgym.scenes.home.palette import make_palette
from slamgym.scenes.house import House, Part
from slamgym.scenes.occupancy import free_space, occupancy_grid
from slamgym.scenes.procedural import HomeOptions, Procedural, furnished_house

HOMES = [("medium", 0), ("medium", 1), ("medium", 2), ("small", 0), ("small", 1), ("large", 0)]
SHELL = {"floor", "ceiling", "wall", "window", "doorway", "facade"}
OPEN_SHEETS = {"plane", "inner", "face", "view", "picture", "screen", "cover", "pile"}
TRIANGLES = {"small": 150_000, "medium": 150_000, "large": 300_000}

each_home = pytest.mark.parametrize(("size", "seed"), HOMES)


@cache
def house(size: str = "medium", seed: int = 0, clutter: float = 1.0, texture: float = 1.0) -> House:
    return furnished_house("home", seed, HomeOptions(size=size, clutter=clutter, texture=texture))


def kind_of(name: str) -> str:
    return name.split("/")[0].rsplit("_", 1)[0]


def pieces(house: House) -> dict[str, list[Part]]:
    found = defaultdict(list)
    for part in house.parts:
        if kind_of(part.name) not in SHELL:
            found[part.name.split("/")[0]].append(part)
    return found


def bounds(parts: list[Part]) -> np.ndarray:
    vertices = np.concatenate([p.vertices for p in parts]).astype(np.float64)
    return np.stack([vertices.min(axis=0), vertices.max(axis=0)])


def overlap(a: np.ndarray, b: np.ndarray, tolerance: float = 2e-3) -> bool:
    return bool((np.minimum(a[1], b[1]) - np.maximum(a[0], b[0]) > tolerance).all())


def digest(house: House) -> str:
    state = hashlib.sha256()
    for part in house.parts:
        state.update(part.name.encode())
        for array in (part.vertices, part.faces, part.uv, part.material.texture):
            state.update(b"" if array is None else array.tobytes())
    state.update(repr((house.rooms, house.lamps)).encode())
    return state.hexdigest()


@each_home
def test_a_furnished_home(size, seed):
    home = house(size, seed)
    found = pieces(home)
    rich = {kind_of(name) for name, parts in found.items() if len(parts) >= 3}
    rooms = {"small": (4, 4), "medium": (4, 7), "large": (9, 11)}[size]
    assert rooms[0] <= len(home.rooms) <= rooms[1]
    assert {"living_room", "kitchen", "bedroom", "bathroom"} <= {room.kind for room in home.rooms}
    assert len(found) >= 90
    assert len(rich) >= 25
    assert {"bed", "sofa", "toilet", "washbasin", "sink", "oven", "fridge", "switch"} <= {*map(kind_of, found)}


@each_home
def test_budget(size, seed):
    home = house(size, seed)
    assert sum(len(p.faces) for p in home.parts) <= TRIANGLES[size]
    assert len({id(p.material) for p in home.parts}) <= 110
    assert len({p.name for p in home.parts}) == len(home.parts)


@each_home
def test_arrays_are_sound(size, seed):
    for part in house(size, seed).parts:
        assert part.vertices.dtype == np.float32
        assert part.faces.dtype == np.int32
        assert np.isfinite(part.vertices).all()
        assert part.faces.min() >= 0
        assert part.faces.max() < len(part.vertices)
        assert (part.uv is None) == (part.material.texture is None)
        if part.uv is not None:
            assert part.uv.shape == (len(part.vertices), 2)
            assert np.isfinite(part.uv).all()


@each_home
def test_furniture_is_closed_and_faces_outward(size, seed):
    for parts in pieces(house(size, seed)).values():
        for part in parts:
            if part.name.split("/")[1] not in OPEN_SHEETS:
                assert_closed_outward(part)


def assert_closed_outward(part: Part) -> None:
    """Every edge has a twin in the opposite direction, and each connected solid has positive volume."""
    _, weld = np.unique(part.vertices.round(5), axis=0, return_inverse=True)
    faces = weld.reshape(-1)[part.faces]
    kept = (faces != np.roll(faces, 1, axis=1)).all(axis=1)  # slivers that welding closes
    corners = part.vertices[part.faces[kept]].astype(np.float64)
    faces = faces[kept]
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    forward, backward = (sorted(map(tuple, e.tolist())) for e in (edges, edges[:, ::-1]))
    assert forward == backward, part.name
    corners -= corners.mean(axis=(0, 1))
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    labels = connected(faces)
    assert (np.bincount(labels, volume) > 0).all(), part.name


def connected(faces: np.ndarray) -> np.ndarray:
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    pairs = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]])
    graph = coo_array((np.ones(len(pairs)), pairs.T), shape=(faces.max() + 1,) * 2)
    _, label = connected_components(graph, directed=False)
    return np.unique(label[faces[:, 0]], return_inverse=True)[1]


@each_home
def test_room_surfaces_face_into_the_rooms(size, seed):
    home = house(size, seed)
    for part in home.parts:
        kind, component = kind_of(part.name), part.name.split("/")[1]
        if kind in ("floor", "ceiling", "wall") and component in ("plane", "inner"):
            a, b, c = (part.vertices[part.faces[:, k]].astype(np.float64) for k in range(3))
            normals = np.cross(b - a, c - a)
            middle = bounds([part]).mean(axis=0)
            number = int(part.name.split("/")[0].rpartition("_")[2]) - 1
            room = home.rooms[number // 4 if kind == "wall" else number]
            centre = ((room.x_min + room.x_max) / 2, (room.y_min + room.y_max) / 2, 1.25)
            assert (normals @ (centre - middle) > 0).all(), part.name


def share_floor(a: list[Part], b: list[Part]) -> bool:
    """Whether the smallest rectangles around two pieces, seen from above, overlap: doors stand at any angle."""
    one, other = (cv2.minAreaRect(np.concatenate([p.vertices[:, :2] for p in parts])) for parts in (a, b))
    kind, corners = cv2.rotatedRectangleIntersection(one, other)
    return kind != cv2.INTERSECT_NONE and cv2.contourArea(cv2.convexHull(corners)) > 1e-4


@each_home
def test_furniture_does_not_intersect(size, seed):
    """Chairs may be pushed under tables and desks; rugs lie under everything; tiles end behind taps."""
    found = {name: parts for name, parts in pieces(house(size, seed)).items() if kind_of(name) != "rug"}
    boxes = {name: bounds(parts) for name, parts in found.items()}
    meant = [{"chair", "table"}, {"office_chair", "desk"}, {"backsplash", "sink"}, {"backsplash", "oven"}]
    clashes = [
        (a, b)
        for a, b in combinations(boxes, 2)
        if overlap(boxes[a], boxes[b])
        and {kind_of(a), kind_of(b)} not in meant
        and ("door" not in {kind_of(a), kind_of(b)} or share_floor(found[a], found[b]))
    ]
    assert clashes == []


@each_home
def test_furniture_is_inside_one_room(size, seed):
    home = house(size, seed)
    for name, parts in pieces(home).items():
        low, high = bounds(parts)
        assert low[2] > -1e-3, name
        assert any(
            low[0] >= r.x_min - 2e-3
            and low[1] >= r.y_min - 2e-3
            and high[0] <= r.x_max + 2e-3
            and high[1] <= r.y_max + 2e-3
            for r in home.rooms
        ), name


@each_home
def test_only_its_own_door_stands_before_a_doorway(size, seed):
    """Nothing else within 0.8 m of a doorway on either side, over its clear width."""
    home = house(size, seed)
    furniture = {n: bounds(p) for n, p in pieces(home).items() if kind_of(n) not in ("rug", "door")}
    for part in home.parts:
        if kind_of(part.name) == "doorway":
            low, high = bounds([part])
            across = int(np.argmin((high - low)[:2]))
            zone = np.array([low, [*high[:2], 2.0]])
            zone[:, 1 - across] += (0.09, -0.09)
            zone[:, across] = zone[:, across].mean() + np.array([-0.8, 0.8])
            assert [name for name, box in furniture.items() if overlap(box, zone)] == []


def test_doors_stand_at_many_angles_and_none_is_shut():
    angles = []
    for size, seed in HOMES:
        for part in house(size, seed).parts:
            if kind_of(part.name) == "door" and part.name.endswith("/leaf"):
                (_, _), _, turn = cv2.minAreaRect(np.ascontiguousarray(part.vertices[:, :2]))
                angles.append(round(turn % 90.0))
    assert len(angles) >= 12
    assert len(set(angles)) >= 8


@each_home
def test_a_wide_robot_reaches_every_room(size, seed):
    """Routes of 0.7 m: a disc of radius 0.35 m, less a cell that it may be off, gets from every room to the others."""
    home = house(size, seed)
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


@each_home
def test_daylight_comes_in_through_every_window(size, seed):
    home = house(size, seed)
    panes = [bounds([p]) for p in home.parts if kind_of(p.name) == "window" and p.name.endswith("/view")]
    assert len(home.windows) == len(panes) >= 4
    for window, (low, high) in zip(home.windows, panes, strict=True):
        inward = np.cross(window.half_u, window.half_v)
        inward /= np.linalg.norm(inward)
        ahead = window.centre + 0.5 * inward
        assert any(r.x_min < ahead[0] < r.x_max and r.y_min < ahead[1] < r.y_max for r in home.rooms)
        assert np.abs(inward @ (np.array(window.centre) - (low + high) / 2)) == pytest.approx(0.06, abs=0.01)
        for u, v in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
            corner = np.array(window.centre) + u * np.array(window.half_u) + v * np.array(window.half_v)
            assert (corner > low - 0.08).all()
            assert (corner < high + 0.08).all()


@each_home
def test_lamps_hang_free_in_every_room(size, seed):
    home = house(size, seed)
    for room in home.rooms:
        assert any(
            room.x_min < lamp.position[0] < room.x_max and room.y_min < lamp.position[1] < room.y_max
            for lamp in home.lamps
        )
    boxes = [bounds([p]) for p in home.parts if p.name.split("/")[0].startswith("ceiling_lamp")]
    for lamp in home.lamps:
        assert 1.9 < lamp.position[2] < 2.4
        assert not any(((box[0] < lamp.position) & (lamp.position < box[1])).all() for box in boxes)


@cache
def palette_textures() -> dict[str, np.ndarray]:
    palette = make_palette(np.random.default_rng(0), number_of_pictures=4)
    values = [getattr(palette, field.name) for field in fields(palette)]
    finishes = [f for value in values for f in (value if isinstance(value, tuple) else (value,))]
    return {f.material.name: f.material.texture for f in finishes if f.material.texture is not None}


def test_textures_have_contrast_where_they_should():
    textures = palette_textures()
    deviation = {name: float(t.astype(np.float64).mean(axis=2).std()) for name, t in textures.items()}
    assert all(t.dtype == np.uint8 and t.ndim == 3 and max(t.shape) <= 512 for t in textures.values())
    assert all(value < 9 for name, value in deviation.items() if name == "paint")
    assert all(value > 20 for name, value in deviation.items() if name.startswith("picture") or name == "books")
    assert deviation["wood floor"] > 12


def test_floor_textures_tile_without_a_seam():
    for name in ("wood floor", "carpet", "oak", "flowered paper", "striped paper", "lozenge paper", "ceiling"):
        texture = palette_textures()[name].astype(float)
        inside = np.abs(np.diff(texture, axis=1)).mean()
        assert np.abs(texture[:, 0] - texture[:, -1]).mean() < 4 * inside + 4


def test_no_picture_hangs_twice():
    for size, seed in HOMES:
        shown = [
            p.material.name
            for p in house(size, seed).parts
            if kind_of(p.name) == "picture" and p.name.endswith("/picture")
        ]
        assert len(shown) == len(set(shown))


def test_same_seed_same_house_in_another_process():
    code = (
        "import runpy, sys; from slamgym.scenes.procedural import HomeOptions, furnished_house;"
        "print(runpy.run_path(sys.argv[1])['digest'](furnished_house('home', 2, HomeOptions())))"
    )
    other = subprocess.run(
        [sys.executable, "-c", code, __file__], capture_output=True, text=True, check=True, timeout=60
    ).stdout.strip()
    assert digest(furnished_house("home", 2, HomeOptions())) == digest(house("medium", 2)) == other


def test_seeds_and_sizes_differ():
    assert len({digest(house(size, seed)) for size, seed in HOMES}) == len(HOMES)


MAIN = {
    "bed",
    "sofa",
    "tv_bench",
    "wardrobe",
    "table",
    "chair",
    "desk",
    "bookshelf",
    "fridge",
    "oven",
    "toilet",
    "door",
}


def main_furniture(home: House) -> dict[str, np.ndarray]:
    return {name: bounds(parts) for name, parts in pieces(home).items() if kind_of(name) in MAIN}


def test_clutter_and_texture_leave_plan_and_main_furniture_alone():
    plain, usual, rich = (house(clutter=share, texture=share) for share in (0.0, 1.0, 2.0))
    assert plain.rooms == usual.rooms == rich.rooms
    assert plain.windows == usual.windows == rich.windows
    expected = main_furniture(usual)
    for other in (plain, rich):
        found = main_furniture(other)
        assert found.keys() == expected.keys()
        for name, box in expected.items():
            np.testing.assert_array_equal(found[name], box)


def test_more_clutter_is_more_things():
    numbers = [len(pieces(house(clutter=clutter, texture=clutter))) for clutter in (0.0, 1.0, 2.0)]
    assert numbers[0] + 20 < numbers[1] < numbers[2] - 10


def test_richer_texture_has_more_contrast_and_more_pictures():
    def contrast(home: House) -> float:
        walls = [p for p in home.parts if kind_of(p.name) == "wall" and p.name.endswith("/inner")]
        papers = [p.material.texture for p in walls if p.material.texture is not None]
        return float(np.mean([paper.std(axis=(0, 1)).mean() for paper in papers]))

    def pictures(home: House) -> int:
        return sum(kind_of(name) == "picture" for name in pieces(home))

    plain, usual, rich = (house(clutter=richness, texture=richness) for richness in (0.0, 1.0, 2.0))
    assert 2.0 * contrast(plain) < contrast(usual) < 0.7 * contrast(rich)
    assert pictures(plain) < pictures(usual)


def test_negative_seed_is_refused():
    with pytest.raises(SceneError, match="expected a seed of 0 or more, got -1"):
        Procedural.load(-1, HomeOptions())


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"size": "larg"}, "did you mean 'large'"),
        ({"clutter": 2.5}, "'clutter'.*less than or equal to 2, got 2.5"),
        ({"texture": -1}, "'texture'.*greater than or equal to 0, got -1"),
        ({"rooms": 3}, "rooms"),
    ],
)
def test_bad_options_are_refused(options, message):
    with pytest.raises(ConfigError, match=message):
        Procedural.Options.checked(options)


def assert_drivable(home: House, size: str, seed: int) -> None:
    grid = occupancy_grid(home, 0.9)
    path = plan_path(grid, free_space(grid, 0.25), 10.0, np.random.default_rng(seed))
    assert path.length_m > 10.0 - 1e-6
    assert sum(len(part.faces) for part in home.parts) <= TRIANGLES[size]


@each_home
def test_drivable(size, seed):
    assert_drivable(house(size, seed), size, seed)


@pytest.mark.slow
@pytest.mark.parametrize(("size", "first"), [("small", 0), ("medium", 50), ("large", 150)])
def test_two_hundred_drivable_homes(size, first):
    for seed in range(first, first + {"small": 50, "medium": 100, "large": 50}[size]):
        assert_drivable(furnished_house(f"procedural:{seed}", seed, HomeOptions(size=size)), size, seed)


@pytest.mark.seeds
@pytest.mark.parametrize("first", range(0, 1000, 100))
def test_a_thousand_drivable_homes(first):
    for seed in range(first, first + 100):
        assert_drivable(furnished_house(f"procedural:{seed}", seed, HomeOptions()), "medium", seed)


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
