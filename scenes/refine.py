"""Mesh refinement before light is baked per vertex: hard edges get vertices of their own, long edges are cut."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from slamgym.scenes.house import Part
from slamgym.types import BoolArray, FloatArray, IntArray

CORNERS = ((0, 1), (1, 2), (2, 0))
"""A face's edges as pairs of its corners; edge k's midpoint has the local index 3 + k."""

# Triangles that replace a face, by which of its edges 0, 1, 2 are cut (bits 1, 2, 4), in local indices.
PATTERNS: dict[int, tuple[tuple[int, int, int], ...]] = {
    0: ((0, 1, 2),),
    1: ((0, 3, 2), (3, 1, 2)),
    2: ((1, 4, 0), (4, 2, 0)),
    4: ((2, 5, 1), (5, 0, 1)),
    3: ((3, 1, 4), (0, 3, 4), (0, 4, 2)),
    6: ((4, 2, 5), (1, 4, 5), (1, 5, 0)),
    5: ((5, 0, 3), (2, 5, 3), (2, 3, 1)),
    7: ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
}


def face_normals(vertices: NDArray[np.float32], faces: NDArray[np.integer]) -> FloatArray:
    """Normals (F, 3) of counter-clockwise faces, as long as twice the face's area."""
    a, b, c = (vertices[faces[:, k]].astype(np.float64) for k in range(3))
    return np.cross(b - a, c - a)


def unit(vectors: FloatArray) -> FloatArray:
    """Vectors (..., 3) scaled to length 1; zero vectors stay zero."""
    lengths: FloatArray = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.maximum(lengths, 1e-12)


def split_creases(part: Part, crease_deg: float = 40.0) -> Part:
    """The part with vertices unshared between faces that meet at more than this angle, and only between those."""
    group = _smooth_groups(part, np.cos(np.deg2rad(crease_deg)))
    corners = part.faces.astype(np.int64) * (group.max(initial=0) + 1) + group[:, None]
    corner, faces = np.unique(corners, return_inverse=True)
    return _resampled(part, corner // (group.max(initial=0) + 1), faces)


def _smooth_groups(part: Part, min_cosine: float) -> IntArray:
    """Group (F,) of each face; neighbours whose normals are close are in the same one."""
    _, welded = np.unique(part.vertices.round(5), axis=0, return_inverse=True)
    edges = np.sort(welded.reshape(-1)[part.faces][:, CORNERS], axis=2).reshape(-1, 2)
    order = np.lexsort(edges.T)
    same = (edges[order[1:]] == edges[order[:-1]]).all(axis=1)
    a, b = order[1:][same] // 3, order[:-1][same] // 3
    normals = unit(face_normals(part.vertices, part.faces))
    smooth = (normals[a] * normals[b]).sum(axis=1) > min_cosine
    links = coo_array((np.ones(smooth.sum()), (a[smooth], b[smooth])), shape=(len(normals), len(normals)))
    return connected_components(links, directed=False)[1].astype(np.int64)


def subdivide(part: Part, max_edge_m: float) -> Part:
    """The part with every edge cut in halves until none is longer than `max_edge_m`; uv is interpolated.

    Whether and where an edge is cut depends on its end points alone, so faces that met along it still do, in other
    parts too: no cracks.
    """
    while (long := _edge_lengths(part) > max_edge_m).any():
        part = _cut(part, long)
    return part


def _edge_lengths(part: Part) -> FloatArray:
    ends = part.vertices.astype(np.float64)[part.faces[:, CORNERS]]
    lengths: FloatArray = np.linalg.norm(ends[:, :, 0] - ends[:, :, 1], axis=2)
    return lengths


def _cut(part: Part, long: BoolArray) -> Part:
    """One round of `subdivide`. long: which edges (F, 3) are cut."""
    ends, index = np.unique(np.sort(part.faces[:, CORNERS], axis=2)[long], axis=0, return_inverse=True)
    midpoints = np.zeros(long.shape, np.int64)
    midpoints[long] = len(part.vertices) + index.reshape(-1)
    local = np.concatenate([part.faces, midpoints], axis=1)
    pattern = long @ np.array([1, 2, 4])
    faces = [local[pattern == bits][:, corners].reshape(-1, 3) for bits, corners in PATTERNS.items()]
    return replace(
        part,
        vertices=np.concatenate([part.vertices, part.vertices[ends].mean(axis=1)]),
        uv=None if part.uv is None else np.concatenate([part.uv, part.uv[ends].mean(axis=1)]),
        faces=np.concatenate(faces).astype(np.int32),
    )


def _resampled(part: Part, vertex: IntArray, faces: IntArray) -> Part:
    """The part with `part.vertices[vertex]` as vertices."""
    return replace(
        part,
        vertices=part.vertices[vertex],
        uv=None if part.uv is None else part.uv[vertex],
        faces=faces.reshape(-1, 3).astype(np.int32),
    )
