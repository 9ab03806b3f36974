from dataclasses import replace
from typing import cast

import numpy as np
import pytest
import trimesh

from slamgym.scenes.house import Lamp, Material, Part, Window
from slamgym.scenes.light.direct import PANE, Lights, direct_light, lights_of
from slamgym.scenes.light.rays import Rays, rays_of
from slamgym.types import BoolArray, FloatArray

WHITE_LAMP = Lamp((0.0, 0.0, 2.0), colour=(1.0, 1.0, 1.0), radius=0.01)
NORTH = Window((0.0, 0.0, 1.5), (0.6, 0.0, 0.0), (0.0, 0.0, 0.5), colour=(1.0, 1.0, 1.0))
"""1.2 m wide and 1 m high; its light comes in towards -y."""


def box(name: str, low: tuple[float, ...], high: tuple[float, ...]) -> Part:
    mesh = trimesh.creation.box(bounds=[low, high])
    return Part(name, Material("grey"), np.asarray(mesh.vertices, np.float32), np.asarray(mesh.faces, np.int32))


def light_at(lights: Lights, point: tuple[float, ...], normal: tuple[float, ...]) -> float:
    return float(direct_light(np.array([point]), np.array([normal]), lights)[0].mean())


@pytest.mark.parametrize("distance", [0.8, 2.0, 4.0])
def test_a_lamp_follows_the_inverse_square(distance: float) -> None:
    lights = lights_of([], [WHITE_LAMP], [])
    assert light_at(lights, (distance, 0.0, 2.0), (-1, 0, 0)) == pytest.approx(4.0 / distance**2, rel=0.01)


def test_a_lamp_follows_the_cosine_law_and_lights_no_backs() -> None:
    lights = lights_of([], [WHITE_LAMP], [])
    tilted = (-np.cos(np.pi / 3), np.sin(np.pi / 3), 0.0)
    assert light_at(lights, (2.0, 0.0, 2.0), tilted) == pytest.approx(0.5, rel=0.01)
    assert light_at(lights, (2.0, 0.0, 2.0), (1, 0, 0)) == 0.0


def test_light_adds_up_and_takes_the_lamps_colours() -> None:
    lamps = [Lamp((0.0, 0.0, 2.0), colour=(1.0, 0.5, 0.0)), Lamp((0.0, 0.0, 2.0), 2.0, colour=(0.0, 0.5, 1.0))]
    light = direct_light(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), lights_of([], lamps, []))
    np.testing.assert_allclose(light, [[1.0, 1.5, 2.0]], rtol=0.02)


def test_a_round_lamp_has_a_soft_shadow_of_the_right_width() -> None:
    """A plate's edge above x = 0 at half height under a sphere of radius 0.2: full shade from x = 0.2, none to -0.2."""
    lamp = Lamp((0.0, 0.0, 2.0), colour=(1.0, 1.0, 1.0), radius=0.2)
    shaded, free = lights_of([box("plate", (0.0, -5.0, 1.0), (5.0, 5.0, 1.001))], [lamp], []), lights_of([], [lamp], [])
    x = np.array([-0.25, 0.0, 0.25])
    points, normals = np.stack([x, 0.0 * x, 0.0 * x], axis=1), np.tile([0.0, 0.0, 1.0], (3, 1))
    ratio = direct_light(points, normals, shaded)[:, 0] / direct_light(points, normals, free)[:, 0]
    assert ratio == pytest.approx([1.0, 0.5, 0.0], abs=0.13)


@pytest.mark.parametrize("distance", [0.5, 1.0, 2.0, 4.0])
def test_a_window_lights_a_wall_by_its_form_factor(distance: float) -> None:
    """Form factor from an element to a parallel rectangle whose corner is right opposite, four times."""
    x, y = 0.6 / distance, 0.5 / distance
    a, b = np.hypot(1.0, x), np.hypot(1.0, y)
    form_factor = 4.0 / (2.0 * np.pi) * (x / a * np.arctan(y / a) + y / b * np.arctan(x / b))
    light = light_at(lights_of([], [], [NORTH]), (0.0, -distance, 1.5), (0, 1, 0))
    assert light == pytest.approx(PANE * form_factor, rel=0.06)


def test_a_window_lights_only_what_is_inside() -> None:
    lights = lights_of([], [], [NORTH])
    assert light_at(lights, (0.0, 1.0, 1.5), (0, -1, 0)) == 0.0
    assert light_at(lights, (0.0, -1.0, 1.5), (0, -1, 0)) == 0.0


def test_right_at_a_window_light_stays_bounded() -> None:
    assert light_at(lights_of([], [], [NORTH]), (0.0, -0.001, 1.5), (0, 1, 0)) <= 1.05 * PANE


def test_walls_and_furniture_block_daylight() -> None:
    wall = box("wall", (-3.0, -1.1, 0.0), (3.0, -1.0, 3.0))
    assert light_at(lights_of([wall], [], [NORTH]), (0.0, -2.0, 1.5), (0, 1, 0)) == 0.0


def test_a_windows_own_parts_and_what_shines_block_no_daylight() -> None:
    frame = box("frame", (-0.7, -0.05, 0.9), (0.7, 0.05, 2.1))
    curtain = box("curtain", (-0.9, -0.22, 0.2), (0.9, -0.2, 2.2))
    bulb = box("bulb", (-1.0, -1.1, 0.0), (1.0, -1.0, 3.0))
    shining = Part("bulb", bulb.material, bulb.vertices, bulb.faces, light=np.ones_like(bulb.vertices))
    free = light_at(lights_of([], [], [NORTH]), (0.0, -2.0, 1.5), (0, 1, 0))
    assert light_at(lights_of([frame, curtain, shining], [], [NORTH]), (0.0, -2.0, 1.5), (0, 1, 0)) == free


def test_a_lamps_fixture_casts_no_shadow_but_a_table_does() -> None:
    shade = box("shade", (-0.1, -0.1, 1.8), (0.1, 0.1, 1.85))
    table = box("table", (-0.5, -0.5, 0.7), (0.5, 0.5, 0.75))
    assert light_at(lights_of([shade], [WHITE_LAMP], []), (0.0, 0.0, 0.0), (0, 0, 1)) == pytest.approx(1.0, rel=0.01)
    assert light_at(lights_of([table], [WHITE_LAMP], []), (0.0, 0.0, 0.0), (0, 0, 1)) == 0.0


class Counted:
    """Rays that count what they are asked."""

    def __init__(self) -> None:
        self.rays, self.asked = rays_of([]), 0

    def blocked(self, origins: FloatArray, directions: FloatArray, distances: FloatArray) -> BoolArray:
        self.asked += len(origins)
        return self.rays.blocked(origins, directions, distances)


def shadow_rays(lamps: list[Lamp], windows: list[Window]) -> int:
    counted = Counted()
    direct_light(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), Lights(lamps, windows, cast("Rays", counted)))
    return counted.asked


def test_lamps_and_windows_too_weak_to_matter_need_no_shadow_rays() -> None:
    weak = Lamp((0.0, 0.0, 30.0), 0.01)
    far = replace(NORTH, centre=(0.0, 500.0, 1.5))
    assert shadow_rays([WHITE_LAMP, weak], [far]) == shadow_rays([WHITE_LAMP], [])
    assert shadow_rays([weak], []) > 0


def test_a_thousand_lamps_cast_few_shadow_rays_each_and_give_the_same_light() -> None:
    rng = np.random.default_rng(0)
    lamps = [Lamp((x, y, 2.0), 0.01) for x, y in rng.uniform(-4.0, 4.0, (1000, 2))]
    assert shadow_rays(lamps, []) <= 1000
    one_by_one = sum(light_at(lights_of([], [lamp], []), (0, 0, 0), (0, 0, 1)) for lamp in lamps)
    assert light_at(lights_of([], lamps, []), (0, 0, 0), (0, 0, 1)) == pytest.approx(one_by_one, rel=0.03)
