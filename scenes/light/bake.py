"""Light baked into vertices with Embree: lamps, daylight, what surfaces throw on each other, and shade in corners.

A frame then costs no lighting at all. There is no randomness: all points share one set of directions, so that flat
surfaces come out smooth, and baking twice gives the same light.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from slamgym.errors import SceneError
from slamgym.scenes.house import House, Part
from slamgym.scenes.light.direct import Lights, lights_of
from slamgym.scenes.light.exposure import exposure_of
from slamgym.scenes.light.facing import turned_to_view
from slamgym.scenes.light.illumination import Illumination, reflectances
from slamgym.scenes.light.imagined_lamps import imagined_lamps
from slamgym.scenes.light.places import places_in
from slamgym.scenes.light.rays import rays_of, stacked
from slamgym.scenes.light.refine import (
    CORNERS,
    Surface,
    affordable_edge,
    cut,
    edge_lengths,
    join,
    separate,
    split_creases,
    strongest_edges,
    subdivide,
)
from slamgym.scenes.light.samples import mean_by, neighbours_mean, samples_of
from slamgym.types import BoolArray, FloatArray

MAX_EDGE_M = 0.5
MOST_COARSE = 500_000
"""In houses of more triangles, or in wide fields, longer edges stay."""
FINEST_EDGE_M = 0.1
"""Only edges longer than this are cut where light changes."""
MAX_STEP = 0.1
"""An edge is cut when the light factors at its ends differ by more."""
ROUNDS = 3
GROWTH, ALWAYS = 2.5, 20_000
"""Triangles are added where light changes until there are so many times those of the house, or so many are added."""
COARSE_SHARE = 0.7
"""Of the work, the share that is done before vertices are added."""

IMAGINED = "light: no lamps or windows are given, so {} lamps are put where a ceiling would be"

Progress = Callable[[float], None]


def bake_light(house: House, on_progress: Progress | None = None) -> House:
    """The house with `light` in every part, float32 (V, 3) in [0.05, 1.2], and vertices added where light changes.

    Parts that have their light already, such as panes and bulbs, shine: they keep it. Faces that are seen from behind
    alone are turned over. on_progress: called with the share of the work that is done, 0 to 1. Raises SceneError where
    lamps or windows give no finite light.
    """
    report = on_progress or _ignore
    report(0.0)
    parts = tuple(part for part in house.parts if len(part.faces))
    if not parts:
        return replace(house, parts=())
    rays = rays_of(parts)
    vertices, faces = stacked(parts)
    places = places_in(rays, vertices[faces.ravel()])
    parts = turned_to_view(parts, places.everywhere)
    imagined = () if house.lamps or house.windows else imagined_lamps(places.indoors, rays)
    assumed = (IMAGINED.format(len(imagined)),) if imagined else ()
    matt = [split_creases(part) for part in parts if part.light is None]
    if matt:
        shining = [part for part in parts if part.light is not None]
        lights = lights_of(parts, house.lamps or imagined, house.windows)
        lit = iter(_checked(_lit(lights, matt, shining, places.indoors, report)))
        parts = tuple(next(lit) if part.light is None else part for part in parts)
    report(1.0)
    return replace(house, parts=parts, assumptions=(*house.assumptions, *assumed))


def _lit(
    lights: Lights, matt: Sequence[Part], shining: Sequence[Part], places: FloatArray, report: Progress
) -> tuple[Part, ...]:
    """The matt parts with their light, and with more vertices. places: (P, 3), where cameras could be."""
    whole = join(matt)
    surface = subdivide(whole, affordable_edge(whole, MAX_EDGE_M, MOST_COARSE))
    room = Illumination(surface, reflectances(surface, matt), shining, lights)
    light = room.bounced(samples_of(surface), partial(_between, report, 0.0, COARSE_SHARE))
    exposure = exposure_of(room, light, places)
    most = max(int(GROWTH * sum(len(part.faces) for part in matt)) - len(surface.faces), ALWAYS)
    for k, end in pairwise(np.linspace(COARSE_SHARE, 1.0, ROUNDS + 1)):
        edges = _edges_to_cut(surface, exposure(light), most)
        if not edges.any():
            break
        most -= int(edges.sum())
        surface, light = _finer(surface, light, edges, room, partial(_between, report, k, end))
    return separate(surface, matt, _smoothed(surface, exposure(light)).astype(np.float32))


def _checked(parts: Sequence[Part]) -> Sequence[Part]:
    for part in parts:
        if part.light is not None and not np.isfinite(part.light).all():
            raise SceneError(
                f"expected finite light, got NaN or infinity in part {part.name!r}; lamps or windows of the house are "
                "the cause: give them finite colours and intensities of at most 1000"
            )
    return parts


def _edges_to_cut(surface: Surface, factors: FloatArray, most: int) -> BoolArray:
    """Edges (F, 3) to cut, since light differs too much between their ends; `factors` (V, 3)."""
    ends = factors[surface.faces[:, CORNERS]]
    step, length = np.abs(ends[:, :, 0] - ends[:, :, 1]).max(axis=2), edge_lengths(surface)
    wanted = (step > MAX_STEP) & (length > FINEST_EDGE_M)
    return strongest_edges(surface, np.where(wanted, step * length, 0.0), most)


def _finer(
    surface: Surface, light: FloatArray, edges: BoolArray, room: Illumination, report: Progress
) -> tuple[Surface, FloatArray]:
    """The surface with these edges (F, 3) cut, and light (V, 3) for all its vertices: computed for the new ones."""
    old = len(surface.vertices)
    surface, between = cut(surface, edges)
    samples = samples_of(surface, old)
    new, buried = room.light(samples, report)
    own = samples.of_vertex
    new = np.where(buried[own, None], light[between].mean(axis=1), new[own])
    return surface, np.concatenate([light, new])


def _smoothed(surface: Surface, factors: FloatArray) -> FloatArray:
    """Factors (V, 3) halfway to the mean of the neighbours: no saw teeth where a shadow's edge runs between them."""
    samples = samples_of(surface)
    at_samples = mean_by(samples.of_vertex, factors)
    return (0.5 * (at_samples + neighbours_mean(samples, at_samples)))[samples.of_vertex]


def _between(report: Progress, low: float, high: float, share: float) -> None:
    report(low + share * (high - low))


def _ignore(share: float) -> None:
    pass
