"""Light baked into vertices with Embree: lamps with soft shadows, and ambient light that corners keep out.

A frame then costs no lighting at all. There is no randomness: all points share one set of directions, so that flat
surfaces come out smooth, and baking twice gives the same light.
"""

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from numpy.typing import NDArray
from scipy.sparse import csr_array

from slamgym.scenes.house import House, Lamp, Part
from slamgym.scenes.refine import CORNERS, face_normals, split_creases, subdivide, unit
from slamgym.types import BoolArray, FloatArray, IntArray

MAX_EDGE_M = 0.35
AMBIENT = 0.5
AMBIENT_WITHOUT_LAMPS = 1.2
AMBIENT_RAYS = 64
AMBIENT_RANGE_M = 1.5
LAMP_SAMPLES = 6
FIXTURE_M = 0.3
"""Geometry this close to a lamp is its fixture and casts no shadow."""
DARKEST, BRIGHTEST = 0.25, 1.1
OFFSET_M = 0.02
"""Height of samples above the surface; lower ones would spread the shade of millimetres over a vertex spacing."""
NUDGE_M = 0.03
BURIED_RAYS = 8
"""Points that see mostly back faces along so many rays lie inside other geometry."""


@dataclass(frozen=True, slots=True, eq=False)
class Samples:
    """Where light is computed. points, normals: float64 (N, 3), unit normals.

    of_vertex: index (V,) of the sample that each vertex of all parts uses. edges: pairs (E, 2) of neighbours.
    """

    points: FloatArray
    normals: FloatArray
    of_vertex: IntArray
    edges: IntArray


def bake_light(house: House) -> House:
    """The house with `light` in every part, float32 (V, 3) in [0.25, 1.1], and large faces subdivided to carry it.

    Parts that have their light already, such as windows and bulbs, shine: they keep it.
    """
    parts = [_refined(part) for part in house.parts if len(part.faces)]
    if not parts:
        return replace(house, parts=())
    samples = _samples(parts)
    light = _compress(_irradiance(samples, house.lamps, _Rays(parts)))[samples.of_vertex].astype(np.float32)
    ends = np.cumsum([len(part.vertices) for part in parts])
    pieces = zip(parts, np.split(light, ends[:-1]), strict=True)
    lit = (part if part.light is not None else replace(part, light=piece) for part, piece in pieces)
    return replace(house, parts=tuple(lit))


def _refined(part: Part) -> Part:
    return part if part.light is not None else subdivide(split_creases(part), MAX_EDGE_M)


def _samples(parts: list[Part]) -> Samples:
    """One sample per place and normal, a little off the surface and towards the middle of its faces.

    The second keeps samples out of what stands on the surface's edge, such as the wall beside the floor's last vertex.
    """
    vertices, faces = _merged(parts)
    corner_of = csr_array((np.ones(faces.size), (faces.ravel(), np.arange(faces.size) // 3)))
    normals = unit(np.asarray(corner_of.dot(face_normals(vertices, faces))))
    middles = corner_of.dot(vertices[faces].mean(axis=1)) / np.maximum(corner_of.sum(axis=1), 1.0)[:, None]
    keys = np.concatenate([vertices.round(4), normals.round(1) + 0.0], axis=1)
    _, first, of_vertex = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    inward = _mean_by(of_vertex.ravel(), middles - vertices)
    reach = np.linalg.norm(inward, axis=1, keepdims=True)
    nudge = inward * np.minimum(0.5, NUDGE_M / np.maximum(reach, 1e-9))
    points = vertices[first] + nudge + OFFSET_M * normals[first]
    return Samples(points, normals[first], of_vertex.ravel(), of_vertex.ravel()[faces][:, CORNERS].reshape(-1, 2))


def _mean_by(group: IntArray, values: FloatArray) -> FloatArray:
    """Mean of the rows (V, 3) of each group 0 to N - 1, (N, 3)."""
    member = csr_array((np.ones(len(group)), (group, np.arange(len(group)))))
    mean: FloatArray = member.dot(values) / member.sum(axis=1)[:, None]
    return mean


def _merged(parts: list[Part]) -> tuple[NDArray[np.float32], IntArray]:
    starts = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    faces = [part.faces.astype(np.int64) + start for part, start in zip(parts, starts, strict=True)]
    return np.concatenate([part.vertices for part in parts]), np.concatenate(faces)


class _Rays:
    """Ray queries against all parts. origins, directions: (N, 3), directions of length 1. distances: (N,), metres."""

    def __init__(self, parts: list[Part]) -> None:
        vertices, faces = _merged(parts)
        self._scene = EmbreeScene()
        TriangleMesh(self._scene, vertices, faces.astype(np.int32))

    def blocked(self, origins: FloatArray, directions: FloatArray, distances: FloatArray) -> BoolArray:
        """Whether something is hit within the distance, (N,)."""
        o, d, r = (array.astype(np.float32) for array in (origins, directions, distances))
        return np.asarray(self._scene.run(o, d, dists=r, query="OCCLUDED")) >= 0

    def hits_back(self, origins: FloatArray, directions: FloatArray) -> BoolArray:
        """Whether the first surface hit is seen from behind, (N,)."""
        d = directions.astype(np.float32)
        hits = self._scene.run(origins.astype(np.float32), d, output=True)
        back: BoolArray = (hits["geomID"] >= 0) & ((hits["Ng"] * d).sum(axis=1) > 0.0)
        return back


def _irradiance(samples: Samples, lamps: tuple[Lamp, ...], rays: _Rays) -> FloatArray:
    """Light (N, 3) that arrives at the samples; 1 is what a lamp of intensity 1 gives to a wall 2 m away."""
    openness = np.zeros(len(samples.points))
    direct = np.zeros((len(samples.points), 3))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for free in pool.map(lambda k: _free(samples, k, rays), range(AMBIENT_RAYS)):
            openness += free / AMBIENT_RAYS
        behind = pool.map(lambda k: _sees_back(samples, k, rays), range(BURIED_RAYS))
        buried = np.mean(list(behind), axis=0) > 0.5
        for light in pool.map(lambda lamp: _lamp_light(samples, lamp, rays), lamps):
            direct += light
    ambient = (AMBIENT if lamps else AMBIENT_WITHOUT_LAMPS) * openness * (0.8 + 0.2 * samples.normals[:, 2])
    return _smoothed(_fill_buried(ambient[:, None] + direct, buried, samples.edges), samples.edges)


def _free(samples: Samples, k: int, rays: _Rays) -> BoolArray:
    """Whether ambient ray k is free, (N,).

    The rays' lengths differ, so that in the mean near geometry takes away more light than far geometry does.
    """
    length = AMBIENT_RANGE_M * ((k * 0.7548776662466927 + 0.5) % 1.0)
    directions = _hemisphere(samples.normals, k, AMBIENT_RAYS)
    return ~rays.blocked(samples.points, directions, np.full(len(directions), length))


def _sees_back(samples: Samples, k: int, rays: _Rays) -> BoolArray:
    return rays.hits_back(samples.points, _hemisphere(samples.normals, k, BURIED_RAYS))


def _hemisphere(normals: FloatArray, k: int, count: int) -> FloatArray:
    """Direction k of `count`, cosine-weighted about each normal, (N, 3); a Fibonacci lattice."""
    u, angle = (k + 0.5) / count, k * np.pi * (1.0 + np.sqrt(5.0))
    local = np.array([np.sqrt(u) * np.cos(angle), np.sqrt(u) * np.sin(angle), np.sqrt(1.0 - u)])
    directions: FloatArray = np.einsum("nij,j->ni", _tangent_frames(normals), local)
    return directions


def _tangent_frames(normals: FloatArray) -> FloatArray:
    """Rotations (N, 3, 3) whose third column is the normal."""
    helper = np.where(np.abs(normals[:, 2:]) > 0.7, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    tangent = unit(np.cross(helper, normals))
    return np.stack([tangent, np.cross(normals, tangent), normals], axis=2)


def _lamp_light(samples: Samples, lamp: Lamp, rays: _Rays) -> FloatArray:
    """Light (N, 3) of one lamp: inverse square, cosine law, and shadow rays to points of its sphere."""
    total = np.zeros(len(samples.points))
    for offset in _sphere(LAMP_SAMPLES) * lamp.radius:
        towards = np.asarray(lamp.position) + offset - samples.points
        distance = np.linalg.norm(towards, axis=1)
        towards /= np.maximum(distance, 1e-9)[:, None]
        cosine = (towards * samples.normals).sum(axis=1)
        facing = np.flatnonzero(cosine > 0.0)
        free = ~rays.blocked(samples.points[facing], towards[facing], np.maximum(distance[facing] - FIXTURE_M, 0.0))
        total[facing] += free * cosine[facing] * 4.0 / np.maximum(distance[facing], 0.7) ** 2
    colour = lamp.intensity / LAMP_SAMPLES * np.asarray(lamp.colour)
    return total[:, None] * colour


def _sphere(count: int) -> FloatArray:
    """Points (count, 3) spread over the unit sphere by a Fibonacci lattice."""
    k = np.arange(count)
    z = 1.0 - (2.0 * k + 1.0) / count
    angle = np.pi * (1.0 + np.sqrt(5.0)) * k
    return np.stack([np.sqrt(1 - z * z) * np.cos(angle), np.sqrt(1 - z * z) * np.sin(angle), z], axis=1)


def _fill_buried(light: FloatArray, buried: BoolArray, edges: IntArray) -> FloatArray:
    """Light where buried samples take their neighbours' mean, so that their darkness does not bleed into view."""
    light, buried = light.copy(), buried.copy()
    both = np.concatenate([edges, edges[:, ::-1]])
    for _ in range(4):
        links = both[buried[both[:, 0]] & ~buried[both[:, 1]]]
        if not len(links):
            break
        targets, group = np.unique(links[:, 0], return_inverse=True)
        light[targets] = _mean_by(group, light[links[:, 1]])
        buried[targets] = False
    return light


def _smoothed(light: FloatArray, edges: IntArray) -> FloatArray:
    """Light halfway to the mean of the neighbours: no saw teeth where a shadow's edge runs between the vertices."""
    ends, others = np.concatenate([edges, edges[:, ::-1]]).T
    links = csr_array((np.ones(len(ends)), (ends, others)), shape=(len(light), len(light)))
    degree = np.maximum(links.sum(axis=1), 1.0)[:, None]
    return 0.5 * (light + np.asarray(links.dot(light)) / degree)


def _compress(irradiance: FloatArray) -> FloatArray:
    """Light factors in [DARKEST, BRIGHTEST] with the highlights rolled off."""
    return DARKEST + (BRIGHTEST - DARKEST) * (1.0 - np.exp(-irradiance))
