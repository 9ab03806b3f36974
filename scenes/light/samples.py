"""The points where a surface's light is computed: one for vertices that share a place and a normal."""

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array

from slamgym.scenes.light.refine import CORNERS, Surface, corners_of
from slamgym.types import BoolArray, FloatArray, IntArray

OFFSET_M = 0.02
"""Height of samples above the surface; lower ones would spread the shade of millimetres over a vertex spacing."""
NUDGE_M = 0.03


class Samples(NamedTuple):
    """points, normals: (N, 3), unit normals. of_vertex: index of each vertex's sample. edges: neighbours (E, 2)."""

    points: FloatArray
    normals: FloatArray
    of_vertex: IntArray
    edges: IntArray


def samples_of(surface: Surface, first: int = 0) -> Samples:
    """Samples of the vertices from number `first` on, a little off the surface and towards the middle of its faces.

    The second keeps samples out of what stands on the surface's edge, such as the wall beside the floor's last vertex.
    Edges are those between two such vertices.
    """
    vertices, normals = surface.vertices[first:].astype(np.float64), surface.normals[first:]
    faces = surface.faces[(surface.faces >= first).any(axis=1)]
    corners = corners_of(faces, len(surface.vertices))[first:]
    middles = corners.dot(surface.vertices[faces].mean(axis=1)) / np.maximum(corners.sum(axis=1), 1.0)[:, None]
    keys = np.concatenate([(vertices * 1e4).round(), (normals * 10.0).round()], axis=1).astype(np.int32)
    _, some, of_vertex = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    of_vertex = of_vertex.reshape(-1)
    inward = mean_by(of_vertex, middles - vertices)
    reach = np.linalg.norm(inward, axis=1, keepdims=True)
    nudge = inward * np.minimum(0.5, NUDGE_M / np.maximum(reach, 1e-9))
    ends = faces[:, CORNERS].reshape(-1, 2) - first
    edges = of_vertex[ends[(ends >= 0).all(axis=1)]]
    return Samples(vertices[some] + nudge + OFFSET_M * normals[some], normals[some], of_vertex, edges)


def mean_by(group: IntArray, values: FloatArray) -> FloatArray:
    """Mean of the rows (V, 3) of each group 0 to N - 1, (N, 3)."""
    member = csr_array((np.ones(len(group)), (group, np.arange(len(group)))))
    mean: FloatArray = member.dot(values) / member.sum(axis=1)[:, None]
    return mean


def neighbours_mean(samples: Samples, values: FloatArray) -> FloatArray:
    """Mean of the neighbours' values (N, 3), one's own where there are none."""
    ends, others = np.concatenate([samples.edges, samples.edges[:, ::-1]]).T
    links = csr_array((np.ones(len(ends)), (ends, others)), shape=(len(values), len(values)))
    degree = links.sum(axis=1)[:, None]
    mean: FloatArray = np.where(degree > 0.0, links.dot(values) / np.maximum(degree, 1.0), values)
    return mean


def filled(values: FloatArray, missing: BoolArray, edges: IntArray) -> FloatArray:
    """Values (N, 3) where missing ones (N,) take the mean of their neighbours', from the edge of a gap inwards."""
    values, missing = values.copy(), missing.copy()
    both = np.concatenate([edges, edges[:, ::-1]])
    while len(links := both[missing[both[:, 0]] & ~missing[both[:, 1]]]):
        targets, group = np.unique(links[:, 0], return_inverse=True)
        values[targets] = mean_by(group, values[links[:, 1]])
        missing[targets] = False
    return values
