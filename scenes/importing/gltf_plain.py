"""glTF files as trimesh reads them rightly: what it would pass over is said in plain words, or told.

A flat picture needs a base colour and whether a surface shines; trimesh reads triangles and one set of texture
coordinates. The JSON of a file is changed accordingly, its binary content never.
"""

import json
import struct
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from slamgym.scenes.importing.names import listed

Tree = dict[str, Any]

SHINING = 0.5
"""Emissive factor from which on a surface is its own light: a bulb or a screen, not a glow."""
SHINES: Tree = {"emissiveFactor": [1.0, 1.0, 1.0]}
"""What `prepared` leaves of emission: materials have this when they shine, and else nothing."""
SOLID = "slamgym_solid"
"""Under this key of a mesh's `extras`: false for what a robot does not bump into."""
UNLIT = "KHR_materials_unlit"
GLOSSINESS = "KHR_materials_pbrSpecularGlossiness"
TEXTURE_TRANSFORM = "KHR_texture_transform"
INSTANCES = "EXT_mesh_gpu_instancing"
TRIANGLES, STRIP = 4, 5


def prepared(data: bytes, header: Tree) -> tuple[bytes, Tree, list[str]]:
    """A .glb or .gltf file and its JSON, for trimesh, and a line for each kind of what is left out.

    header: the file's JSON, checked by `check_gltf`. Raises any error for what is malformed otherwise.
    """
    if not header:
        return data, header, []
    accessors, losses = list(header.get("accessors", ())), _Losses()
    materials = [flat_material(material) for material in header.get("materials", ())]
    meshes = [_plain_mesh(mesh, materials, accessors, losses) for mesh in header.get("meshes", ())]
    empty = {index for index, mesh in enumerate(meshes) if not mesh["primitives"]}
    nodes = [_without_mesh(node) if node.get("mesh") in empty else node for node in header.get("nodes", ())]
    changed = {"accessors": accessors, "materials": materials, "meshes": meshes, "nodes": nodes}
    tree = {key: changed.get(key, value) for key, value in header.items()}
    return data if tree == header else _with_json(data, tree), tree, [*losses.told(), *_instances(nodes)]


def flat_material(material: Tree) -> Tree:
    """The material in one colour, with one texture: what is seen of it where no light falls on it, if it shines.

    What is unlit has its light in its colour already, as scans do. A colour that adds to an emissive one is added here;
    an emissive texture is taken where there is no other: no image of both could be shown.
    """
    plain = {key: value for key, value in material.items() if key not in ("emissiveFactor", "emissiveTexture")}
    if UNLIT in material.get("extensions", {}):
        return plain | SHINES
    glow, picture = material.get("emissiveFactor", (0.0, 0.0, 0.0)), material.get("emissiveTexture")
    if max(glow) < SHINING:
        return plain
    base, look = base_texture(material), material.get("pbrMetallicRoughness", {})
    *colour, alpha = look.get("baseColorFactor", (1.0, 1.0, 1.0, 1.0))
    if not base and not picture:
        total = [min(a + b, 1.0) for a, b in zip(colour, glow, strict=True)]
        return plain | SHINES | {"pbrMetallicRoughness": look | {"baseColorFactor": [*total, alpha]}}
    if not base:
        shown = {"baseColorFactor": [*glow, alpha], "baseColorTexture": picture}
        return plain | SHINES | {"pbrMetallicRoughness": look | shown}
    return plain | SHINES if not picture or picture["index"] == base["index"] else plain


def base_texture(material: Mapping[str, Any]) -> Mapping[str, Any]:
    """The texture of a material's base colour, as the file names it; empty without."""
    glossy = material.get("extensions", {}).get(GLOSSINESS, {})
    found = glossy.get("diffuseTexture") or material.get("pbrMetallicRoughness", {}).get("baseColorTexture")
    return found or {}


class _Losses:
    """Names of meshes of which something is left out."""

    def __init__(self) -> None:
        self.primitives: list[str] = []
        self.corners: list[str] = []

    def told(self) -> Iterator[str]:
        if self.primitives:
            yield f"primitives left out: expected triangles or strips of them, got others, in {listed(self.primitives)}"
        if self.corners:
            yield f"corners left out: expected three for each triangle, got a rest, in {listed(self.corners)}"


def _plain_mesh(mesh: Tree, materials: Sequence[Tree], accessors: list[Tree], losses: _Losses) -> Tree:
    """The mesh with the primitives that trimesh can read; accessors: gets those of shortened ones."""
    given, name = mesh["primitives"], str(mesh.get("name", "unnamed"))
    kept = [p for p in given if p.get("mode", TRIANGLES) in (TRIANGLES, STRIP) and _corners(p, accessors) >= 3]
    if len(kept) < len(given):
        losses.primitives.append(name)
    whole = [_whole(primitive, accessors) for primitive in kept]
    if whole != kept:
        losses.corners.append(name)
    return {**mesh, "primitives": [_with_one_uv(primitive, materials) for primitive in whole]}


def _corners(primitive: Tree, accessors: Sequence[Tree]) -> int:
    return int(accessors[primitive.get("indices", primitive["attributes"]["POSITION"])]["count"])


def _whole(primitive: Tree, accessors: list[Tree]) -> Tree:
    """The primitive without the corners after its last whole triangle."""
    count = _corners(primitive, accessors)
    if primitive.get("mode", TRIANGLES) == STRIP or count % 3 == 0:
        return primitive

    def shortened(index: int) -> int:
        accessors.append({**accessors[index], "count": count - count % 3})
        return len(accessors) - 1

    if "indices" in primitive:
        return {**primitive, "indices": shortened(primitive["indices"])}
    return {**primitive, "attributes": {name: shortened(index) for name, index in primitive["attributes"].items()}}


def _with_one_uv(primitive: Tree, materials: Sequence[Tree]) -> Tree:
    """The primitive with the texture coordinates that its material asks for as the first, the only ones read."""
    texture = base_texture(materials[primitive["material"]]) if "material" in primitive else {}
    moved = texture.get("extensions", {}).get(TEXTURE_TRANSFORM, {})
    number = moved.get("texCoord", texture.get("texCoord", 0))
    if number == 0:
        return primitive
    attributes = {name: index for name, index in primitive["attributes"].items() if name != "TEXCOORD_0"}
    wanted = attributes.get(f"TEXCOORD_{number}")
    return {**primitive, "attributes": attributes if wanted is None else {**attributes, "TEXCOORD_0": wanted}}


def _without_mesh(node: Tree) -> Tree:
    return {key: value for key, value in node.items() if key != "mesh"}


def _instances(nodes: Sequence[Tree]) -> Iterator[str]:
    instanced = [str(node.get("name", k)) for k, node in enumerate(nodes) if INSTANCES in node.get("extensions", {})]
    if instanced:
        yield f"instances left out: expected a node for each, got {INSTANCES}, in {listed(instanced)}"


def _with_json(data: bytes, tree: Tree) -> bytes:
    """The file with another JSON, https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#glb-file-format-specification."""
    text = json.dumps(tree).encode()
    if data[:4] != b"glTF":
        return text
    rest = data[20 + int.from_bytes(data[12:16], "little") :]
    header = data[:8] + struct.pack("<II", 20 + len(text) + len(rest), len(text)) + data[16:20]
    return header + text + rest
