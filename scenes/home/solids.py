"""Simple solids as triangles with texture coordinates in metres: what procedural houses are made of.

Faces are counter-clockwise seen from outside. Vertices are not shared across sharp edges, so that light can be baked
per vertex.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from slamgym.types import FloatArray, IntArray

Interval = tuple[float, float]

_BOX_FACES = np.array([[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]])
_UNIT_SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """vertices: float64 (V, 3), metres. faces: int64 (F, 3). uv: float64 (V, 2), metres, or [0, 1] for a picture."""

    vertices: FloatArray
    faces: IntArray
    uv: FloatArray


def merge(meshes: Iterable[Mesh]) -> Mesh:
    """One mesh of several."""
    meshes = list(meshes)
    starts = np.cumsum([0] + [len(m.vertices) for m in meshes[:-1]])
    return Mesh(
        np.concatenate([m.vertices for m in meshes]),
        np.concatenate([m.faces + start for m, start in zip(meshes, starts, strict=True)]),
        np.concatenate([m.uv for m in meshes]),
    )


def placed(mesh: Mesh, yaw: float = 0.0, at: ArrayLike = (0.0, 0.0, 0.0)) -> Mesh:
    """The mesh turned by `yaw`, radians, about the vertical axis through its origin, then moved to `at`, metres."""
    c, s = np.cos(yaw), np.sin(yaw)
    R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return Mesh(mesh.vertices @ R.T + np.asarray(at, dtype=np.float64), mesh.faces, mesh.uv)


def stretched(mesh: Mesh, x: float = 1.0, y: float = 1.0, z: float = 1.0) -> Mesh:
    """The mesh scaled about its origin by positive factors; an ellipse from a circle."""
    return Mesh(mesh.vertices * (x, y, z), mesh.faces, mesh.uv)


def tilted(mesh: Mesh, pitch: float, at: ArrayLike = (0.0, 0.0, 0.0)) -> Mesh:
    """The mesh turned by `pitch`, radians, about its x axis (positive lifts the +y side), then moved to `at`."""
    c, s = np.cos(pitch), np.sin(pitch)
    R = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    return Mesh(mesh.vertices @ R.T + np.asarray(at, dtype=np.float64), mesh.faces, mesh.uv)


def quads(corners: ArrayLike, uv: ArrayLike | None = None) -> Mesh:
    """Flat quads from corners (N, 4, 3), counter-clockwise.

    uv: (N, 4, 2); without it each quad is projected onto its own plane with u along its longer side, so that the
    grain of wood runs lengthwise.
    """
    corners = np.asarray(corners, dtype=np.float64)
    first = 4 * np.arange(len(corners))[:, None, None]
    faces = first + np.array([[0, 1, 2], [0, 2, 3]])
    uv = _planar_uv(corners) if uv is None else np.asarray(uv, dtype=np.float64)
    return Mesh(corners.reshape(-1, 3), faces.reshape(-1, 3), uv.reshape(-1, 2))


def _planar_uv(corners: FloatArray) -> FloatArray:
    sides = np.stack([corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0]], axis=1)
    lengths = np.linalg.norm(sides, axis=2, keepdims=True)
    axes = sides / np.maximum(lengths, 1e-9)
    swap = lengths[:, 1, 0] > lengths[:, 0, 0]
    axes[swap] = axes[swap, ::-1]
    uv: FloatArray = np.einsum("nck,nak->nca", corners, axes)
    return uv


def box(x: Interval, y: Interval, z: Interval) -> Mesh:
    """A closed axis-aligned box."""
    corners = np.array([(x[i & 1], y[i >> 1 & 1], z[i >> 2]) for i in range(8)])
    return quads(corners[_BOX_FACES])


def _bevel_strips() -> IntArray:
    """The quads (12, 4) between the inset faces of a bevelled box; vertex 3 * corner + axis is on that axis' face."""
    loops = [(axis // 2, loop.tolist()) for axis, loop in enumerate(_BOX_FACES)]
    side = {(p, q): axis for axis, loop in loops for p, q in zip(loop, loop[1:] + loop[:1], strict=True)}
    return np.array(
        [(3 * q + a, 3 * p + a, 3 * p + side[q, p], 3 * q + side[q, p]) for (p, q), a in side.items() if p < q]
    )


_BEVEL_QUADS = np.concatenate([3 * _BOX_FACES + np.array([[0], [0], [1], [1], [2], [2]]), _bevel_strips()])
_BEVEL_TIPS = np.array([[0, 1, 2] if i.bit_count() % 2 else [0, 2, 1] for i in range(8)]) + 3 * np.arange(8)[:, None]


def bevelled(x: Interval, y: Interval, z: Interval, edge: float = 0.006) -> Mesh:
    """A closed box whose edges are cut off, `edge` metres of each face."""
    centre, half = (np.array([[x[k], y[k], z[k]] for k in (0, 1)]).T @ ((0.5, -0.5), (0.5, 0.5))).T
    edge = min(edge, 0.45 * float(half.min()))
    signs = np.array([(2 * (i & 1) - 1, (i & 2) - 1, (i >> 1 & 2) - 1) for i in range(8)])
    vertices = centre + (signs[:, None, :] * (half - edge * (1.0 - np.eye(3)))).reshape(-1, 3)
    tips = vertices[_BEVEL_TIPS].reshape(-1, 3)
    corners = Mesh(tips, np.arange(24).reshape(-1, 3), tips[:, :2])
    return merge([quads(vertices[_BEVEL_QUADS]), corners])


def border(x: Interval, y: Interval, z: Interval, bar: float) -> Mesh:
    """Four bars, `bar` wide, inside the edges of an upright rectangle: a frame."""
    return merge(
        [
            box((x[0], x[0] + bar), y, z),
            box((x[1] - bar, x[1]), y, z),
            box((x[0] + bar, x[1] - bar), y, (z[0], z[0] + bar)),
            box((x[0] + bar, x[1] - bar), y, (z[1] - bar, z[1])),
        ]
    )


def picture(width: float, z: Interval, y: float) -> Mesh:
    """An upright rectangle, centred on x = 0, that faces +y and shows the whole texture once."""
    left, right = width / 2, -width / 2  # seen from +y
    corners = [(left, y, z[0]), (right, y, z[0]), (right, y, z[1]), (left, y, z[1])]
    return quads([corners], [_UNIT_SQUARE])


def sheet(x: Interval, y: Interval, z: float) -> Mesh:
    """A level rectangle that faces up and shows the whole texture once."""
    corners = [(x[0], y[0], z), (x[1], y[0], z), (x[1], y[1], z), (x[0], y[1], z)]
    return quads([corners], [_UNIT_SQUARE])


def lathe(
    profile: Sequence[tuple[float, float]], at: ArrayLike = (0.0, 0.0, 0.0), sides: int = 16, roundness: float = 1.0
) -> Mesh:
    """A solid of revolution about the vertical axis through `at`.

    profile: (radius, height) pairs, bottom first along the outside; closed when it starts and ends on the axis or
    where it began. roundness: 1 for circles, less for rectangles with round corners.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, sides + 1)
    ring = np.stack([_signed_power(np.cos(angle), roundness), _signed_power(np.sin(angle), roundness)], axis=1)
    ring[-1] = ring[0]  # exactly the first again
    outline = np.array(profile, dtype=np.float64)
    ends = np.stack([outline[:-1], outline[1:]], axis=1)  # of the bands (M, 2, 2)
    radius, height = ends[..., :1, None], np.broadcast_to(ends[..., 1:, None], (len(ends), 2, sides + 1, 1))
    vertices = np.concatenate([radius * ring, height], axis=-1).reshape(-1, 3) + np.asarray(at, dtype=np.float64)
    return Mesh(vertices, _band_faces(ends[..., 0], sides), _band_uv(ends, sides).reshape(-1, 2))


def _band_uv(ends: FloatArray, sides: int) -> FloatArray:
    """Metres around and along the outline, (M, 2, sides + 1, 2)."""
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    along = ends[:, :1, 1] + np.stack([np.zeros_like(length), length], axis=1)
    around = 2.0 * np.pi * ends[..., 0].max(axis=1)[:, None, None] * np.linspace(0.0, 1.0, sides + 1)
    return np.stack(np.broadcast_arrays(around, along[..., None]), axis=-1)


def _band_faces(radii: FloatArray, sides: int) -> IntArray:
    """Two triangles a side; where a band (M, 2) starts or ends on the axis, one."""
    i = np.arange(sides)
    lower = np.stack([i, i + 1, i + sides + 2], axis=1)
    upper = np.stack([i, i + sides + 2, i + sides + 1], axis=1)
    first = 2 * (sides + 1) * np.arange(len(radii))[:, None, None]
    kept = [(first + corners)[radii[:, end] > 0.0].reshape(-1, 3) for end, corners in ((0, lower), (1, upper))]
    return np.concatenate(kept)


def cylinder(radius: float, z: Interval, at: Interval = (0.0, 0.0), sides: int = 12) -> Mesh:
    """A closed upright cylinder."""
    return lathe([(0.0, z[0]), (radius, z[0]), (radius, z[1]), (0.0, z[1])], (*at, 0.0), sides)


def ball(radius: float, at: tuple[float, float, float]) -> Mesh:
    """A closed sphere of few faces: fruit, blossoms."""
    r, d = radius, 0.7 * radius
    return lathe([(0.0, -r), (d, -d), (r, 0.0), (d, d), (0.0, r)], at, sides=8)


def cushion(x: Interval, y: Interval, z: Interval, softness: float = 0.35) -> Mesh:
    """A closed box with round edges: a superellipsoid, from nearly a box (softness 0.2) to an ellipsoid (1.0)."""
    low, high = np.array([x, y, z]).T
    latitude = np.linspace(-np.pi / 2, np.pi / 2, 7)
    longitude = np.linspace(0.0, 2.0 * np.pi, 17)
    cos_lat, sin_lat = _signed_power(np.cos(latitude), softness), _signed_power(np.sin(latitude), softness)
    cos_lon, sin_lon = _signed_power(np.cos(longitude), softness), _signed_power(np.sin(longitude), softness)
    unit = np.stack(np.broadcast_arrays(cos_lat[:, None] * cos_lon, cos_lat[:, None] * sin_lon, sin_lat[:, None]), -1)
    vertices = ((low + high) / 2 + unit * (high - low) / 2).reshape(-1, 3)
    uv = np.column_stack([vertices[:, 0] + 0.5 * vertices[:, 2], vertices[:, 1] + vertices[:, 2]])
    return Mesh(vertices, _globe_faces(len(latitude), len(longitude)), uv)


def _signed_power(values: FloatArray, exponent: float) -> FloatArray:
    values = np.where(np.abs(values) < 1e-12, 0.0, values)  # poles and the seam meet exactly
    return np.sign(values) * np.abs(values) ** exponent


def _globe_faces(rows: int, columns: int) -> IntArray:
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = row * columns + column
    lower = np.stack([a, a + 1, a + columns + 1], axis=-1)[1:]  # nothing below the south pole
    upper = np.stack([a, a + columns + 1, a + columns], axis=-1)[:-1]
    return np.concatenate([lower.reshape(-1, 3), upper.reshape(-1, 3)])


def ribbon(path: FloatArray, thickness: float, z: Interval) -> Mesh:
    """A closed upright sheet along a path (N, 2) on the floor: a curtain."""
    along = np.gradient(path, axis=0)
    normal = np.column_stack([-along[:, 1], along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True)
    left, right = path + normal * thickness / 2, path - normal * thickness / 2
    outline = np.concatenate([right, left[::-1]])
    following = np.roll(outline, -1, axis=0)
    sides = [_upright(a, b, z) for a, b in zip(outline, following, strict=True)]
    strips = zip(right[:-1], right[1:], left[1:], left[:-1], strict=True)
    caps = [[(*p, height) for p in turn] for strip in strips for height, turn in ((z[1], strip), (z[0], strip[::-1]))]
    return quads(np.array(sides + caps))


def _upright(a: FloatArray, b: FloatArray, z: Interval) -> list[tuple[float, float, float]]:
    return [(a[0], a[1], z[0]), (b[0], b[1], z[0]), (b[0], b[1], z[1]), (a[0], a[1], z[1])]
