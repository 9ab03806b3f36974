"""Light that comes straight from lamps and windows, with soft shadows.

Unit: 1 is what a lamp of intensity 1 gives to a wall 2 m away that faces it.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.spatial.distance import cdist

from slamgym.scenes.house import Lamp, Part, Window
from slamgym.scenes.light.rays import Rays, rays_of, sphere
from slamgym.scenes.light.refine import unit
from slamgym.types import BoolArray, FloatArray, IntArray

LAMP_POINTS = 8
MOST_LAMP_POINTS = 512
"""Of all lamps together: so many lamps give soft shadows with fewer points each."""
AT_1_M = 4.0
"""Light of a lamp of intensity 1 at 1 m."""
NEAREST_M = 0.5
"""Nearer to a lamp its light grows no further."""
FIXTURE_M = 0.3
"""Geometry this close to a lamp is its fixture and casts no shadow."""
PANE = 8.0
"""What a window of intensity 1 would give to a wall right in front of it."""
PANE_CELL_M = 0.3
PANE_CELLS = (2, 5)
"""Least and most points along a side of a window."""
FITTING_M = 0.3
FITTING_BESIDE_M = 1.0
"""What lies wholly so close to a window's plane, and so little beside it, is its frame, pane or curtain."""
NEGLIGIBLE = 0.02
"""Of the light that a point would have without shadows, the share that weak and far lights may be left out with."""


class Lights(NamedTuple):
    """All that lights a house, and the rays against what casts shadows in it."""

    lamps: Sequence[Lamp]
    windows: Sequence[Window]
    rays: Rays


def lights_of(parts: Sequence[Part], lamps: Sequence[Lamp], windows: Sequence[Window]) -> Lights:
    """The lights among the parts. What shines casts no shadow, nor do a window's own parts."""
    casters = [part for part in parts if part.light is None and not any(_fits(part, window) for window in windows)]
    return Lights(lamps, windows, rays_of(casters))


def _fits(part: Part, window: Window) -> bool:
    sides = np.array([window.half_u, window.half_v])
    axes = unit(np.array([*sides, np.cross(*sides)]))
    reach = np.abs((part.vertices - np.asarray(window.centre)) @ axes.T).max(axis=0)
    return bool((reach <= [*(np.linalg.norm(sides, axis=1) + FITTING_BESIDE_M), FITTING_M]).all())


def direct_light(points: FloatArray, normals: FloatArray, lights: Lights) -> FloatArray:
    """Light (N, 3) of all lamps and windows at points (N, 3) with unit normals (N, 3)."""
    total = np.zeros((len(points), 3))
    noticed = _noticed(points, lights)
    count = max(1, min(LAMP_POINTS, MOST_LAMP_POINTS // max(len(lights.lamps), 1)))
    for lamp, near in zip(lights.lamps, noticed[: len(lights.lamps)], strict=True):
        light = _lamp_light(points[near], normals[near], lamp, count, lights.rays)
        total[near] += light[:, None] * np.asarray(lamp.colour)
    for window, near in zip(lights.windows, noticed[len(lights.lamps) :], strict=True):
        light = _window_light(points[near], normals[near], window, lights.rays)
        total[near] += light[:, None] * np.asarray(window.colour)
    return total


def _noticed(points: FloatArray, lights: Lights) -> list[IntArray]:
    """Which of the points (N, 3) each lamp, then each window, may matter to; the others need no shadow rays."""
    lamps, windows = lights.lamps, lights.windows
    sides = np.array([(window.half_u, window.half_v) for window in windows]).reshape(-1, 2, 3)
    areas = 4.0 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    places = np.array([*(lamp.position for lamp in lamps), *(window.centre for window in windows)]).reshape(-1, 3)
    reach = np.array([*(lamp.radius for lamp in lamps), *np.linalg.norm(sides, axis=2).sum(axis=1)])
    panes = [PANE / np.pi * window.intensity * area for window, area in zip(windows, areas, strict=True)]
    power = np.array([*(AT_1_M * lamp.intensity for lamp in lamps), *panes])
    most = power / np.maximum(cdist(points, places) - reach, NEAREST_M) ** 2
    weak = most < NEGLIGIBLE / max(len(power), 1) * most.sum(axis=1, keepdims=True)
    return [np.flatnonzero(near) for near in ~weak.T]  # not `>=`: what is not finite has to show in the light


def _lamp_light(points: FloatArray, normals: FloatArray, lamp: Lamp, count: int, rays: Rays) -> FloatArray:
    """Light (N,) of one lamp: inverse square, cosine law, and shadow rays to so many points of its sphere."""
    total = np.zeros(len(points))
    spread = sphere(count) if count > 1 else np.zeros((1, 3))
    for source in np.asarray(lamp.position) + spread * lamp.radius:
        towards, distance, cosine = _towards(points, normals, source)
        light = lamp.intensity / count * cosine * AT_1_M / np.maximum(distance, NEAREST_M) ** 2
        facing = np.flatnonzero(light > 0.0)
        total[facing] += light[facing] * _free(points, towards, np.maximum(distance - FIXTURE_M, 0.0), facing, rays)
    return total


def _window_light(points: FloatArray, normals: FloatArray, window: Window, rays: Rays) -> FloatArray:
    """Light (N,) of one window, an evenly bright rectangle.

    Each of its cells of area A counts as a disc: cos cos A / (pi d^2 + A), bounded where d is small (Wallace et al.,
    A ray tracing algorithm for progressive radiosity, 1989).
    """
    inwards = unit(np.cross(window.half_u, window.half_v))
    sources, cell = _window_points(window)
    total = np.zeros(len(points))
    for source in sources:
        towards, distance, cosine = _towards(points, normals, source)
        at_window = np.maximum(-towards @ inwards, 0.0)
        light = PANE * window.intensity * cosine * at_window * cell / (np.pi * distance**2 + cell)
        facing = np.flatnonzero(light > 0.0)
        total[facing] += light[facing] * _free(points, towards, distance, facing, rays)
    return total


def _window_points(window: Window) -> tuple[FloatArray, float]:
    """Middles (M, 3) of the cells of a window, and the area of one, square metres."""
    sides = np.array([window.half_u, window.half_v])
    length = 2.0 * np.linalg.norm(sides, axis=1)
    count = np.clip(np.ceil(length / PANE_CELL_M), *PANE_CELLS).astype(int)
    a, b = ((np.arange(n) + 0.5) / n * 2.0 - 1.0 for n in count)
    across = np.stack(np.meshgrid(a, b, indexing="ij"), axis=-1).reshape(-1, 2)
    area = float(np.linalg.norm(np.cross(*(2.0 * sides))))
    return np.asarray(window.centre) + across @ sides, area / len(across)


def _towards(points: FloatArray, normals: FloatArray, source: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Directions (N, 3) to the source, distances (N,), and cosines (N,) to the normals, 0 where it is behind."""
    towards = source - points
    distance = np.linalg.norm(towards, axis=1)
    towards /= np.maximum(distance, 1e-9)[:, None]
    return towards, distance, np.maximum(np.einsum("ni,ni->n", towards, normals), 0.0)


def _free(points: FloatArray, towards: FloatArray, distance: FloatArray, which: IntArray, rays: Rays) -> BoolArray:
    return ~rays.blocked(points[which], towards[which], distance[which])
