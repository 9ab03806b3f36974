"""Ray queries against the triangles of a house, by Embree."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from numpy.typing import NDArray

from slamgym.scenes.house import Part
from slamgym.types import BoolArray, FloatArray, IntArray


class Hits(NamedTuple):
    """First surfaces along N rays. face: index (N,), -1 where nothing is hit. distance: (N,) metres, inf there.

    behind: (N,) whether the surface is seen from its back.
    """

    face: IntArray
    distance: FloatArray
    behind: BoolArray


class Rays:
    """Queries against triangles: vertices (V, 3), faces (F, 3). Origins and directions are (N, 3), of length 1."""

    def __init__(self, vertices: NDArray[np.float32], faces: NDArray[np.integer]) -> None:
        self._scene = EmbreeScene()
        if len(faces):
            TriangleMesh(self._scene, vertices.astype(np.float32), faces.astype(np.int32))

    def blocked(self, origins: FloatArray, directions: FloatArray, distances: FloatArray) -> BoolArray:
        """Whether something is hit within the distance, (N,). Runs in parallel threads."""
        o, d, r = (array.astype(np.float32) for array in (origins, directions, distances))
        return np.asarray(self._scene.run(o, d, dists=r, query="OCCLUDED")) >= 0

    def first_hits(self, origins: FloatArray, directions: FloatArray) -> Hits:
        """The first surface along each ray. Holds Python's lock: threads do not make it faster."""
        d = directions.astype(np.float32)
        hits = self._scene.run(origins.astype(np.float32), d, output=True)
        missed = hits["geomID"] < 0
        distance = np.where(missed, np.inf, hits["tfar"].astype(np.float64))
        behind = ~missed & (np.einsum("ni,ni->n", hits["Ng"], d) > 0.0)
        return Hits(np.where(missed, -1, hits["primID"]).astype(np.int64), distance, behind)


def rays_of(parts: Sequence[Part]) -> Rays:
    """Queries against all faces of the parts, numbered through."""
    return Rays(*stacked(parts))


def stacked(parts: Sequence[Part]) -> tuple[NDArray[np.float32], IntArray]:
    """Vertices (V, 3) and faces (F, 3) of all parts, one after another."""
    if not parts:
        return np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int64)
    starts = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    faces = [part.faces.astype(np.int64) + start for part, start in zip(parts, starts, strict=True)]
    return np.concatenate([part.vertices for part in parts]), np.concatenate(faces)


def sphere(count: int) -> FloatArray:
    """Unit vectors (count, 3) spread evenly over the sphere: a Fibonacci lattice."""
    k = np.arange(count)
    z = 1.0 - (2.0 * k + 1.0) / count
    angle = np.pi * (1.0 + np.sqrt(5.0)) * k
    return np.stack([np.sqrt(1 - z * z) * np.cos(angle), np.sqrt(1 - z * z) * np.sin(angle), z], axis=1)


def hemisphere(count: int) -> FloatArray:
    """Unit vectors (count, 3) about +z, cosine-weighted: a Fibonacci lattice."""
    k = np.arange(count)
    u, angle = (k + 0.5) / count, k * np.pi * (1.0 + np.sqrt(5.0))
    return np.stack([np.sqrt(u) * np.cos(angle), np.sqrt(u) * np.sin(angle), np.sqrt(1.0 - u)], axis=1)
