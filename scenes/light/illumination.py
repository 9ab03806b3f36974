"""All light in a house: what comes straight from lamps and windows, what surfaces throw on, the sky, and a base.

Light is what arrives at a surface, linear, in the unit of `direct`. The light that surfaces throw on is solved by
gathering: rays from every point see the faces that light it (radiosity by Jacobi's iteration, with the rays as form
factors; Cohen and Wallace, Radiosity and realistic image synthesis, 1993).
"""

import os
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from slamgym.scenes.house import Material, Part
from slamgym.scenes.light.direct import Lights, direct_light
from slamgym.scenes.light.rays import Rays, hemisphere
from slamgym.scenes.light.refine import Surface, unit
from slamgym.scenes.light.samples import Samples, filled
from slamgym.types import BoolArray, FloatArray

GAMMA = 2.2
MOST_REFLECTED = 0.85
RAYS, FEWEST_RAYS = 48, 16
MOST_HITS = 10_000_000
"""First hits take most of the time: large houses get fewer rays a point."""
BOUNCES = 3
BASE = 0.08
"""Light that is everywhere but in corners, for all further bounces; without lamps and windows it is all there is."""
BASE_ALONE = 1.0
CORNER_M = 0.8
"""Nearer surfaces keep the base light out (obscurance: Zhukov et al., An ambient light illumination model, 1998)."""
SKY, GROUND = 1.0, 0.3
CHUNK = 4096


class Gathered(NamedTuple):
    """What N points receive and see. own: (N, 3) all light but that of the faces. seen: face (N, R) of each ray, -1 for
    none. buried: (N,) whether the point lies inside other geometry.
    """

    own: FloatArray
    seen: NDArray[np.int32]
    buried: BoolArray


class Illumination:
    """The light in a house whose matt surfaces are `surface`, reflecting (F, 3) of it.

    What shines gives no light of its own: lamps and windows stand for it.
    """

    def __init__(self, surface: Surface, reflected: FloatArray, shining: Sequence[Part], lights: Lights) -> None:
        self.surface, self.reflected, self.lights = surface, reflected, lights
        self.rays = rays_with(surface, shining)
        dark = sum(len(part.faces) for part in shining) + 1  # the last row is for rays that meet nothing
        self._thrown = np.concatenate([np.zeros_like(reflected), np.zeros((dark, 3))])
        self._count = int(np.clip(MOST_HITS // max(len(surface.vertices), 1), FEWEST_RAYS, RAYS))

    def bounced(self, samples: Samples, on_progress: Callable[[float], None]) -> FloatArray:
        """Light (V, 3) at the surface's own vertices; it is kept as what the faces throw on."""
        gathered = self._gather(samples, on_progress)
        light = gathered.own
        for _ in range(BOUNCES):
            at_faces = filled(light, gathered.buried, samples.edges)[samples.of_vertex][self.surface.faces].mean(axis=1)
            self._thrown[: len(at_faces)] = self.reflected * at_faces
            light = gathered.own + self._from_faces(gathered.seen)
        return filled(light, gathered.buried, samples.edges)[samples.of_vertex]

    def light(self, samples: Samples, on_progress: Callable[[float], None]) -> tuple[FloatArray, BoolArray]:
        """Light (N, 3) at the samples, and whether they lie inside other geometry, (N,)."""
        gathered = self._gather(samples, on_progress)
        return gathered.own + self._from_faces(gathered.seen), gathered.buried

    def _from_faces(self, seen: NDArray[np.int32]) -> FloatArray:
        light = [self._thrown[seen[k : k + CHUNK]].mean(axis=1) for k in range(0, len(seen), CHUNK)]
        return np.concatenate(light) if light else np.zeros((0, 3))

    def _gather(self, samples: Samples, on_progress: Callable[[float], None]) -> Gathered:
        starts = range(0, len(samples.points), CHUNK)
        work = [
            partial(self._gather_chunk, samples.points[k : k + CHUNK], samples.normals[k : k + CHUNK]) for k in starts
        ]
        chunks = []
        with closing(_in_parallel(work)) as done:
            for chunk in done:
                chunks.append(chunk)
                on_progress(len(chunks) / len(work))
        return Gathered(*(np.concatenate(columns) for columns in zip(*chunks, strict=True)))

    def _gather_chunk(self, points: FloatArray, normals: FloatArray) -> Gathered:
        directions = np.einsum("nij,rj->nri", _tangent_frames(normals), hemisphere(self._count))
        origins = np.repeat(points, self._count, axis=0)
        hits = self.rays.first_hits(origins, directions.reshape(-1, 3))
        shape = (len(points), self._count)
        face = hits.face.reshape(shape)
        base = BASE if self.lights.lamps or self.lights.windows else BASE_ALONE
        near = np.minimum(hits.distance.reshape(shape) / CORNER_M, 1.0)
        sky = np.where(directions[:, :, 2] > 0.0, SKY, GROUND) * (face < 0)
        own = direct_light(points, normals, self.lights) + (base * near + sky).mean(axis=1)[:, None]
        return Gathered(own, face.astype(np.int32), hits.behind.reshape(shape).mean(axis=1) > 0.5)


def rays_with(surface: Surface, shining: Sequence[Part]) -> Rays:
    """Rays against the surface's faces, followed by those of the parts that shine."""
    vertices = [surface.vertices, *(part.vertices for part in shining)]
    starts = np.cumsum([len(piece) for piece in vertices])
    faces = [surface.faces, *(part.faces + start for part, start in zip(shining, starts, strict=False))]
    return Rays(np.concatenate(vertices), np.concatenate(faces))


def reflectances(surface: Surface, parts: Sequence[Part]) -> FloatArray:
    """How much light each face throws back, linear, (F, 3): its material's mean colour."""
    colours = np.array([mean_colour(part.material) for part in parts])[surface.part]
    own = surface.colour[surface.faces].mean(axis=1).astype(np.float64) ** GAMMA
    reflected: FloatArray = np.minimum(colours * own, MOST_REFLECTED)
    return reflected


def mean_colour(material: Material) -> FloatArray:
    """The material's colour times its texture's mean, linear, (3,)."""
    colour = np.asarray(material.colour, dtype=np.float64) ** GAMMA
    if material.texture is None or not material.texture.size:
        return colour
    linear = (np.arange(256) / 255.0) ** GAMMA
    texels = material.texture.reshape(-1, 3)
    mean = [np.bincount(channel, minlength=256) @ linear / len(channel) for channel in texels.T]
    reflected: FloatArray = colour * np.array(mean)
    return reflected


def _tangent_frames(normals: FloatArray) -> FloatArray:
    """Rotations (N, 3, 3) whose third column is the normal."""
    helper = np.where(np.abs(normals[:, 2:]) > 0.7, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    tangent = unit(np.cross(helper, normals))
    return np.stack([tangent, np.cross(normals, tangent), normals], axis=2)


def _in_parallel(work: Sequence[Callable[[], Gathered]]) -> Generator[Gathered, None, None]:
    """What the functions return, in order. Those that have not begun are dropped when this is left, as by Ctrl-C."""
    pool = ThreadPoolExecutor(os.cpu_count())
    try:
        yield from (future.result() for future in [pool.submit(function) for function in work])
    finally:
        pool.shutdown(cancel_futures=True)
