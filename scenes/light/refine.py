"""Mesh refinement for light that is baked per vertex: hard edges get vertices of their own, edges are cut in halves."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components

from slamgym.scenes.house import Part
from slamgym.types import BoolArray, FloatArray, IntArray

Real = TypeVar("Real", np.float32, np.float64)

CORNERS = ((0, 1), (1, 2), (2, 0))
"""A face's edges as pairs of its corners; edge k's midpoint has the local index 3 + k."""

FACE_AREA = 0.2
"""About the area of a face whose longest edge is cut to a length of 1 and less."""

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


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """The triangles of many parts as one mesh; parts share no vertices.

    vertices: float32 (V, 3). faces: int64 (F, 3). normals: float64 (V, 3), unit. uv: float32 (V, 2). colour: float32
    (V, 3). part: index (F,) of each face's part.
    """

    vertices: NDArray[np.float32]
    faces: IntArray
    normals: FloatArray
    uv: NDArray[np.float32]
    colour: NDArray[np.float32]
    part: IntArray


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
    vertex = corner // (group.max(initial=0) + 1)
    return replace(
        part,
        vertices=part.vertices[vertex],
        uv=None if part.uv is None else part.uv[vertex],
        colour=None if part.colour is None else part.colour[vertex],
        faces=faces.reshape(-1, 3).astype(np.int32),
    )


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


def join(parts: Sequence[Part]) -> Surface:
    """The parts as one surface, with the normals of their shared vertices averaged."""
    starts = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    vertices = np.concatenate([part.vertices for part in parts])
    faces = np.concatenate([part.faces.astype(np.int64) + start for part, start in zip(parts, starts, strict=True)])
    return Surface(
        vertices,
        faces,
        unit(np.asarray(corners_of(faces, len(vertices)).dot(face_normals(vertices, faces)))),
        np.concatenate([np.zeros((len(p.vertices), 2), np.float32) if p.uv is None else p.uv for p in parts]),
        np.concatenate([np.ones_like(p.vertices) if p.colour is None else p.colour for p in parts]),
        np.repeat(np.arange(len(parts)), [len(part.faces) for part in parts]),
    )


def corners_of(faces: IntArray, vertices: int) -> csr_array:
    """Which faces (columns) meet at which of so many vertices (rows)."""
    return csr_array((np.ones(faces.size), (faces.ravel(), np.arange(faces.size) // 3)), shape=(vertices, len(faces)))


def separate(surface: Surface, parts: Sequence[Part], light: NDArray[np.float32]) -> tuple[Part, ...]:
    """The parts anew, as they are on the surface, with their share of the light (V, 3)."""
    owner = np.zeros(len(surface.vertices), np.int64)
    owner[surface.faces] = surface.part[:, None]
    order, by_part = np.argsort(owner, kind="stable"), np.argsort(surface.part, kind="stable")
    ends = np.cumsum(np.bincount(owner, minlength=len(parts)))
    place = np.empty(len(order), np.int64)
    place[order] = np.arange(len(order))
    faces = np.split(place[surface.faces[by_part]], np.cumsum(np.bincount(surface.part, minlength=len(parts)))[:-1])
    pieces = np.split(order, ends[:-1])
    return tuple(
        replace(
            part,
            vertices=surface.vertices[piece],
            faces=(corners - (end - len(piece))).astype(np.int32),
            uv=None if part.uv is None else surface.uv[piece],
            colour=None if part.colour is None else surface.colour[piece],
            light=light[piece],
        )
        for part, piece, corners, end in zip(parts, pieces, faces, ends, strict=True)
    )


def subdivide(surface: Surface, max_edge_m: float) -> Surface:
    """The surface with every edge cut in halves until none is longer than `max_edge_m`; values are interpolated.

    Whether and where an edge is cut depends on its end points alone, so faces that met along it still do: no cracks.
    """
    while (long := edge_lengths(surface) > max_edge_m).any():
        surface, _ = cut(surface, long)
    return surface


def affordable_edge(surface: Surface, edge_m: float, most: int) -> float:
    """The longest edge to `subdivide` to, metres: `edge_m`, or so many times the double of it that about `most` faces
    come out: a field of a kilometre would not fit in memory.
    """
    areas = np.linalg.norm(face_normals(surface.vertices, surface.faces), axis=1) / 2.0
    longest = edge_lengths(surface).max(axis=1)
    while (areas / (FACE_AREA * edge_m**2) + longest / edge_m).sum() > most:
        edge_m *= 2.0
    return edge_m


def edge_lengths(surface: Surface) -> FloatArray:
    """Lengths (F, 3) of the faces' edges, metres."""
    ends = surface.vertices.astype(np.float64)[surface.faces[:, CORNERS]]
    lengths: FloatArray = np.linalg.norm(ends[:, :, 0] - ends[:, :, 1], axis=2)
    return lengths


def strongest_edges(surface: Surface, strength: FloatArray, most: int) -> BoolArray:
    """Which edges (F, 3) to cut: those of a strength above 0, the strongest first, adding `most` faces at most.

    Edges between the same places count as one, with the largest of their strengths, so that no crack can open.
    """
    _, place = np.unique(surface.vertices, axis=0, return_inverse=True)
    ends = np.sort(place.reshape(-1)[surface.faces[:, CORNERS]], axis=2).reshape(-1, 2)
    _, edge, uses = np.unique(ends[:, 0] * len(place) + ends[:, 1], return_inverse=True, return_counts=True)
    strongest = np.zeros(len(uses))
    np.maximum.at(strongest, edge.reshape(-1), strength.ravel())
    order = np.argsort(-strongest, kind="stable")
    chosen = np.zeros(len(uses), dtype=bool)
    chosen[order] = (strongest[order] > 0.0) & (np.cumsum(uses[order]) <= most)
    cut_there: BoolArray = chosen[edge.reshape(-1)].reshape(-1, 3)
    return cut_there


def cut(surface: Surface, edges: BoolArray) -> tuple[Surface, IntArray]:
    """The surface with these edges (F, 3) cut in halves; new vertices follow the old ones.

    Second: the two old vertices (M, 2) that each new one lies between.
    """
    ends, index = np.unique(np.sort(surface.faces[:, CORNERS], axis=2)[edges], axis=0, return_inverse=True)
    midpoints = np.zeros(edges.shape, np.int64)
    midpoints[edges] = len(surface.vertices) + index.reshape(-1)
    local = np.concatenate([surface.faces, midpoints], axis=1)
    pattern = edges @ np.array([1, 2, 4])
    which = {bits: np.flatnonzero(pattern == bits) for bits in PATTERNS}
    faces = [local[which[bits]][:, corners].reshape(-1, 3) for bits, corners in PATTERNS.items()]
    owners = [np.repeat(surface.part[which[bits]], len(corners)) for bits, corners in PATTERNS.items()]
    finer = Surface(
        _extended(surface.vertices, ends),
        np.concatenate(faces),
        unit(_extended(surface.normals, ends)),
        _extended(surface.uv, ends),
        _extended(surface.colour, ends),
        np.concatenate(owners),
    )
    return finer, ends


def _extended(values: NDArray[Real], ends: IntArray) -> NDArray[Real]:
    """Values (V, K) of the vertices, followed by those of the midpoints between `ends` (M, 2)."""
    middle: NDArray[Real] = values[ends].mean(axis=1)
    return np.concatenate([values, middle])
