from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from slamgym.scenes.house import House, Lamp, Material, Part
from slamgym.scenes.light import MAX_EDGE_M, bake_light
from slamgym.scenes.refine import face_normals, split_creases, subdivide
from slamgym.types import FloatArray

GREY = Material("grey", (0.7, 0.7, 0.7))
QUADS = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]], np.int32)
LAMP = Lamp((0.0, 0.0, 2.3), colour=(1.0, 1.0, 1.0))


def box(name: str, low: tuple[float, ...], high: tuple[float, ...], inside_out: bool = False) -> Part:
    """A box of 8 vertices; seen from inside when it is a room."""
    corners = np.array(np.meshgrid(*zip(low, high, strict=True), indexing="ij"), np.float32).reshape(3, 8).T
    faces = np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])
    return Part(name, GREY, corners, faces[:, ::-1] if inside_out else faces)


def room(*parts: Part, lamps: tuple[Lamp, ...] = (LAMP,)) -> House:
    return House("room", (box("room", (-2, -2, 0), (2, 2, 2.5), inside_out=True), *parts), lamps=lamps)


def brightness(part: Part, place: tuple[float, float, float], normal: tuple[float, float, float]) -> float:
    """Light of the vertex nearest to the place among those whose faces look along the normal."""
    assert part.light is not None
    normals = face_normals(part.vertices, part.faces)
    looking = normals @ normal > 0.9 * np.linalg.norm(normals, axis=1)
    vertices = np.unique(part.faces[looking])
    nearest = vertices[np.linalg.norm(part.vertices[vertices] - place, axis=1).argmin()]
    return float(part.light[nearest].mean())


def up(part: Part, x: float, y: float) -> float:
    return brightness(part, (x, y, 0.0), (0, 0, 1))


def area(part: Part) -> float:
    return float(np.linalg.norm(face_normals(part.vertices, part.faces), axis=1).sum() / 2)


def edge_use(part: Part) -> NDArray[np.intp]:
    """How many faces share each edge, vertices at one place counted as one."""
    _, welded = np.unique(part.vertices, axis=0, return_inverse=True)
    edges = np.sort(welded.reshape(-1)[part.faces][:, ((0, 1), (1, 2), (2, 0))], axis=2).reshape(-1, 2)
    return np.unique(edges, axis=0, return_counts=True)[1]


def test_every_vertex_is_lit_and_baking_is_repeatable() -> None:
    first, again = (
        bake_light(room(box("box", (0.5, 0.5, 0), (1, 1, 0.8)))),
        bake_light(room(box("box", (0.5, 0.5, 0), (1, 1, 0.8)))),
    )
    for part, twin in zip(first.parts, again.parts, strict=True):
        assert part.light is not None
        assert twin.light is not None
        assert part.light.dtype == np.float32
        assert part.light.shape == part.vertices.shape
        assert part.light.min() >= 0.25
        assert part.light.max() <= 1.1
        assert (part.light == twin.light).all()


def test_surfaces_facing_the_lamp_are_brighter() -> None:
    house = bake_light(room(box("box", (0.8, -0.3, 0), (1.4, 0.3, 1.0))))
    lit = brightness(house.parts[1], (0.8, 0.0, 0.7), (-1, 0, 0))
    unlit = brightness(house.parts[1], (1.4, 0.0, 0.7), (1, 0, 0))
    assert lit > 1.3 * unlit


def test_a_table_throws_a_shadow() -> None:
    lit, shaded = (
        bake_light(room()).parts[0],
        bake_light(room(box("table", (-0.5, -0.5, 0.7), (0.5, 0.5, 0.75)))).parts[0],
    )
    assert up(shaded, 0.0, 0.0) < 0.75 * up(lit, 0.0, 0.0)
    assert up(shaded, 1.2, 1.2) == pytest.approx(up(lit, 1.2, 1.2), rel=0.1)


def test_light_falls_off_and_takes_the_lamps_colour() -> None:
    house = bake_light(room(lamps=(Lamp((-1.5, 0.0, 1.2), colour=(1.0, 0.5, 0.2)),)))
    near, far = (brightness(house.parts[0], (x, 0.0, 1.2), (-np.sign(x), 0, 0)) for x in (-2.0, 2.0))
    assert near > 1.3 * far
    light = house.parts[0].light
    assert light is not None
    assert (light[:, 0] >= light[:, 2]).all()
    assert light[:, 0].mean() > 1.1 * light[:, 2].mean()


def test_corners_are_darker_but_seams_are_not_black() -> None:
    floor = bake_light(room(lamps=())).parts[0]
    middle, wall, corner = up(floor, 0.0, 0.0), up(floor, 2.0, 0.0), up(floor, 2.0, 2.0)
    assert 0.5 * middle < corner < wall < middle


def test_walls_and_furniture_that_stand_on_the_floor_leave_no_black_fringe() -> None:
    wall = box("wall", (0.0, -2.0, -0.1), (0.1, 2.0, 2.5))
    floor = Part("floor", GREY, *_plane(-2.0, 2.0, 0.1))
    house = bake_light(House("two rooms", (floor, wall), lamps=(Lamp((-1.0, 0.0, 2.3)), Lamp((1.0, 0.0, 2.3)))))
    x, y = house.parts[0].vertices[:, :2].T
    light = house.parts[0].light
    assert light is not None
    under = (x > 0.0) & (x < 0.1) & (np.abs(y) < 1.0)
    beside = (np.abs(x - 0.05) < 0.3) & ~under & (np.abs(y) < 1.0)
    assert under.any()
    assert light[under].min() > 0.9 * light[beside].min()


def _plane(low: float, high: float, step: float) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    ticks = np.arange(low + step / 2, high, step)
    n = len(ticks)
    x, y = np.meshgrid(ticks, ticks, indexing="ij")
    a = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate([np.stack([a, a + n, a + n + 1], axis=1), np.stack([a, a + n + 1, a + 1], axis=1)])
    return np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3).astype(np.float32), faces.astype(np.int32)


def test_a_house_without_lamps_is_not_dark() -> None:
    light = bake_light(room(lamps=())).parts[0].light
    assert light is not None
    assert 0.5 < light.mean() < 0.9


def test_empty_houses_and_parts() -> None:
    nothing = Part("nothing", GREY, np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int32))
    assert bake_light(House("empty", ())).parts == ()
    assert [part.name for part in bake_light(room(nothing)).parts] == ["room"]


def test_degenerate_faces_get_finite_light() -> None:
    part = box("box", (0.5, 0.5, 0.1), (1, 1, 0.8))
    flat = replace(part, faces=np.concatenate([part.faces, np.array([[0, 0, 1], [2, 2, 2]], np.int32)]))
    for baked in bake_light(room(flat)).parts:
        assert baked.light is not None
        assert np.isfinite(baked.light).all()


def test_hard_edges_are_split_and_smooth_ones_are_not() -> None:
    assert len(split_creases(box("box", (0, 0, 0), (1, 1, 1))).vertices) == 24
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    vertices = np.concatenate([np.c_[ring, np.zeros(24)], np.c_[ring, np.ones(24)]]).astype(np.float32)
    a, b = np.arange(24), np.roll(np.arange(24), -1)
    sides = np.concatenate([np.stack([a, b, b + 24], axis=1), np.stack([a, b + 24, a + 24], axis=1)])
    cap = np.stack([np.full(22, 24), 24 + np.arange(1, 23), 24 + np.arange(2, 24)], axis=1)
    tube = Part("tube", GREY, vertices, np.concatenate([sides, cap]).astype(np.int32))
    assert len(split_creases(tube).vertices) == 48 + 24


@given(st.tuples(*[st.floats(0.05, 3.0)] * 3), st.floats(0.2, 1.0))
@settings(max_examples=25, deadline=None)
def test_subdividing_keeps_the_surface_closed(size: tuple[float, float, float], max_edge: float) -> None:
    coarse = split_creases(box("box", (0, 0, 0), size))
    fine = subdivide(coarse, max_edge)
    ends = fine.vertices[fine.faces]
    assert np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=2).max() <= max_edge * 1.0001
    assert (edge_use(fine) == 2).all()
    assert area(fine) == pytest.approx(area(coarse), rel=1e-5)
    outwards = (face_normals(fine.vertices, fine.faces) * (ends.mean(axis=1) - np.array(size) / 2)).sum(axis=1)
    assert (outwards > 0).all()


def test_texture_coordinates_are_interpolated() -> None:
    part = box("box", (0, 0, 0), (2, 1, 1))
    part = replace(part, uv=_affine(part.vertices).astype(np.float32))
    fine = subdivide(part, MAX_EDGE_M)
    assert fine.uv is not None
    assert len(fine.uv) > len(part.vertices)
    np.testing.assert_allclose(fine.uv, _affine(fine.vertices), atol=1e-5)


def _affine(vertices: NDArray[np.float32]) -> FloatArray:
    uv: FloatArray = vertices @ np.array([[1.0, 0.5], [-0.3, 2.0], [0.7, 0.1]]) + 0.25
    return uv


def test_what_shines_keeps_its_light() -> None:
    window = replace(box("window", (-1.9, -0.5, 1), (-1.8, 0.5, 2)), light=np.ones((8, 3), np.float32))
    shining = bake_light(room(window)).parts[1]
    assert np.array_equal(shining.vertices, window.vertices)
    assert shining.light is window.light
