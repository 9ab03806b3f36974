"""Binary glTF 2.0, https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html.

trimesh writes it too, but rounds colours to 8 bits, which dark ones do not survive in glTF's linear scale.
"""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from slamgym.files import check_free, write_atomically
from slamgym.scenes.export.shared import pieces_of, png, y_up
from slamgym.scenes.extras import extras_of
from slamgym.scenes.house import House, Material, Part
from slamgym.scenes.importing.gltf_plain import SOLID, UNLIT
from slamgym.scenes.srgb import linear_of_srgb

FLOAT, UNSIGNED_INT = 5126, 5125
VERTEX_BUFFER, INDEX_BUFFER = 34962, 34963
_MAGIC, _JSON_CHUNK, _BINARY_CHUNK = b"glTF", b"JSON", b"BIN\0"


def write_glb(house: House, path: Path) -> Path:
    """Write a house as a .glb file, y up and in metres as glTF has it, and return its path.

    Colours of vertices are written, times the light where a part has some; its material is then marked as unlit, so
    that viewers show what the robot sees. In a house without baked light that is what shines by itself: for viewers
    that know no unlit materials it is written as emissive, too. Rooms, lamps, windows and whether the light is baked
    are in the scene's extras, see `slamgym.scenes.extras`, and what is not solid in those of meshes: slamgym reads the
    same house back, light above 1 cut off, and what shines as bright as it looks.
    Raises OutputError when there is another file at `path`, and SceneError for a house without faces.
    """
    check_free(path, "file")
    return write_atomically(path, _container(*_Document().filled(house)))


class _Document:
    """A glTF file as it grows: the JSON `tree`, and the `binary` that its buffer views are slices of."""

    def __init__(self) -> None:
        self.binary = bytearray()
        self.tree: dict[str, Any] = {"asset": {"version": "2.0", "generator": "slamgym"}, "scene": 0}
        self._materials: dict[tuple[int, bool], int] = {}
        self._baked = False
        self._textures: dict[int, int] = {}

    def filled(self, house: House) -> tuple[dict[str, Any], bytes]:
        self._baked = all(part.light is not None for part in house.parts)
        for name, piece in pieces_of(house).items():
            for more in ({}, {"extras": {SOLID: False}}):
                if primitives := [self._primitive(part) for part in piece if part.solid is not bool(more)]:
                    mesh = self._add("meshes", {"name": name, "primitives": primitives, **more})
                    self._add("nodes", {"name": name, "mesh": mesh})
        nodes = list(range(len(self.tree["nodes"])))
        self.tree["scenes"] = [{"name": house.name, "nodes": nodes, "extras": extras_of(house)}]
        if any("extensions" in material for material in self.tree["materials"]):
            self.tree["extensionsUsed"] = [UNLIT]
        self.tree["buffers"] = [{"byteLength": len(self.binary)}]
        return self.tree, bytes(self.binary)

    def _primitive(self, part: Part) -> dict[str, Any]:
        vertices = y_up(part.vertices).astype(np.float32)
        position = self._accessor(vertices, "VEC3", VERTEX_BUFFER)
        bounds = {"min": vertices.min(axis=0).tolist(), "max": vertices.max(axis=0).tolist()}
        self.tree["accessors"][position] |= bounds
        attributes = {"POSITION": position}
        if part.uv is not None:
            attributes["TEXCOORD_0"] = self._accessor(part.uv * (1, -1) + (0, 1), "VEC2", VERTEX_BUFFER)
        if (colour := _vertex_colour(part)) is not None:
            attributes["COLOR_0"] = self._accessor(linear_of_srgb(colour), "VEC3", VERTEX_BUFFER)
        indices = self._accessor(part.faces.reshape(-1), "SCALAR", INDEX_BUFFER)
        material = self._material(part.material, part.light is not None)
        return {"attributes": attributes, "indices": indices, "material": material}

    def _material(self, material: Material, lit: bool) -> int:
        key = (id(material), lit)
        if key not in self._materials:
            # glTF's factors are linear, slamgym's multiply sRGB values.
            colour = linear_of_srgb(material.colour).tolist()
            look: dict[str, Any] = {"baseColorFactor": [*colour, 1.0], "metallicFactor": 0.0}
            if material.texture is not None:
                look["baseColorTexture"] = {"index": self._texture(material.texture)}
            item = {"name": material.name, "pbrMetallicRoughness": look, "doubleSided": True}
            if lit:
                item["extensions"] = {UNLIT: {}}
            if lit and not self._baked:
                item["emissiveFactor"] = colour
                if material.texture is not None:
                    item["emissiveTexture"] = look["baseColorTexture"]
            self._materials[key] = self._add("materials", item)
        return self._materials[key]

    def _texture(self, texture: NDArray[np.uint8]) -> int:
        if id(texture) not in self._textures:
            image = {"mimeType": "image/png", "bufferView": self._view(png(texture))}
            self._textures[id(texture)] = self._add("textures", {"source": self._add("images", image)})
        return self._textures[id(texture)]

    def _accessor(self, values: NDArray[Any], kind: str, target: int) -> int:
        component, dtype = (UNSIGNED_INT, "<u4") if target == INDEX_BUFFER else (FLOAT, "<f4")
        view = self._view(values.astype(dtype).tobytes(), target=target)
        return self._add(
            "accessors", {"bufferView": view, "componentType": component, "count": len(values), "type": kind}
        )

    def _view(self, data: bytes, **more: int) -> int:
        start = len(self.binary)
        self.binary += data + b"\0" * (-len(data) % 4)
        return self._add("bufferViews", {"buffer": 0, "byteOffset": start, "byteLength": len(data), **more})

    def _add(self, kind: str, item: dict[str, Any]) -> int:
        items = self.tree.setdefault(kind, [])
        items.append(item)
        return len(items) - 1


def _vertex_colour(part: Part) -> NDArray[np.float32] | None:
    if part.colour is None or part.light is None:
        return part.light if part.colour is None else part.colour
    return part.colour * part.light


def _container(tree: dict[str, Any], binary: bytes) -> bytes:
    """The file: a header and two chunks, each a length, a type and content of a multiple of 4 bytes."""
    text = json.dumps(tree, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = [
        struct.pack("<I4s", len(data), kind) + data for kind, data in ((_JSON_CHUNK, text), (_BINARY_CHUNK, binary))
    ]
    return struct.pack("<4sII", _MAGIC, 2, 12 + sum(map(len, chunks))) + b"".join(chunks)
