"""What the meshes of procedural homes must be."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from slamgym.scenes.house import Part

OPEN_SHEETS = {"plane", "inner", "face", "view", "picture", "screen", "cover", "pile"}


def test_budget(home, size, most_triangles):
    assert sum(len(p.faces) for p in home.parts) <= most_triangles[size]
    assert len({id(p.material) for p in home.parts}) <= 110
    assert len({p.name for p in home.parts}) == len(home.parts)


def test_arrays_are_sound(home):
    for part in home.parts:
        assert part.vertices.dtype == np.float32
        assert part.faces.dtype == np.int32
        assert np.isfinite(part.vertices).all()
        assert part.faces.min() >= 0
        assert part.faces.max() < len(part.vertices)
        assert (part.uv is None) == (part.material.texture is None)
        if part.uv is not None:
            assert part.uv.shape == (len(part.vertices), 2)
            assert np.isfinite(part.uv).all()


def test_furniture_is_closed_and_faces_outward(home, pieces):
    for parts in pieces(home).values():
        for part in parts:
            if part.name.split("/")[1] not in OPEN_SHEETS:
                assert_closed_outward(part)


def assert_closed_outward(part: Part) -> None:
    """Every edge has a twin in the opposite direction, and each connected solid has positive volume."""
    _, weld = np.unique(part.vertices.round(5), axis=0, return_inverse=True)
    faces = weld.reshape(-1)[part.faces]
    kept = (faces != np.roll(faces, 1, axis=1)).all(axis=1)  # slivers that welding closes
    corners = part.vertices[part.faces[kept]].astype(np.float64)
    faces = faces[kept]
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    forward, backward = (sorted(map(tuple, e.tolist())) for e in (edges, edges[:, ::-1]))
    assert forward == backward, part.name
    corners -= corners.mean(axis=(0, 1))
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    labels = connected(faces)
    assert (np.bincount(labels, volume) > 0).all(), part.name


def connected(faces: np.ndarray) -> np.ndarray:
    pairs = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]])
    graph = coo_array((np.ones(len(pairs)), pairs.T), shape=(faces.max() + 1,) * 2)
    _, label = connected_components(graph, directed=False)
    return np.unique(label[faces[:, 0]], return_inverse=True)[1]


def test_room_surfaces_face_into_the_rooms(home, kind_of, bounds):
    for part in home.parts:
        kind, component = kind_of(part.name), part.name.split("/")[1]
        if kind in ("floor", "ceiling", "wall") and component in ("plane", "inner"):
            a, b, c = (part.vertices[part.faces[:, k]].astype(np.float64) for k in range(3))
            normals = np.cross(b - a, c - a)
            middle = bounds([part]).mean(axis=0)
            number = int(part.name.split("/")[0].rpartition("_")[2]) - 1
            room = home.rooms[number // 4 if kind == "wall" else number]
            centre = ((room.x_min + room.x_max) / 2, (room.y_min + room.y_max) / 2, 1.25)
            assert (normals @ (centre - middle) > 0).all(), part.name
