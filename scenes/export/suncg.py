"""SUNCG's layout: house/ID/house.json, room/ID/*.obj, object/ID/ID.obj, texture/*.png; y up, metres."""

import json
import re
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from slamgym.files import check_free, draft
from slamgym.scenes.export.obj import Texture, obj_text
from slamgym.scenes.export.shared import file_name, pieces_of, png, y_up
from slamgym.scenes.house import House, Part, Room
from slamgym.types import FloatArray

_SHELL = re.compile(r"(floor|wall|ceiling)(#.*|\d*([ _.-]\d+)*)", re.IGNORECASE)
"""#: the SUNCG loader names rooms' parts by their nodes, whose ids may be any text."""
_HIDE = {"floor": "hideFloor", "wall": "hideWalls", "ceiling": "hideCeiling"}
_EDGE_M = 0.3
"""The middle of a wall may be this far outside of its room, which ends at the wall's face."""


def write_suncg(house: House, root: Path) -> Path:
    """Write a house in SUNCG's layout into the new folder `root`, and return the path of its house.json.

    Pieces named floor, wall or ceiling, numbered or not, belong to the room that they are in; each other piece is an
    Object with a model of its own, standing at its origin. Baked light, lamps and windows have no place there, and the
    colours of a part's vertices become their mean. Raises OutputError when `root` holds files, SceneError for a house
    without faces.
    """
    check_free(root, "folder")
    pieces = pieces_of(house)
    house_id = file_name(Path(house.name).stem)
    with draft(root) as place:
        layout = _Layout(place, house_id)
        shells: defaultdict[tuple[int, str], list[Part]] = defaultdict(list)
        for name, piece in pieces.items():
            shell = _shell_of(name, piece, house.rooms)
            if shell is None:
                layout.add_object(name, piece)
            else:
                shells[shell] += piece
        for number, room in enumerate(house.rooms):
            layout.add_room(room, {kind: shells[number, kind] for kind in _HIDE})
        layout.finish()
    return root / "house" / house_id / "house.json"


class _Layout:
    """The files below `root` as they are written, and the nodes of house.json."""

    def __init__(self, root: Path, house_id: str) -> None:
        self._root, self._house_id = root, house_id
        self._nodes: list[dict[str, Any]] = []
        self._textures: dict[int, str] = {}
        self._names: set[str] = set()

    def add_object(self, name: str, piece: list[Part]) -> None:
        low, high = _bounds(piece)
        origin = np.array([(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2])
        model = self._unique(name)
        self._write_model(f"object/{model}/{model}", piece, origin)
        transform = np.eye(4)
        transform[:3, 3] = origin
        self._add_node("Object", model, low, high, transform=transform.T.ravel().tolist(), isMirrored=0)

    def add_room(self, room: Room, shell: dict[str, list[Part]]) -> None:
        """After the objects. The room's box is as high as its walls; what a room lacks is hidden."""
        model = self._unique(room.name)
        for kind, parts in shell.items():
            if parts:
                self._write_model(f"room/{self._house_id}/{model}{kind[0]}", parts, np.zeros(3))
        corners = y_up([(room.x_min, room.y_min, 0.0), (room.x_max, room.y_max, 0.0)])
        low, high = corners.min(axis=0), corners.max(axis=0)
        high[1] = _bounds(shell["wall"])[1][1] if shell["wall"] else 0.0
        hidden = {_HIDE[kind]: int(not parts) for kind, parts in shell.items()}
        inside = [i for i, node in enumerate(self._nodes) if _stands_in(node, low, high)]
        self._add_node("Room", model, low, high, roomTypes=[room.kind], nodeIndices=inside, **hidden)

    def finish(self) -> None:
        house = {
            "version": "suncg@1.0.0",
            "id": self._house_id,
            "up": [0, 1, 0],
            "front": [0, 0, 1],
            "scaleToMeters": 1,
            "levels": [{"id": "0", "valid": 1, "nodes": self._nodes}],
        }
        self._write(f"house/{self._house_id}/house.json", json.dumps(house, indent=1).encode())

    def _add_node(self, kind: str, model: str, low: FloatArray, high: FloatArray, **more: Any) -> None:
        node = {"id": f"0_{len(self._nodes)}", "type": kind, "valid": 1, "modelId": model}
        self._nodes.append(node | {"bbox": {"min": low.tolist(), "max": high.tolist()}} | more)

    def _write_model(self, path: str, parts: list[Part], origin: FloatArray) -> None:
        """path: below the root, without its suffix."""
        text = obj_text(Path(path).name, parts, origin, self._texture_file)
        self._write(f"{path}.obj", text.obj.encode())
        self._write(f"{path}.mtl", text.mtl.encode())

    def _texture_file(self, texture: Texture) -> str:
        """As a .mtl names it, which lies two folders below the root."""
        if id(texture) not in self._textures:
            name = f"texture_{len(self._textures)}.png"
            self._write(f"texture/{name}", png(texture))
            self._textures[id(texture)] = name
        return f"../../texture/{self._textures[id(texture)]}"

    def _write(self, path: str, content: bytes) -> None:
        file = self._root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)

    def _unique(self, name: str) -> str:
        """The name of a model's file; no two differ in capitals only, which some systems do not tell apart."""
        stem = unique = file_name(name)
        while unique.lower() in self._names:
            unique = f"{stem}-{len(self._names)}"
        self._names.add(unique.lower())
        return unique


def _shell_of(name: str, piece: list[Part], rooms: Iterable[Room]) -> tuple[int, str] | None:
    """The room's number and "floor", "wall" or "ceiling" where a piece is that of a room; else None."""
    if not (kind := _SHELL.fullmatch(name)):
        return None
    x, y = np.mean([(part.vertices.min(axis=0) + part.vertices.max(axis=0))[:2] / 2 for part in piece], axis=0)
    outside = [max(r.x_min - x, x - r.x_max, r.y_min - y, y - r.y_max) for r in rooms]
    if not outside or min(outside) > _EDGE_M:
        return None
    return int(np.argmin(outside)), kind[1].lower()


def _stands_in(node: dict[str, Any], low: FloatArray, high: FloatArray) -> bool:
    """Whether the middle of an Object's box is inside the walls, seen from above."""
    middle = (np.array(node["bbox"]["min"]) + node["bbox"]["max"]) / 2
    return bool(node["type"] == "Object" and ((low <= middle) & (middle <= high))[[0, 2]].all())


def _bounds(parts: Iterable[Part]) -> tuple[FloatArray, FloatArray]:
    """Low and high corner of the box around parts, y up."""
    corners = y_up(np.concatenate([part.vertices for part in parts]))
    return corners.min(axis=0), corners.max(axis=0)
