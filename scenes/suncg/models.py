"""The models of SUNCG's nodes: .obj files of the dataset, and boxes."""

import hashlib
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from slamgym.errors import SceneError
from slamgym.scenes.importing.data_root import DataRoot
from slamgym.scenes.importing.pieces import Piece, Pieces
from slamgym.scenes.importing.reader import read_pieces
from slamgym.scenes.suncg import box
from slamgym.scenes.suncg.house_file import Node, Override


class OverridingRoot(DataRoot):
    """A DataRoot whose .mtl files have a node's materials. made: files that are not on the disk, by name."""

    def __init__(self, root: DataRoot, overrides: Sequence[Override], made: Mapping[str, bytes]) -> None:
        super().__init__(root.folder)
        self._overrides, self._made = overrides, made
        self.failures: list[str] = []

    def read(self, name: str, base: str = "") -> bytes:
        data = self._made.get(name)
        if data is None:
            if not self.path_of(name, base).is_file():
                raise SceneError("expected a file, got none; put it there")
            data = super().read(name, base)
        return self._overridden(data) if name.lower().endswith(".mtl") and self._overrides else data

    def _overridden(self, mtl: bytes) -> bytes:
        """The .mtl with the n-th override in its n-th material, as SUNCGtoolbox has it."""
        head, *blocks = re.split(rb"(?im)^(?=[ \t]*newmtl\b)", mtl)
        lines = [self._lines(i, override) for i, override in enumerate(self._overrides)]
        return head + b"".join(
            _replaced(block, lines[i]) if i < len(lines) else block for i, block in enumerate(blocks)
        )

    def _lines(self, number: int, override: Override) -> dict[bytes, str]:
        """What a material is to say, by the first word of the line."""
        lines = {}
        try:
            if override.diffuse:
                lines[b"kd"] = "Kd {} {} {}".format(*_rgb(override.diffuse))
            if override.texture:
                lines[b"map_kd"] = f"map_Kd {self._texture(override.texture)}"
        except SceneError as error:
            self.failures.append(f"materials[{number}]: {error}")
        return lines

    def _texture(self, name: str) -> str:
        for suffix in ("png", "jpg"):
            if self.path_of(f"texture/{name}.{suffix}").is_file():
                return f"../../texture/{name}.{suffix}"
        raise SceneError(f"expected a file texture/{name}.png or .jpg, got none; put it there")


class Models:
    """Reads models, each once. Equal textures are one array, so that what merges by texture finds them.

    assumptions, defects: one line each, as in House; defects name the node.
    """

    def __init__(self, root: DataRoot, house_id: str) -> None:
        self._root, self._house_id = root, house_id
        self.assumptions: list[str] = []
        self.defects: list[str] = []
        self._models: dict[object, list[Piece] | SceneError] = {}
        self._textures: dict[bytes, NDArray[np.uint8]] = {}

    def of(self, node: Node) -> Iterator[tuple[str, Piece]]:
        """The pieces that a node shows, in the model's frame, each with what it is: "floor", or the model's id."""
        for kind, path in self._paths(node):
            key = (path, node.materials, node.dimensions if node.type == "Box" else None)
            if key not in self._models:
                self._models[key] = self._model(path, node)
            found = self._models[key]
            if isinstance(found, SceneError):
                self.defects.append(f"node {node.id}: {found}")
            else:
                yield from ((kind, piece) for piece in found)

    def _paths(self, node: Node) -> Iterator[tuple[str, str]]:
        """Kind and path below the root of a node's models; a Box has a path though it has no file."""
        room = f"room/{self._house_id}/{node.model}"
        if node.type == "Box":
            yield "box", "object/box/box.obj"
        elif node.type == "Object":
            yield node.model, f"object/{node.model}/{node.model}{'_0' if node.state else ''}.obj"
        elif node.type == "Ground" and not node.hide_floor:
            yield "ground", f"{room}f.obj"
        elif node.type == "Room":
            hidden = {"floor": node.hide_floor, "wall": node.hide_walls, "ceiling": node.hide_ceiling}
            yield from ((kind, f"{room}{kind[0]}.obj") for kind, hide in hidden.items() if not hide)

    def _model(self, path: str, node: Node) -> list[Piece] | SceneError:
        made = {path: box.box_obj(node.dimensions), box.MTL_NAME: box.MTL} if node.type == "Box" else {}
        root = OverridingRoot(self._root, node.materials, {name: text.encode() for name, text in made.items()})
        try:
            read = _read(root, path)
        except SceneError as error:
            return SceneError(f"{path}: {error}")
        self.assumptions += (f"{path}: {line}" for line in read.assumptions)
        self.defects += (f"node {node.id}: {path}: {line}" for line in root.failures + read.defects)
        return [self._shared(piece) for piece in read.pieces]

    def _shared(self, piece: Piece) -> Piece:
        """The piece with the array of an equal texture that came before."""
        texture = piece.material.texture
        if texture is None:
            return piece
        digest = hashlib.sha256(repr(texture.shape).encode() + texture.tobytes()).digest()
        texture = self._textures.setdefault(digest, texture)
        return replace(piece, material=replace(piece.material, texture=texture))


def _read(root: OverridingRoot, path: str) -> Pieces:
    """An .obj file as pieces; raises SceneError, which does not name the file."""
    read = read_pieces(root.read(path), "obj", root, path.rpartition("/")[0])
    if not (read.pieces or read.assumptions):
        raise SceneError("expected triangles, got none; export it again")
    return read


def _replaced(block: bytes, lines: Mapping[bytes, str]) -> bytes:
    """A material's lines, those that begin with a word of `lines` replaced, or added after the first."""
    kept = [line for line in block.splitlines() if (line.split() or [b""])[0].lower() not in lines]
    return b"\n".join([kept[0], *(line.encode() for line in lines.values()), *kept[1:]]) + b"\n"


def _rgb(diffuse: str) -> list[float]:
    """Factors of "#rrggbb"; raises SceneError."""
    if not re.fullmatch(r"#[0-9A-Fa-f]{6}", diffuse):
        raise SceneError(f"expected a colour like #a0522d, got {diffuse[:20]!r}; correct it")
    return [int(diffuse[i : i + 2], 16) / 255.0 for i in (1, 3, 5)]
