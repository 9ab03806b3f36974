"""What can be used of meshes: faces with an area, of numbers, near the rest."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from slamgym.scenes.importing.names import listed
from slamgym.scenes.importing.pieces import Piece
from slamgym.types import BoolArray, FloatArray, IntArray

THINNEST = 1e-9
"""Height of a triangle by its longest edge, below which it has no area."""
BEYOND_ALL = 1000.0
BEYOND_CORE = 10.0
CORE = (0.2, 0.8)


def clean(pieces: Sequence[Piece]) -> tuple[list[Piece], list[str]]:
    """The pieces without faces that no house has, and a line for each kind of them.

    Left out: faces with vertices that are missing or not finite, faces without area, and what lies far away from the
    rest (see `far_faces`). Pieces without a face, and vertices without one, go too.
    """
    defects: list[str] = []
    kept = list(pieces)
    for what, usable in (
        ("with vertices that are not there", _within),
        ("with vertices that are not numbers", _finite),
        ("without area", _has_area),
    ):
        kept = _filtered(kept, [usable(piece) for piece in kept], what, defects)
    far = far_faces(triangles_of(kept))
    near = np.split(~far, np.cumsum([len(piece.faces) for piece in kept])[:-1]) if kept else []
    return _filtered(kept, near, "far away from all others", defects), defects


def triangles_of(pieces: Sequence[Piece]) -> FloatArray:
    """Corners (F, 3, 3) of all faces, in the order of the pieces."""
    return np.concatenate([piece.vertices[piece.faces] for piece in pieces] or [np.zeros((0, 3, 3))])


def far_faces(triangles: FloatArray) -> BoolArray:
    """Faces (F,) of triangles (F, 3, 3) with a corner far away from the scene's core, in any unit.

    First what is 1,000 times farther from the median than the typical face, so that a huge triangle cannot count as a
    scene. Then what is more than 10 times the core's size away from it: the core holds the middle 60 % of the faces,
    half counted and half by area, so that it is neither one dense object nor one large plane.
    """
    if len(triangles) == 0:
        return np.zeros(0, dtype=bool)
    centres = triangles.mean(axis=1)
    middle = np.median(centres, axis=0)
    typical = np.median(np.abs(centres - middle).max(axis=1))
    far: BoolArray = np.abs(triangles - middle).max(axis=(1, 2)) > BEYOND_ALL * max(typical, _median_side(triangles))
    near = triangles[~far]
    lower, upper = _core(near.mean(axis=1), areas_of(near))
    margin = BEYOND_CORE * max(float((upper - lower).max()), _median_side(near))
    beyond = (triangles < lower - margin) | (triangles > upper + margin)
    return np.asarray(far | beyond.any(axis=(1, 2)))


def areas_of(triangles: FloatArray) -> FloatArray:
    """Areas (F,) of triangles (F, 3, 3)."""
    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return 0.5 * np.asarray(np.linalg.norm(cross, axis=1))


def weighted_quantile(values: FloatArray, weights: FloatArray, share: float) -> float:
    """The smallest of values (N,), N > 0, up to which `share` of the weight (N,) lies."""
    order = np.argsort(values)
    cumulated = np.cumsum(weights[order])
    place = np.searchsorted(cumulated, share * cumulated[-1])
    return float(values[order[min(int(place), len(values) - 1)]])


def _median_side(triangles: FloatArray) -> float:
    return float(np.median(np.ptp(triangles, axis=1).max(axis=1)))


def _core(centres: FloatArray, areas: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Bounds, (3,) and (3,), of the middle of the scene."""
    weights = 1.0 / len(areas) + areas / max(float(areas.sum()), np.finfo(float).tiny)
    lower, upper = ([weighted_quantile(axis, weights, share) for axis in centres.T] for share in CORE)
    return np.array(lower), np.array(upper)


def _filtered(pieces: list[Piece], kept: Sequence[BoolArray], what: str, defects: list[str]) -> list[Piece]:
    """Pieces with the faces that `kept`, a mask (F,) for each piece, keeps."""
    lost = {piece.name: int((~mask).sum()) for piece, mask in zip(pieces, kept, strict=True) if not mask.all()}
    if lost:
        count = sum(lost.values())
        defects.append(f"{count} face{'s' if count > 1 else ''} {what} left out, in {listed(list(lost))}")
    return [
        piece if mask.all() else _with_faces(piece, piece.faces[mask])
        for piece, mask in zip(pieces, kept, strict=True)
        if mask.any()
    ]


def _with_faces(piece: Piece, faces: IntArray) -> Piece:
    used, renumbered = np.unique(faces, return_inverse=True)
    return replace(
        piece,
        vertices=piece.vertices[used],
        faces=renumbered.reshape(-1, 3),
        uv=None if piece.uv is None else piece.uv[used],
        colour=None if piece.colour is None else piece.colour[used],
    )


def _within(piece: Piece) -> BoolArray:
    return np.asarray(((piece.faces >= 0) & (piece.faces < len(piece.vertices))).all(axis=1))


def _finite(piece: Piece) -> BoolArray:
    # Beyond this the square of an area overflows.
    good = np.abs(piece.vertices).max(axis=1, initial=0.0) < 1e50
    return np.asarray(good[piece.faces].all(axis=1))


def _has_area(piece: Piece) -> BoolArray:
    triangles = piece.vertices[piece.faces]
    longest = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
    return np.asarray(2.0 * areas_of(triangles) > THINNEST * longest**2)
