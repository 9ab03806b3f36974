"""Parts of a house that are inside out: the floor that a robot needs looks down."""

from collections.abc import Sequence

import numpy as np

from slamgym.scenes.house import Part
from slamgym.types import BoolArray, FloatArray

FLOOR_M = 0.03
FLOOR_COSINE = 0.7
LEAST_FLOOR_M2 = 0.5
"""Less is no part of the floor that is missed, but furniture's feet."""


def inside_out(parts: Sequence[Part]) -> BoolArray:
    """Which parts (P,) are: those whose floor, at z = 0, looks down where no other part's looks up.

    The largest come first, so that furniture on a floor that is turned stays as it is.
    """
    faces = [_floor_faces(part) for part in parts]
    owners = np.repeat(np.arange(len(parts)), [len(triangles) for triangles in faces])
    corners = np.concatenate([*faces, np.zeros((0, 3, 3))])[..., :2]
    sides, others = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    upward = (sides[:, 0] * others[:, 1] - sides[:, 1] * others[:, 0]) / 2.0
    down = -np.bincount(owners, upward, len(parts))
    inverted = np.zeros(len(parts), dtype=bool)
    for k in np.argsort(-down, kind="stable")[: np.count_nonzero(down >= LEAST_FLOOR_M2)]:
        own = np.flatnonzero(owners == k)
        middle = corners[own[upward[own].argmin()]].mean(axis=0)
        inverted[k] = not _contain(corners[(owners != k) & ((upward > 0.0) ^ inverted[owners])], middle).any()
    return inverted


def _floor_faces(part: Part) -> FloatArray:
    """Triangles (K, 3, 3) of the part's faces at z = 0."""
    triangles = part.vertices[part.faces].astype(np.float64)
    at_floor = triangles[np.abs(triangles[..., 2]).max(axis=1) < FLOOR_M]
    normals = np.cross(at_floor[:, 1] - at_floor[:, 0], at_floor[:, 2] - at_floor[:, 0])
    return np.asarray(at_floor[np.abs(normals[:, 2]) > FLOOR_COSINE * np.linalg.norm(normals, axis=1)])


def _contain(triangles: FloatArray, point: FloatArray) -> BoolArray:
    """Which triangles (K, 3, 2) contain a point (2,), however they are wound."""
    towards, edges = point - triangles, np.roll(triangles, -1, axis=1) - triangles
    turns = edges[..., 0] * towards[..., 1] - edges[..., 1] * towards[..., 0]
    return np.asarray((turns >= 0.0).all(axis=1) | (turns <= 0.0).all(axis=1))
