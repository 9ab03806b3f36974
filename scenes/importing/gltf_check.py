"""What a glTF file asks for, looked at before it is read: counts, and extensions without which it makes no sense."""

import json
from collections.abc import Mapping
from typing import Any

from slamgym.errors import SceneError

MAX_NODES = 100_000
MAX_ELEMENTS = 50_000_000
NEEDED = (
    *("KHR_materials_unlit", "KHR_materials_specular", "KHR_materials_ior", "KHR_materials_transmission"),
    *("KHR_materials_emissive_strength", "KHR_materials_pbrSpecularGlossiness", "KHR_materials_clearcoat"),
    *("KHR_texture_transform", "EXT_texture_webp", "KHR_lights_punctual", "KHR_materials_volume"),
)
"""Extensions that a file may require: the geometry is right without them."""
JSON_CHUNK = b"JSON"


def gltf_header(data: bytes) -> dict[str, Any]:
    """The JSON of a .glb or .gltf file; raises SceneError when it is none, and ValueError for malformed JSON."""
    if data[:4] == b"glTF":
        if data[16:20] != JSON_CHUNK:
            raise SceneError(
                "expected a .glb file that begins with its JSON, got another or a truncated one; export it again"
            )
        data = data[20 : 20 + int.from_bytes(data[12:16], "little")]
    header = json.loads(data)
    if not isinstance(header, dict):
        raise SceneError(f"expected a JSON object, got a {type(header).__name__}; export the file again")
    return header


def check_gltf(header: Mapping[str, Any]) -> None:
    """Raise SceneError for what is too large or cannot be decoded."""
    if strange := sorted({str(name) for name in header.get("extensionsRequired", ())} - set(NEEDED)):
        raise SceneError(
            f"expected plain glTF, got one that requires {', '.join(strange)}; export it without compression"
        )
    for what, count, most in (
        ("nodes", len(header.get("nodes", ())), MAX_NODES),
        ("numbers in one accessor", max((a["count"] for a in header.get("accessors", ())), default=0), MAX_ELEMENTS),
    ):
        if count > most:
            raise SceneError(f"expected at most {most} {what}, got {count}; simplify the scene")


def textured_materials(header: Mapping[str, Any]) -> set[str | None]:
    """Names, None for none, such that all materials of the name have an image for their base colour."""
    textured: set[str | None] = set()
    plain: set[str | None] = set()
    for material in header.get("materials", ()):
        has_image = "baseColorTexture" in material.get("pbrMetallicRoughness", {})
        (textured if has_image else plain).add(material.get("name"))
    return textured - plain
