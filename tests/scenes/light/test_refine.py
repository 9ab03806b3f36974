from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from slamgym.scenes.house import Material, Part
from slamgym.scenes.light.refine import (
    Surface,
    affordable_edge,
    cut,
    edge_lengths,
    face_normals,
    join,
    separate,
    split_creases,
    strongest_edges,
    subdivide,
)
from slamgym.types import FloatArray

QUADS = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]], np.int32)


def box(size: tuple[float, ...]) -> Part:
    corners = np.array(np.meshgrid(*([0.0, s] for s in size), indexing="ij"), np.float32).reshape(3, 8).T
    return Part("box", Material("m"), corners, np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]]))


def square(x: float, uv: bool = False) -> Part:
    """A square of 1 m from (x, 0) to (x + 1, 1) on the floor."""
    vertices = np.array([[x, 0, 0], [x + 1, 0, 0], [x + 1, 1, 0], [x, 1, 0]], np.float32)
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    return Part("square", Material("m"), vertices, faces, _affine(vertices) if uv else None)


def _affine(vertices: NDArray[np.float32]) -> NDArray[np.float32]:
    uv: NDArray[np.float32] = (vertices @ np.array([[1.0, 0.5], [-0.3, 2.0], [0.7, 0.1]]) + 0.25).astype(np.float32)
    return uv


def area(surface: Surface) -> float:
    return float(np.linalg.norm(face_normals(surface.vertices, surface.faces), axis=1).sum() / 2)


def edge_use(surface: Surface) -> NDArray[np.intp]:
    """How many faces share each edge, vertices at one place counted as one."""
    _, welded = np.unique(surface.vertices, axis=0, return_inverse=True)
    edges = np.sort(welded.reshape(-1)[surface.faces][:, ((0, 1), (1, 2), (2, 0))], axis=2).reshape(-1, 2)
    return np.unique(edges, axis=0, return_counts=True)[1]


def test_hard_edges_are_split_and_smooth_ones_are_not() -> None:
    assert len(split_creases(box((1, 1, 1))).vertices) == 24
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    vertices = np.concatenate([np.c_[ring, np.zeros(24)], np.c_[ring, np.ones(24)]]).astype(np.float32)
    a, b = np.arange(24), np.roll(np.arange(24), -1)
    sides = np.concatenate([np.stack([a, b, b + 24], axis=1), np.stack([a, b + 24, a + 24], axis=1)])
    cap = np.stack([np.full(22, 24), 24 + np.arange(1, 23), 24 + np.arange(2, 24)], axis=1)
    tube = Part("tube", Material("m"), vertices, np.concatenate([sides, cap]).astype(np.int32))
    assert len(split_creases(tube).vertices) == 48 + 24


@given(st.tuples(*[st.floats(0.05, 3.0)] * 3), st.floats(0.2, 1.0))
@settings(max_examples=25, deadline=None)
def test_subdividing_keeps_the_surface_closed(size: tuple[float, float, float], max_edge: float) -> None:
    coarse = join([split_creases(box(size))])
    fine = subdivide(coarse, max_edge)
    assert edge_lengths(fine).max() <= max_edge * 1.0001
    assert (edge_use(fine) == 2).all()
    assert area(fine) == pytest.approx(area(coarse), rel=1e-5)
    outwards = fine.vertices[fine.faces].mean(axis=1) - np.array(size) / 2
    assert (np.einsum("ni,ni->n", face_normals(fine.vertices, fine.faces), outwards) > 0).all()


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=25, deadline=None)
def test_cutting_any_edges_opens_no_crack(seed: int) -> None:
    surface = subdivide(join([split_creases(box((1, 2, 3)))]), 1.0)
    rng = np.random.default_rng(seed)
    for _ in range(3):
        strength = np.maximum(rng.normal(size=surface.faces.shape), 0.0)
        surface, _ = cut(surface, strongest_edges(surface, strength, 1000))
    assert (edge_use(surface) == 2).all()
    assert area(surface) == pytest.approx(22.0, rel=1e-5)


def test_a_wide_field_is_cut_no_finer_than_memory_allows() -> None:
    assert affordable_edge(join([square(0.0)]), 0.5, 100_000) == 0.5
    small = square(0.0)
    field = join([replace(small, vertices=small.vertices * np.float32(1000.0))])
    edge = affordable_edge(field, 0.5, 100_000)
    assert 5_000 < len(subdivide(field, edge).faces) <= 100_000


def test_neighbouring_parts_are_cut_alike() -> None:
    surface = join([square(0.0), square(1.0)])
    strength = np.zeros((4, 3))
    strength[0, 1] = 1.0  # the side x = 1 of the first square, where the second one begins
    edges = strongest_edges(surface, strength, 100)
    assert edges.sum() == 2
    finer, between = cut(surface, edges)
    assert len(finer.faces) == 6
    np.testing.assert_allclose(finer.vertices[8:], [[1.0, 0.5, 0.0]] * 2)
    np.testing.assert_allclose(surface.vertices[between].mean(axis=1), finer.vertices[8:])


def test_the_strongest_edges_come_first_and_add_no_more_faces_than_asked() -> None:
    surface = subdivide(join([square(0.0)]), 0.3)
    strength = np.random.default_rng(0).uniform(0.1, 1.0, surface.faces.shape)
    edges = strongest_edges(surface, strength, 10)
    assert 9 <= edges.sum() <= 10
    assert len(cut(surface, edges)[0].faces) == len(surface.faces) + edges.sum()
    assert strength[edges].max() == strength.max()


def test_parts_come_back_from_the_surface_with_interpolated_values() -> None:
    ramp = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
    parts = [square(0.0, uv=True), square(3.0)]
    parts[1] = Part("ramp", Material("m"), parts[1].vertices, parts[1].faces, colour=ramp)
    fine = subdivide(join(parts), 0.3)
    light: FloatArray = fine.vertices.astype(np.float64)
    first, second = separate(fine, parts, light.astype(np.float32))
    assert first.uv is not None
    assert second.colour is not None
    assert first.colour is None
    assert second.uv is None
    assert len(first.vertices) == len(second.vertices) > 20
    np.testing.assert_allclose(first.uv, _affine(first.vertices), atol=1e-5)
    np.testing.assert_allclose(second.colour[:, :2], second.vertices[:, :2] - [3.0, 0.0], atol=1e-5)
    assert first.light is not None
    np.testing.assert_array_equal(first.light, first.vertices)
    np.testing.assert_allclose(np.unique(second.faces), np.arange(len(second.vertices)))
