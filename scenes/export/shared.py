"""What the writers share: axes, image files, file names."""

import re

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from slamgym.errors import SceneError
from slamgym.scenes.house import House, Part
from slamgym.types import FloatArray

MAX_NAME_LENGTH = 100


def y_up(points: ArrayLike) -> FloatArray:
    """Points (..., 3) of the world, z up, as glTF and SUNCG have them: (x, y, z) -> (x, z, -y)."""
    x, y, z = np.moveaxis(np.asarray(points, dtype=np.float64), -1, 0)
    return np.stack([x, z, -y], axis=-1)


def png(texture: NDArray[np.uint8]) -> bytes:
    """An sRGB image (H, W, 3) as a PNG file."""
    return bytes(cv2.imencode(".png", np.ascontiguousarray(texture[..., ::-1]))[1])


def file_name(text: str) -> str:
    """`text` as the name of a file on any system: letters, digits, dots and dashes."""
    return re.sub(r"[^A-Za-z0-9.-]+", "_", text).strip("._")[:MAX_NAME_LENGTH] or "unnamed"


def pieces_of(house: House) -> dict[str, list[Part]]:
    """The parts that have faces, by the piece that they belong to; raises SceneError when none has."""
    pieces: dict[str, list[Part]] = {}
    for part in house.parts:
        if len(part.faces):
            pieces.setdefault(part.name.split("/")[0], []).append(part)
    if not pieces:
        raise SceneError(f"house {house.name!r}: expected faces to write, got none; load a scene that has some")
    return pieces
