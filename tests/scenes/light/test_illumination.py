import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from slamgym.scenes.house import Lamp, Material, Part
from slamgym.scenes.light.direct import lights_of
from slamgym.scenes.light.illumination import BASE, BASE_ALONE, SKY, Illumination, mean_colour, reflectances
from slamgym.scenes.light.refine import Surface, join, split_creases, subdivide
from slamgym.scenes.light.samples import samples_of
from slamgym.types import FloatArray

HALF_REFLECTED = 0.5 ** (1 / 2.2)


def room(size: float, grey: float = HALF_REFLECTED) -> Part:
    mesh = trimesh.creation.box(extents=[size, size, size])
    return Part(
        "room",
        Material("grey", (grey,) * 3),
        np.asarray(mesh.vertices, np.float32),
        np.asarray(mesh.faces[:, ::-1], np.int32),
    )


def square(name: str, corners: list[tuple[float, ...]], colour: tuple[float, float, float]) -> Part:
    return Part(
        name, Material(name, colour), np.asarray(corners, np.float32), np.asarray([[0, 1, 2], [0, 2, 3]], np.int32)
    )


def floor(colour: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> Part:
    return square("floor", [(0, -3, 0), (6, -3, 0), (6, 3, 0), (0, 3, 0)], colour)


def light_of(
    parts: list[Part], lamps: tuple[Lamp, ...] = (), shining: tuple[Part, ...] = ()
) -> tuple[Surface, FloatArray]:
    surface = subdivide(join([split_creases(part) for part in parts]), 0.5)
    lit = Illumination(surface, reflectances(surface, parts), shining, lights_of(parts, lamps, []))
    shares: list[float] = []
    light = lit.bounced(samples_of(surface), shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    return surface, light


def at(lit: tuple[Surface, FloatArray], place: tuple[float, ...]) -> FloatArray:
    surface, light = lit
    result: FloatArray = light[np.linalg.norm(surface.vertices - place, axis=1).argmin()]
    return result


def test_an_open_floor_has_the_whole_sky() -> None:
    assert at(light_of([floor()]), (3.0, 0.0, 0.0)) == pytest.approx(BASE_ALONE + SKY, rel=1e-6)


def test_light_is_thrown_to_and_fro_in_a_closed_room() -> None:
    """In a large room of reflectance 1/2 the light grows by 1 + 1/2 + 1/4 + 1/8."""
    assert at(light_of([room(8.0)]), (0.0, 0.0, -4.0)) == pytest.approx(1.875 * BASE_ALONE, rel=0.05)


def test_corners_get_less_light_than_the_middle() -> None:
    lit = light_of([room(4.0)])
    assert at(lit, (2.0, 2.0, 2.0)).mean() < at(lit, (0.0, 2.0, 2.0)).mean() < 0.9 * at(lit, (0.0, 0.0, 2.0)).mean()


def test_a_red_wall_colours_the_white_floor_beside_it() -> None:
    wall = square("wall", [(0, 3, 0), (0, -3, 0), (0, -3, 3), (0, 3, 3)], (1.0, 0.1, 0.1))
    lit = light_of([floor(), wall], (Lamp((3.0, 0.0, 2.0), colour=(1.0, 1.0, 1.0)),))
    near, far = at(lit, (0.5, 0.0, 0.0)), at(lit, (6.0, 0.0, 0.0))
    assert near[0] > 1.1 * near[2]
    assert far[0] == pytest.approx(far[2], rel=0.05)


def test_lamps_stand_for_the_bulbs_that_shine_in_them() -> None:
    bulb = Part("bulb", Material("white"), *_ball((0.0, 0.0, 1.5)), light=np.ones((12, 3), np.float32))
    lamp = (Lamp((0.0, 0.0, 1.5), colour=(1.0, 1.0, 1.0)),)
    with_bulb, without = (at(light_of([room(4.0)], lamp, shining), (0.0, 0.0, -2.0)) for shining in ((bulb,), ()))
    assert with_bulb == pytest.approx(without, rel=0.05)
    assert without.mean() > 4.0 / 3.5**2 + BASE


def _ball(centre: tuple[float, ...]) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    mesh = trimesh.creation.icosahedron()
    return np.asarray(mesh.vertices * 0.1 + centre, np.float32), np.asarray(mesh.faces, np.int32)


def test_under_furniture_the_floor_takes_the_light_beside_it() -> None:
    """Points of the floor inside a box that stands on it are not black: a part of their faces is in view."""
    chest = trimesh.creation.box(bounds=[(2.0, -1.0, -0.01), (4.0, 1.0, 1.0)])
    part = Part(
        "chest",
        Material("grey", (0.5, 0.5, 0.5)),
        np.asarray(chest.vertices, np.float32),
        np.asarray(chest.faces, np.int32),
    )
    lit = light_of([floor(), part])
    assert at(lit, (3.0, 0.0, 0.0)).mean() > 0.5 * at(lit, (1.5, 0.0, 0.0)).mean()


def test_points_inside_a_closed_box_are_buried_and_others_are_not() -> None:
    chest = trimesh.creation.box(bounds=[(2.0, -1.0, -0.01), (4.0, 1.0, 1.0)])
    part = Part("chest", Material("grey"), np.asarray(chest.vertices, np.float32), np.asarray(chest.faces, np.int32))
    parts = [floor(), part]
    surface = subdivide(join([split_creases(one) for one in parts]), 0.5)
    lit = Illumination(surface, reflectances(surface, parts), (), lights_of(parts, (), []))
    samples = samples_of(surface)
    buried = lit.light(samples, lambda _: None)[1]
    x, y, z = samples.points.T
    inside = (np.abs(x - 3.0) < 0.9) & (np.abs(y) < 0.9) & (z < 0.1) & (z > 0.0)
    assert inside.any()
    assert buried[inside].all()
    assert not buried[(x < 1.5) | (z > 1.0)].any()


def test_a_materials_mean_colour_is_linear_and_takes_its_texture() -> None:
    texture = np.zeros((2, 2, 3), np.uint8)
    texture[0] = 255
    assert mean_colour(Material("checked", (1.0, 0.5, 0.0), texture)) == pytest.approx([0.5, 0.5 * 0.5**2.2, 0.0])


def test_vertex_colours_count_as_the_materials() -> None:
    colours = np.tile(np.asarray([1.0, 0.5, 0.0], np.float32), (4, 1))
    part = floor()
    coloured = Part(part.name, part.material, part.vertices, part.faces, colour=colours)
    expected = [[0.85, 0.5**2.2, 0.0]] * 2
    assert reflectances(join([coloured]), [coloured]) == pytest.approx(np.array(expected), rel=1e-5)
