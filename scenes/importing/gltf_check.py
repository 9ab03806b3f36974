"""What a glTF file asks for, looked at before it is read: counts, and extensions without which it makes no sense."""

import codecs
import json
from collections.abc import Mapping, Sequence
from typing import Any

from slamgym.errors import SceneError

MAX_NODES = 100_000
MAX_DEPTH = 1000
MAX_ELEMENTS = 50_000_000
LISTS = ("scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers", "materials", "textures", "images")
NEEDED = (
    *("KHR_materials_unlit", "KHR_materials_specular", "KHR_materials_ior", "KHR_materials_transmission"),
    *("KHR_materials_emissive_strength", "KHR_materials_pbrSpecularGlossiness", "KHR_materials_clearcoat"),
    *("KHR_texture_transform", "EXT_texture_webp", "KHR_lights_punctual", "KHR_materials_volume"),
)
"""Extensions that a file may require: the geometry is right without them."""
JSON_CHUNK = b"JSON"


def gltf_header(data: bytes) -> dict[str, Any]:
    """The JSON of a .glb or .gltf file; raises SceneError when it is none, and ValueError for malformed JSON."""
    if data[:4] != b"glTF" and not data.lstrip(codecs.BOM_UTF8 + b" \t\r\n").startswith(b"{"):
        raise SceneError("expected a glTF file, got one that does not begin with glTF or {; export it again")
    if data[:4] == b"glTF":
        if data[16:20] != JSON_CHUNK:
            raise SceneError(
                "expected a .glb file that begins with its JSON, got another or a truncated one; export it again"
            )
        data = data[20 : 20 + int.from_bytes(data[12:16], "little")]
    try:
        header = json.loads(data)
    except RecursionError:
        raise SceneError("expected JSON, got one that is nested too deeply; export the file again") from None
    if not isinstance(header, dict):
        raise SceneError(f"expected a JSON object, got a {type(header).__name__}; export the file again")
    return header


def check_gltf(header: Mapping[str, Any]) -> None:
    """Raise SceneError for what is malformed, too large or cannot be decoded."""
    for name in LISTS:
        given = header.get(name, [])
        if not (isinstance(given, list) and all(isinstance(item, dict) for item in given)):
            raise SceneError(f"expected {name} to be a list of objects, got {given!r:.40}; export the file again")
    if strange := sorted({str(name) for name in header.get("extensionsRequired", ())} - set(NEEDED)):
        raise SceneError(
            f"expected plain glTF, got one that requires {', '.join(strange)}; export it without compression"
        )
    for what, count, most in (
        ("nodes", len(header.get("nodes", ())), MAX_NODES),
        ("nodes one inside another", _depth(header.get("nodes", ())), MAX_DEPTH),
        ("numbers in one accessor", max(map(_count, header.get("accessors", ())), default=0), MAX_ELEMENTS),
    ):
        if count > most:
            raise SceneError(f"expected at most {most} {what}, got {count}; simplify the scene")


def _count(accessor: Mapping[str, Any]) -> int:
    count = accessor.get("count")
    if not isinstance(count, int):
        raise SceneError(f"expected each accessor to have a count, got {count!r:.40}; export the file again")
    return count


def _depth(nodes: Sequence[Mapping[str, Any]]) -> int:
    """How deep the trees of nodes are, up to one more than MAX_DEPTH. Circles are in no tree."""
    children = [_children(node) for node in nodes]
    seen = {child for inner in children for child in inner}
    layer, depth = [k for k in range(len(nodes)) if k not in seen], 0
    while layer and depth <= MAX_DEPTH:
        inner = {child for k in layer for child in children[k]} & seen
        seen -= inner
        layer, depth = [k for k in inner if 0 <= k < len(nodes)], depth + 1
    return depth


def _children(node: Mapping[str, Any]) -> list[int]:
    given = node.get("children", [])
    if not (isinstance(given, list) and all(isinstance(child, int) for child in given)):
        raise SceneError(f"expected a node's children to be numbers, got {given!r:.40}; export the file again")
    return given


def textured_materials(header: Mapping[str, Any]) -> set[str | None]:
    """Names, None for none, such that all materials of the name have an image for their base colour."""
    textured: set[str | None] = set()
    plain: set[str | None] = set()
    for material in header.get("materials", ()):
        has_image = "baseColorTexture" in material.get("pbrMetallicRoughness", {})
        (textured if has_image else plain).add(material.get("name"))
    return textured - plain
