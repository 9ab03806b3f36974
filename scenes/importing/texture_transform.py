"""The glTF extension KHR_texture_transform, by which one texture is repeated, moved and turned on a surface."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from slamgym.scenes.importing.gltf_plain import TEXTURE_TRANSFORM, base_texture
from slamgym.scenes.importing.pieces import Piece
from slamgym.types import FloatArray


def with_transforms(pieces: Sequence[Piece], header: Mapping[str, Any]) -> tuple[list[Piece], list[str]]:
    """The pieces with their uv transformed as the file's header says, and a line when some cannot be told apart."""
    materials = header.get("materials", ())
    names = Counter(material.get("name") for material in materials)
    wanted = {material.get("name"): T for material in materials if (T := _transform(material)) is not None}
    known = {name: T for name, T in wanted.items() if name is not None and names[name] == 1}
    told = (
        [] if len(known) == len(wanted) else ["textures: not moved as said for materials without a name of their own"]
    )
    return [_moved(piece, known.get(piece.material.name)) for piece in pieces], told


def _transform(material: Mapping[str, Any]) -> FloatArray | None:
    """T (3, 3) of texture coordinates whose v runs down; first they are scaled, then turned, then moved."""
    given = base_texture(material).get("extensions", {}).get(TEXTURE_TRANSFORM)
    if given is None:
        return None
    angle, (su, sv), (tu, tv) = given.get("rotation", 0.0), given.get("scale", (1, 1)), given.get("offset", (0, 0))
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c * su, s * sv, tu], [-s * su, c * sv, tv], [0.0, 0.0, 1.0]], dtype=np.float64)


def _moved(piece: Piece, T: FloatArray | None) -> Piece:
    if T is None or piece.uv is None or not np.isfinite(T).all():
        return piece
    down = np.stack([piece.uv[:, 0], 1.0 - piece.uv[:, 1]], axis=1) @ T[:2, :2].T + T[:2, 2]
    uv = np.stack([down[:, 0], 1.0 - down[:, 1]], axis=1).astype(np.float32)
    return replace(piece, uv=np.nan_to_num(uv, posinf=0.0, neginf=0.0))
