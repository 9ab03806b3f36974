import json

import cv2
import numpy as np
import pytest

TURNED = [0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 0, 5, 1, 7, 1]
"""By columns: (x, y, z) -> (2 z + 5, 2 y + 1, 2 x + 7): a quarter turn, mirrored, twice as large."""
MOVED = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 1.1, -2, 1]


def quad(corners, mtl="shell.mtl", material="paint"):
    """.obj of a quad, counter-clockwise, with texture coordinates (0, 0) at the first corner."""
    lines = [f"mtllib {mtl}", *("v {} {} {}".format(*corner) for corner in corners)]
    lines += ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1", f"usemtl {material}", "f 1/1 2/2 3/3 4/4"]
    return "\n".join(lines)


def level_quad(height):
    return quad([(0, height, 3), (4, height, 3), (4, height, 0), (0, height, 0)])


# A tetrahedron with its corners at the origin and on the axes, seen from outside.
WEDGE = """mtllib wedge.mtl
v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nvt 0.25 0.25\nusemtl wood_0
f 1/1 3/1 2/1\nf 1/1 2/1 4/1\nusemtl wood_1\nf 1/1 4/1 3/1\nf 2/1 3/1 4/1
"""

NODES = [
    {"id": "0_0", "type": "Ground", "valid": 1, "modelId": "fr_0gd_0"},
    {
        "id": "0_1",
        "type": "Room",
        "valid": 1,
        "modelId": "fr_0rm_1",
        "nodeIndices": [2],
        "roomTypes": ["Living_Room", "Kitchen"],
        "hideCeiling": 1,
        "bbox": {"min": [0, 0, 0], "max": [4, 2.5, 3]},
    },
    {"id": "0_2", "type": "Object", "valid": 1, "modelId": "wedge", "isMirrored": 1, "transform": TURNED},
    {
        "id": "0_3",
        "type": "Box",
        "valid": 1,
        "dimensions": [1, 2, 4],
        "transform": MOVED,
        "materials": [{"diffuse": f"#{k}0{k}0{k}0"} for k in range(1, 7)],
    },
    {"id": "0_4", "type": "Object", "valid": 0, "modelId": "gone"},
]


@pytest.fixture
def dataset(tmp_path):
    """A function that writes a dataset of one house, and returns the path of its house.json.

    Its room is 4 x 3 m, walls 2.5 m high, with a floor at a height of 0.1; there is a tetrahedron and a box in it.
    Arguments: nodes, or top-level entries of house.json by name.
    """

    def write(nodes=NODES, folder="root", **entries):
        root = tmp_path / folder
        room = root / "room" / "h1"
        for place in (room, root / "object" / "wedge", root / "texture", root / "house" / "h1"):
            place.mkdir(parents=True)
        (room / "shell.mtl").write_text("newmtl paint\nKd 0.5 0.6 0.7\n")
        (room / "fr_0gd_0f.obj").write_text(level_quad(0))
        (room / "fr_0rm_1f.obj").write_text(level_quad(0.1))
        (room / "fr_0rm_1c.obj").write_text(level_quad(2.5))
        (room / "fr_0rm_1w.obj").write_text(quad([(0, 0.1, 0), (4, 0.1, 0), (4, 2.5, 0), (0, 2.5, 0)]))
        (root / "object" / "wedge" / "wedge.obj").write_text(WEDGE)
        (root / "object" / "wedge" / "wedge.mtl").write_text(
            "newmtl wood_0\nKd 1 1 1\nmap_Kd ../../texture/tiles.png\n\nnewmtl wood_1\nKd 0 0.5 0\n"
        )
        red = np.zeros((2, 2, 3), np.uint8)
        red[..., 2] = 255  # OpenCV writes blue, green, red
        cv2.imwrite(str(root / "texture" / "red.jpg"), red)
        tiles = np.array([[[10, 20, 30], [40, 50, 60]], [[70, 80, 90], [100, 110, 120]]], np.uint8)
        cv2.imwrite(str(root / "texture" / "tiles.png"), tiles[..., ::-1])
        house = {
            "version": "suncg@1.0.0",
            "id": "h1",
            "up": [0, 1, 0],
            "front": [0, 0, 1],
            "scaleToMeters": 1,
            "levels": [{"id": "0", "valid": 1, "nodes": nodes}],
        } | entries
        path = root / "house" / "h1" / "house.json"
        path.write_text(json.dumps(house))
        return path

    return write
