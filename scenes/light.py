"""Light baked into vertices with Embree: lamps with soft shadows, and ambient light that corners keep out.

A frame then costs no lighting at all. There is no randomness: all points share one set of directions, so that flat
surfaces come out smooth, and baking twice gives the same light.
"""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from numpy.typing import NDArray
from scipy.sparse import coo_array

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
OFFSET_M = 0.004
NUDGE_M = 0.03
BURIED = 0.02
"""Points that see less than this share of their hemisphere lie inside other geometry."""


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
    """The house with `light` in every part, float32 (V, 3) in [0.25, 1.1], and large faces subdivided to carry it."""
    parts = [subdivide(split_creases(part), MAX_EDGE_M) for part in house.parts if len(part.faces)]
    if not parts:
        return replace(house, parts=())
    samples = _samples(parts)
    light = _compress(_irradiance(samples, house.lamps, _occlusion(parts)))[samples.of_vertex].astype(np.float32)
    ends = np.cumsum([len(part.vertices) for part in parts])
    lit = (replace(part, light=piece) for part, piece in zip(parts, np.split(light, ends[:-1]), strict=True))
    return replace(house, parts=tuple(lit))


def _samples(parts: list[Part]) -> Samples:
    """One sample per place and normal, a little off the surface and towards the middle of its faces.

    The second keeps samples out of what stands on the surface's edge, such as the wall beside the floor's last vertex.
    """
    vertices, faces = _merged(parts)
    normals = face_normals(vertices, faces)
    vertex_normals, centres, count = (np.zeros((len(vertices), k)) for k in (3, 3, 1))
    for corner in faces.T:
        np.add.at(vertex_normals, corner, normals)
        np.add.at(centres, corner, vertices[faces].mean(axis=1))
        np.add.at(count, corner, 1.0)
    vertex_normals = unit(vertex_normals)
    keys = np.concatenate([vertices.round(4), vertex_normals.round(1) + 0.0], axis=1)
    _, first, of_vertex = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    of_vertex = of_vertex.reshape(-1)
    inward = _mean_by(of_vertex, centres / np.maximum(count, 1.0) - vertices)
    reach = np.linalg.norm(inward, axis=1, keepdims=True)
    points = vertices[first] + inward * np.minimum(0.5, NUDGE_M / np.maximum(reach, 1e-9))
    edges = of_vertex[faces][:, CORNERS].reshape(-1, 2)
    return Samples(points + OFFSET_M * vertex_normals[first], vertex_normals[first], of_vertex, edges)


def _merged(parts: list[Part]) -> tuple[NDArray[np.float32], IntArray]:
    starts = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    faces = [part.faces.astype(np.int64) + start for part, start in zip(parts, starts, strict=True)]
    return np.concatenate([part.vertices for part in parts]), np.concatenate(faces)
