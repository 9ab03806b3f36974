"""Surfaces of procedural homes."""

from dataclasses import fields
from functools import cache

import numpy as np

from slamgym.scenes.home.colours import DARKEST
from slamgym.scenes.home.palette import Finish, make_palette
from slamgym.scenes.house import House

WITH_GRAIN = {"wood floor", "oak", "carpet", "sofa", "linen", "curtain", "counter", "striped paper", "kitchen floor"}


@cache
def finishes() -> list[Finish]:
    palette = make_palette(np.random.default_rng(0), number_of_pictures=4)
    values = [getattr(palette, field.name) for field in fields(palette)]
    return [f for value in values for f in (value if isinstance(value, tuple) else (value,))]


def palette_textures() -> dict[str, np.ndarray]:
    return {f.material.name: f.material.texture for f in finishes() if f.material.texture is not None}


def test_textures_have_contrast_where_they_should():
    textures = palette_textures()
    deviation = {name: float(t.astype(np.float64).mean(axis=2).std()) for name, t in textures.items()}
    assert all(t.dtype == np.uint8 and t.ndim == 3 and max(t.shape) <= 512 for t in textures.values())
    assert all(value < 9 for name, value in deviation.items() if name == "paint")
    assert all(value > 20 for name, value in deviation.items() if name.startswith("picture") or name == "books")
    assert all(value > 12 for name, value in deviation.items() if name in WITH_GRAIN)
    assert deviation["books"] > 45


def test_plain_colours_are_never_black_and_paint_is_white():
    plain = [finish.material for finish in finishes() if finish.material.texture is None]
    assert {"black", "dark glass", "soil"} <= {material.name for material in plain}
    assert all(max(material.colour) >= DARKEST for material in plain)
    assert palette_textures()["trim"].mean() > 240
    assert palette_textures()["walnut"].mean() < 100


def test_floor_textures_tile_without_a_seam():
    for name in ("wood floor", "carpet", "oak", "flowered paper", "striped paper", "lozenge paper", "ceiling"):
        texture = palette_textures()[name].astype(float)
        steps = np.abs(np.diff(texture, axis=1)).mean(axis=(0, 2))
        assert np.abs(texture[:, 0] - texture[:, -1]).mean() < 1.3 * steps.max() + 2, name  # boards have joints inside


def test_richer_texture_has_more_contrast_and_more_pictures(house, pieces, kind_of):
    def contrast(home: House) -> float:
        walls = [p for p in home.parts if kind_of(p.name) == "wall" and p.name.endswith("/inner")]
        papers = [p.material.texture for p in walls if p.material.texture is not None]
        return float(np.mean([paper.std(axis=(0, 1)).mean() for paper in papers]))

    def pictures(home: House) -> int:
        return sum(kind_of(name) == "picture" for name in pieces(home))

    plain, usual, rich = (house("small", clutter=richness, texture=richness) for richness in (0.0, 1.0, 2.0))
    assert 2.0 * contrast(plain) < contrast(usual) < 0.7 * contrast(rich)
    assert pictures(plain) < pictures(usual)
