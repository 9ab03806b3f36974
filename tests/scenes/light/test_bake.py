from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from slamgym.errors import SceneError
from slamgym.scenes.house import House, Lamp, Material, Part, Window
from slamgym.scenes.light.bake import MAX_EDGE_M, _smoothed, bake_light
from slamgym.scenes.light.refine import face_normals, join, subdivide
from slamgym.types import FloatArray

GREY = Material("grey", (0.7, 0.7, 0.7))
LAMP = Lamp((0.0, 0.0, 2.3), colour=(1.0, 1.0, 1.0))


def box(name: str, low: tuple[float, ...], high: tuple[float, ...], inside_out: bool = False) -> Part:
    """A box of 8 vertices; seen from inside when it is a room."""
    mesh = trimesh.creation.box(bounds=[low, high])
    return Part(
        name,
        GREY,
        np.asarray(mesh.vertices, np.float32),
        np.asarray(mesh.faces[:, ::-1] if inside_out else mesh.faces, np.int32),
    )


def room(*parts: Part, lamps: tuple[Lamp, ...] = (LAMP,)) -> House:
    return House("room", (box("room", (-2, -2, 0), (2, 2, 2.5), inside_out=True), *parts), lamps=lamps)


def light_of(part: Part) -> NDArray[np.float32]:
    assert part.light is not None
    return part.light


def brightness(part: Part, place: tuple[float, float, float], normal: tuple[float, float, float]) -> float:
    """Light of the vertex nearest to the place among those whose faces look along the normal, or against it."""
    normals = face_normals(part.vertices, part.faces)
    looking = np.abs(normals @ normal) > 0.9 * np.linalg.norm(normals, axis=1)
    vertices = np.unique(part.faces[looking])
    nearest = vertices[np.linalg.norm(part.vertices[vertices] - place, axis=1).argmin()]
    return float(light_of(part)[nearest].mean())


def up(part: Part, x: float, y: float) -> float:
    return brightness(part, (x, y, 0.0), (0, 0, 1))


def floor_vertices(part: Part) -> FloatArray:
    found: FloatArray = part.vertices[part.vertices[:, 2] == 0.0][:, :2].astype(np.float64)
    return found


def test_every_vertex_is_lit_and_baking_is_repeatable() -> None:
    first, again = (bake_light(room(box("box", (0.5, 0.5, 0), (1, 1, 0.8)))) for _ in range(2))
    for part, twin in zip(first.parts, again.parts, strict=True):
        light = light_of(part)
        assert light.dtype == np.float32
        assert light.shape == part.vertices.shape
        assert light.min() >= 0.05
        assert light.max() <= 1.2
        assert (light == twin.light).all()
        assert (part.vertices == twin.vertices).all()


def test_surfaces_facing_the_lamp_are_brighter() -> None:
    house = bake_light(room(box("box", (0.8, -0.3, 0), (1.4, 0.3, 1.0))))
    lit = brightness(house.parts[1], (0.8, 0.0, 0.7), (-1, 0, 0))
    unlit = brightness(house.parts[1], (1.4, 0.0, 0.7), (1, 0, 0))
    assert lit > 1.3 * unlit


def test_a_table_throws_a_shadow_with_an_edge_of_fine_triangles() -> None:
    plain, shaded = (
        bake_light(house).parts[0] for house in (room(), room(box("table", (-0.5, -0.5, 0.7), (0.5, 0.5, 0.75))))
    )
    assert up(shaded, 0.0, 0.0) < 0.75 * up(plain, 0.0, 0.0)
    assert up(shaded, 1.2, 1.2) == pytest.approx(up(plain, 1.2, 1.2), rel=0.1)
    edge = 0.5 * 2.3 / (2.3 - 0.725)  # of the shadow on the floor: the table's half width, seen from the lamp
    x, y = np.abs(floor_vertices(shaded)).T
    around = np.maximum(x, y)
    density = [
        np.count_nonzero(np.abs(around - at) < 0.15) / (8 * at * 0.3) for at in (edge, 1.4)
    ]  # vertices a square metre
    assert density[0] > 3.0 * density[1]


def test_an_evenly_lit_floor_gets_no_more_vertices() -> None:
    floor = Part("floor", GREY, *_plane(-3.0, 3.0, 0.3))
    baked = bake_light(House("floor", (floor,), lamps=(Lamp((0.0, 0.0, 30.0), 200.0),)))
    assert len(baked.parts[0].vertices) == len(floor.vertices)


def test_vertices_added_for_light_open_no_cracks() -> None:
    table = box("table", (-0.5, -0.5, 0.7), (0.5, 0.5, 0.75))
    for part in bake_light(room(table)).parts:
        _, welded = np.unique(part.vertices, axis=0, return_inverse=True)
        edges = np.sort(welded.reshape(-1)[part.faces][:, ((0, 1), (1, 2), (2, 0))], axis=2).reshape(-1, 2)
        assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()


def test_light_falls_off_and_takes_the_lamps_colour() -> None:
    house = bake_light(room(lamps=(Lamp((-1.5, 0.0, 1.2), colour=(1.0, 0.5, 0.2)),)))
    near, far = (brightness(house.parts[0], (x, 0.0, 1.2), (1, 0, 0)) for x in (-2.0, 2.0))
    assert near > 1.3 * far
    light = light_of(house.parts[0])
    assert (light[:, 0] >= light[:, 2]).all()
    assert light[:, 0].mean() > 1.1 * light[:, 2].mean()


def test_corners_are_darker_but_seams_are_not_black() -> None:
    floor = bake_light(room()).parts[0]
    middle, wall, corner = up(floor, 0.0, 0.0), up(floor, 2.0, 0.0), up(floor, 2.0, 2.0)
    assert 0.3 * middle < corner < wall < middle


def test_walls_and_furniture_that_stand_on_the_floor_leave_no_black_fringe() -> None:
    wall = box("wall", (0.0, -2.0, -0.1), (0.1, 2.0, 2.5))
    floor = Part("floor", GREY, *_plane(-2.0, 2.0, 0.1))
    house = bake_light(House("two rooms", (floor, wall), lamps=(Lamp((-1.0, 0.0, 2.3)), Lamp((1.0, 0.0, 2.3)))))
    x, y = house.parts[0].vertices[:, :2].T
    under = (x > 0.0) & (x < 0.1) & (np.abs(y) < 1.0)
    beside = (np.abs(x - 0.05) < 0.3) & ~under & (np.abs(y) < 1.0)
    light = light_of(house.parts[0])
    assert under.any()
    assert light[under].min() > 0.9 * light[beside].min()


def _plane(low: float, high: float, step: float) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    ticks = np.arange(low + step / 2, high, step)
    n = len(ticks)
    x, y = np.meshgrid(ticks, ticks, indexing="ij")
    a = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate([np.stack([a, a + n, a + n + 1], axis=1), np.stack([a, a + n + 1, a + 1], axis=1)])
    return np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3).astype(np.float32), faces.astype(np.int32)


def test_no_light_leaks_through_a_wall() -> None:
    """Two closed rooms, the lamp in one: the other has base light alone."""
    rooms = [box("lit", (-4, -2, 0), (-0.05, 2, 2.5), inside_out=True), box("dark", (0.05, -2, 0), (4, 2, 2.5), True)]
    window = Window((-4.0, 0.0, 1.5), (0.0, 0.6, 0.0), (0.0, 0.0, 0.5))
    lit, dark = bake_light(House("two", tuple(rooms), lamps=(Lamp((-2.0, 0.0, 2.2)),), windows=(window,))).parts
    assert light_of(dark).max() < 0.5 * np.median(light_of(lit))


def test_no_light_leaks_to_what_stands_close_behind_a_thin_wall() -> None:
    """The points where the light of the chest's back is computed lie on its side of the wall, 10 cm away."""
    rooms = [box("lit", (-4, -2, 0), (0, 2, 2.5), True), box("dark", (0.05, -2, 0), (4, 2, 2.5), True)]
    chest = box("chest", (0.1, -1, 0), (1, 1, 1.5))
    lit, _, back = bake_light(House("two", (*rooms, chest), lamps=(Lamp((-1.0, 0.0, 1.2)),))).parts
    assert brightness(back, (0.1, 0.0, 1.0), (1, 0, 0)) < 0.5 * brightness(lit, (0.0, 0.0, 1.0), (1, 0, 0))


def test_a_warm_lamp_comes_out_nearly_white() -> None:
    lamp = replace(LAMP, colour=(1.0, 0.7, 0.4))
    red, _, blue = light_of(bake_light(room(lamps=(lamp,))).parts[0]).mean(axis=0)
    assert 1.05 < red / blue < 1.3


def test_the_edge_of_a_shadow_has_no_steps() -> None:
    """Factors are mixed with their neighbours': a lone bright vertex keeps half of what it stands out."""
    surface = subdivide(join([Part("floor", GREY, *_plane(-1.0, 1.0, 0.2))]), 0.5)
    factors = np.full((len(surface.vertices), 3), 0.2)
    middle = np.linalg.norm(surface.vertices, axis=1).argmin()
    factors[middle] = 1.0
    smoothed = _smoothed(surface, factors)
    np.testing.assert_allclose(smoothed[middle], 0.6)
    assert (smoothed.max(axis=1) > 0.21).sum() == 7  # its six neighbours took some


def test_daylight_falls_off_from_the_window() -> None:
    window = Window((-2.0, 0.0, 1.5), (0.0, 0.6, 0.0), (0.0, 0.0, 0.5))
    lit = bake_light(replace(room(lamps=()), windows=(window,)))
    floor = lit.parts[0]
    assert up(floor, -1.0, 0.0) > 1.1 * up(floor, 0.5, 0.0) > 1.2 * up(floor, 1.9, 0.0)
    assert lit.assumptions == ()


def test_a_house_without_lamps_gets_some_and_says_so() -> None:
    house = replace(room(lamps=()), assumptions=("up axis: z",))
    lit = bake_light(house)
    assert lit.assumptions[0] == "up axis: z"
    assert lit.assumptions[1].startswith("light: no lamps or windows are given")
    assert lit.lamps == ()
    assert 0.4 < light_of(lit.parts[0]).mean() < 0.9


def test_a_garden_changes_neither_the_lamps_nor_the_exposure_indoors() -> None:
    whole = room(lamps=()).parts[0]
    lawn = box("lawn", (-30, -30, -0.3), (30, 30, -0.1))
    alone, beside = (bake_light(House("house", parts)).parts[0] for parts in ((whole,), (whole, lawn)))
    assert light_of(beside).mean() == pytest.approx(light_of(alone).mean(), rel=0.1)


@pytest.mark.parametrize(
    "lights",
    [
        {"lamps": (replace(LAMP, intensity=1e308),)},
        {"windows": (Window((-2.0, 0.0, 1.5), (0.0, 0.6, 0.0), (0.0, 0.0, 0.5), intensity=1e308),)},
    ],
)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_lamps_that_give_no_finite_light_are_an_error(lights: dict[str, Any]) -> None:
    with pytest.raises(SceneError, match=r"expected finite light, .* lamps or windows"):
        bake_light(replace(room(lamps=()), **lights))


def test_a_house_without_a_ceiling_is_not_overexposed() -> None:
    whole = room().parts[0]
    open_above = replace(whole, faces=whole.faces[(whole.vertices[whole.faces][:, :, 2] < 2.0).any(axis=1)])
    light = light_of(bake_light(House("open", (open_above,))).parts[0])
    assert np.percentile(light, 99) < 1.1
    assert 0.4 < light.mean() < 0.95


@pytest.mark.parametrize("share", [1.0, 0.5])
def test_wrong_and_mixed_winding_is_lit_as_the_right_one(share: float) -> None:
    right = room(box("chest", (0.5, 0.5, 0.0), (1.5, 1.0, 0.8)))
    rng = np.random.default_rng(0)
    flips = [rng.random(len(part.faces)) < share for part in right.parts]
    parts = [
        replace(part, faces=np.where(flip[:, None], part.faces[:, ::-1], part.faces))
        for part, flip in zip(right.parts, flips, strict=True)
    ]
    expected, got = bake_light(right), bake_light(replace(right, parts=tuple(parts)))
    for place in ((0.0, 0.0), (-1.5, 1.0), (1.5, -1.5)):
        assert up(got.parts[0], *place) == pytest.approx(up(expected.parts[0], *place), abs=0.03)
    assert brightness(got.parts[1], (1.0, 0.75, 0.8), (0, 0, 1)) == pytest.approx(
        brightness(expected.parts[1], (1.0, 0.75, 0.8), (0, 0, 1)), abs=0.05
    )
    assert (parts[0].faces == np.where(flips[0][:, None], right.parts[0].faces[:, ::-1], right.parts[0].faces)).all()


def test_a_dark_house_is_exposed_longer_than_a_white_one() -> None:
    means = []
    for grey in (0.4, 0.9):
        part = replace(room().parts[0], material=Material("paint", (grey,) * 3))
        means.append(light_of(bake_light(House("room", (part,), lamps=(LAMP,))).parts[0]).mean())
    assert means[0] > 1.3 * means[1]
    assert 0.9 * means[1] == pytest.approx(0.5, abs=0.12)


def test_ten_times_the_light_is_the_same_picture() -> None:
    """Exposure makes up for it, but for the base light."""
    dim, bright = (light_of(bake_light(room(lamps=(replace(LAMP, intensity=k),))).parts[0]).mean() for k in (2.0, 20.0))
    assert dim == pytest.approx(bright, rel=0.1)


def test_empty_houses_and_parts() -> None:
    nothing = Part("nothing", GREY, np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int32))
    assert bake_light(House("empty", ())).parts == ()
    assert [part.name for part in bake_light(room(nothing)).parts] == ["room"]


def test_degenerate_faces_get_finite_light() -> None:
    part = box("box", (0.5, 0.5, 0.1), (1, 1, 0.8))
    flat = replace(part, faces=np.concatenate([part.faces, np.array([[0, 0, 1], [2, 2, 2]], np.int32)]))
    for baked in bake_light(room(flat)).parts:
        assert np.isfinite(light_of(baked)).all()


def test_texture_coordinates_and_colours_are_interpolated() -> None:
    part = room().parts[0]
    uv, colour = part.vertices[:, :2] * np.float32(0.5) + np.float32(0.25), part.vertices / np.float32(5.0) + 0.5
    baked = bake_light(House("room", (replace(part, uv=uv, colour=colour),), lamps=(LAMP,))).parts[0]
    assert baked.uv is not None
    assert baked.colour is not None
    assert len(baked.uv) > 4 * 16 / MAX_EDGE_M**2
    np.testing.assert_allclose(baked.uv, baked.vertices[:, :2] * 0.5 + 0.25, atol=1e-5)
    np.testing.assert_allclose(baked.colour, baked.vertices / 5.0 + 0.5, atol=1e-5)


def test_what_shines_keeps_its_light_and_its_place() -> None:
    pane = replace(box("window", (-1.9, -0.5, 1), (-1.8, 0.5, 2)), light=np.ones((8, 3), np.float32))
    chest = box("chest", (0.5, 0.5, 0.0), (1.5, 1.0, 0.8))
    baked = bake_light(room(pane, chest)).parts
    assert [part.name for part in baked] == ["room", "window", "chest"]
    assert baked[1] is pane
    assert bake_light(House("panes", (pane,))).parts == (pane,)


def test_progress_grows_to_one() -> None:
    shares: list[float] = []
    bake_light(room(box("table", (-0.5, -0.5, 0.7), (0.5, 0.5, 0.75))), shares.append)
    assert shares[0] == 0.0
    assert shares[-1] == 1.0
    assert shares == sorted(shares)
    assert len(shares) > 4


def test_an_interrupt_ends_the_baking() -> None:
    def interrupt(share: float) -> None:
        if share > 0.0:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        bake_light(room(), interrupt)
