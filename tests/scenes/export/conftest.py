import numpy as np
import pytest
from scipy.spatial import cKDTree

from slamgym.scenes.house import House, Lamp, Material, Part, Room, Window

TILES = np.array([[[10, 20, 30], [40, 50, 60]], [[70, 80, 90], [100, 110, 120]]], np.uint8)
"""The lower left pixel is (70, 80, 90)."""
PAINT, TILED = Material("paint: white", (0.9, 0.85, 0.2)), Material("tiles", (1.0, 0.5, 0.25), TILES)


def quad(name, material, corners, **more):
    uv = np.array([[0, 0], [1.3, 0], [1.3, 2.3], [0, 2.3]], np.float32)
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    return Part(
        name, material, np.array(corners, np.float32), faces, uv if material.texture is not None else None, **more
    )


def level(name, material, x, y, z, **more):
    return quad(name, material, [(x[0], y[0], z), (x[1], y[0], z), (x[1], y[1], z), (x[0], y[1], z)], **more)


def upright(name, x0, x1, y):
    return quad(name, PAINT, [(x0, y, 0), (x1, y, 0), (x1, y, 2.5), (x0, y, 2.5)])


@pytest.fixture
def house():
    """Two rooms side by side, a table of two parts, a floor lamp, and a shelf whose name begins with that of a wall."""
    light = np.linspace(0.25, 1.1, 12, dtype=np.float32).reshape(4, 3)
    colour = np.linspace(0.1, 1.0, 12, dtype=np.float32).reshape(4, 3)
    parts = (
        level("floor_1/plane", TILED, (0, 4), (0, 3), 0),
        level("floor_2/plane", PAINT, (4, 7), (0, 3), 0),
        level("ceiling_1/plane", PAINT, (0, 4), (3, 0), 2.5),
        upright("wall_1/inner", 0, 4, 3),
        upright("wall_2/inner", 4, 7, 3),
        upright("wall_shelf_1/board", 1, 2, 2.9),
        level("table_1/top", TILED, (1, 2), (1, 2), 0.7, light=light),
        level("table_1/drawer", PAINT, (1.1, 1.9), (1.1, 1.9), 0.6, colour=colour),
        level("floor_lamp_1/shade", PAINT, (5, 5.5), (1, 1.5), 1.6),
    )
    rooms = (Room("living room", "living_room", 0.0, 0.0, 4.0, 3.0), Room("bath", "bathroom", 4.0, 0.0, 7.0, 3.0))
    windows = (Window((0.0, 1.5, 1.5), (0.0, 0.5, 0.0), (0.0, 0.0, 0.5)),)
    return House("some/place/two rooms.glb", parts, rooms, (Lamp((2.0, 1.5, 2.4)),), windows)


@pytest.fixture
def matched():
    """A function that pairs the triangles of two houses, whichever corner comes first.

    Returns for each house the part and face (N, 2) of its triangles, matching ones in the same row. Fails unless each
    triangle of one is within 0.1 mm of one of the other.
    """

    def corners(house):
        triangles = [part.vertices[part.faces].reshape(-1, 9) for part in house.parts]
        index = [(number, face) for number, part in enumerate(house.parts) for face in range(len(part.faces))]
        return np.concatenate(triangles).astype(np.float64), np.array(index)

    def match(a, b):
        (ours, our_index), (theirs, their_index) = corners(a), corners(b)
        assert len(ours) == len(theirs)
        turned = np.concatenate([np.roll(theirs, 3 * k, axis=1) for k in range(3)])
        distance, nearest = cKDTree(turned).query(ours, p=np.inf)
        assert distance.max() < 1e-4
        back, _ = cKDTree(np.concatenate([np.roll(ours, 3 * k, axis=1) for k in range(3)])).query(theirs, p=np.inf)
        assert back.max() < 1e-4
        return our_index, their_index[nearest % len(theirs)]

    return match


@pytest.fixture
def seen():
    """A function that tells the colour, 0 to 255, at the middle of a part's face, without light and vertex colours."""

    def look(house, part, face):
        part = house.parts[part]
        texture, colour = part.material.texture, np.array(part.material.colour)
        if texture is None:
            return 255.0 * colour
        u, v = part.uv[part.faces[face]].mean(axis=0) % 1.0
        return texture[int((1.0 - v) * texture.shape[0]), int(u * texture.shape[1])] * colour

    return look
