"""Which side of a surface is seen from where cameras could be: faces wound the wrong way round are turned over."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from slamgym.scenes.house import Part
from slamgym.scenes.light.rays import Rays, rays_of, stacked
from slamgym.scenes.light.refine import face_normals, unit
from slamgym.types import BoolArray, FloatArray, IntArray

VOTERS = 12
"""Each point of a face is judged from so many nearest viewpoints."""
LARGE_M2 = 0.1
"""Larger faces are judged at more points than their middle."""
LIFT_M = 0.005


def turned_to_view(parts: Sequence[Part], places: FloatArray) -> tuple[Part, ...]:
    """The parts with those faces turned over that are seen from the places (P, 3) from behind, and hardly from the
    front. Parts that shine stay as they are.
    """
    vertices, faces = stacked(parts)
    normals = face_normals(vertices, faces)
    of_face, points = _judged_points(vertices[faces].astype(np.float64), np.linalg.norm(normals, axis=1) / 2.0)
    front, back = _seen_sides(points, unit(normals)[of_face], rays_of(parts), places)
    wrong = np.bincount(of_face, back, len(faces)) > 2.0 * np.bincount(of_face, front, len(faces))
    pieces = np.split(wrong, np.cumsum([len(part.faces) for part in parts])[:-1])
    return tuple(_turned(part, piece) for part, piece in zip(parts, pieces, strict=True))


def _turned(part: Part, wrong: BoolArray) -> Part:
    if part.light is not None or not wrong.any():
        return part
    return replace(part, faces=np.where(wrong[:, None], part.faces[:, ::-1], part.faces))


def _judged_points(corners: FloatArray, areas: FloatArray) -> tuple[IntArray, FloatArray]:
    """Points on faces with corners (F, 3, 3), and the face (P,) of each: three more on large ones, which furniture may
    hide in part.
    """
    weights = np.array([[1 / 3, 1 / 3, 1 / 3], [0.7, 0.15, 0.15], [0.15, 0.7, 0.15], [0.15, 0.15, 0.7]])
    large = np.flatnonzero(areas > LARGE_M2)
    of_face = [np.arange(len(corners)), large, large, large]
    points = [np.einsum("nij,i->nj", corners[which], weight) for which, weight in zip(of_face, weights, strict=True)]
    return np.concatenate(of_face), np.concatenate(points)


def _seen_sides(points: FloatArray, normals: FloatArray, rays: Rays, places: FloatArray) -> FloatArray:
    """How large the front and the back (2, P) of the surface at the points look from the nearest places in sum."""
    seen = np.zeros((2, len(points)))
    if not len(places):
        return seen
    nearest = cKDTree(places).query(points, k=min(VOTERS, len(places)))[1].reshape(len(points), -1)
    for place in nearest.T:
        towards = places[place] - points
        distance = np.linalg.norm(towards, axis=1)
        towards /= np.maximum(distance, 1e-9)[:, None]
        cosine = np.einsum("ni,ni->n", towards, normals)
        size = np.abs(cosine) / np.maximum(distance, 0.3) ** 2
        size *= ~rays.blocked(points + LIFT_M * np.sign(cosine)[:, None] * normals, towards, distance)
        seen += np.where([cosine > 0.0, cosine < 0.0], size, 0.0)
    return seen
