"""A hall that loads in no time: papered walls, and light only in its western half. Loaded by name."""

from typing import Annotated

import numpy as np
from pydantic import Field

from slamgym.scenes.house import House, Material, Part
from slamgym.scenes.loader import SceneOptions

LENGTH, WIDTH, HEIGHT = 7.0, 3.0, 2.4


class HallOptions(SceneOptions):
    texture: Annotated[float, Field(ge=0.0, le=2.0)] = 1.0


class Hall:
    Options = HallOptions
    suffixes = ()

    @staticmethod
    def load(source, options):
        pattern = np.random.default_rng(source).normal(0.0, 20.0 * options.texture, (256, 256, 1))
        paper = np.clip(np.kron(110 + pattern, np.ones((2, 2, 3))), 0, 255).astype(np.uint8)
        floor = Part("floor", Material("floor", texture=paper), *quad((0, 0), (LENGTH, 0), (0, WIDTH)))
        return House("hall", (floor, *walls(Material("lit", texture=paper), Material("dark", (0.3,) * 3, paper))))


def walls(lit, dark):
    middle = LENGTH / 2
    for name, material, (x, y), (dx, dy) in [
        ("south", lit, (0, 0), (middle, 0)),
        ("south", dark, (middle, 0), (middle, 0)),
        ("east", dark, (LENGTH, 0), (0, WIDTH)),
        ("north", dark, (LENGTH, WIDTH), (-middle, 0)),
        ("north", lit, (middle, WIDTH), (-middle, 0)),
        ("west", lit, (0, WIDTH), (0, -WIDTH)),
    ]:
        yield Part(name, material, *quad((x, y), (dx, dy, 0), (0, 0, HEIGHT)))


def quad(corner, along, up):
    """Vertices, faces and uv of a rectangle that is seen from both sides."""
    a, u, v = (np.pad(np.asarray(p, float), (0, 3 - len(p))) for p in (corner, along, up))
    vertices = np.array([a, a + u, a + u + v, a + v], np.float32)
    width, height = np.linalg.norm(u), np.linalg.norm(v)
    uv = np.array([(0, 0), (width, 0), (width, height), (0, height)], np.float32) / 8.0  # nothing repeats
    return vertices, np.array([(0, 1, 2), (0, 2, 3), (0, 2, 1), (0, 3, 2)], np.int32), uv
