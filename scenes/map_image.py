"""Grey images of maps: PGM, written and read, and PNG, read."""

import re
import struct

import cv2
import numpy as np
from numpy.typing import NDArray

from slamgym.errors import SceneError
from slamgym.types import FloatArray

TEXT_BYTES_PER_PIXEL = 8
"""A number of up to five digits and what sets it off."""

_GAP = rb"(?:\s|#[^\n]*\n)+"
_PGM = re.compile(rb"(P[25])" + _GAP + rb"(\d{1,9})" + _GAP + rb"(\d{1,9})" + _GAP + rb"(\d{1,5})\s")
_PNG = re.compile(rb"\x89PNG\r\n\x1a\n....IHDR(.{8})", re.DOTALL)


def encode_pgm(grey: NDArray[np.integer]) -> bytes:
    """The file of an image (H, W) of values from 0 to 255."""
    height, width = grey.shape
    return b"P5\n%d %d\n255\n" % (width, height) + grey.astype(np.uint8).tobytes()


def decode_grey(content: bytes, max_pixels: int) -> FloatArray:
    """Brightness (H, W), 0 to 1, the mean of the colours, of a PGM or PNG file; NaN where it is not opaque.

    Raises SceneError; nothing is decoded that says it is larger than `max_pixels`.
    """
    if match := _PGM.match(content):
        width, height = _checked_size(int(match[2]), int(match[3]), max_pixels)
        return _decode_pgm(match[1] == b"P2", int(match[4]), content[match.end() :], (height, width))
    if match := _PNG.match(content):
        width, height = struct.unpack(">II", match[1])
        _checked_size(width, height, max_pixels)
        return _decode_png(content)
    raise SceneError(f"expected a PGM (P5, P2) or PNG image, got {content[:12]!r}...; convert it")


def _checked_size(width: int, height: int, max_pixels: int) -> tuple[int, int]:
    if not 0 < width * height <= max_pixels:
        raise SceneError(f"expected an image of 1 to {max_pixels} pixels, got {width} x {height}; scale it")
    return width, height


def _decode_pgm(plain: bool, largest: int, body: bytes, shape: tuple[int, int]) -> FloatArray:
    count = shape[0] * shape[1]
    try:
        if plain:
            values = np.fromstring(body[: TEXT_BYTES_PER_PIXEL * count], np.int32, sep=" ")[:count]
        else:
            values = np.frombuffer(body, np.uint8 if largest < 256 else ">u2", count).astype(np.int32)
    except ValueError:
        values = np.zeros(0, np.int32)
    if len(values) < count or largest == 0 or values.min() < 0 or values.max() > largest:
        raise SceneError(
            f"expected a PGM image of {shape[1]} x {shape[0]} values up to {largest}, got fewer, or others; "
            "save it again"
        )
    return values.reshape(shape) / np.float64(largest)


def _decode_png(content: bytes) -> FloatArray:
    log = cv2.utils.logging
    level = log.getLogLevel()
    log.setLogLevel(log.LOG_LEVEL_SILENT)
    try:
        image = cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_UNCHANGED)
    except cv2.error:
        image = None
    finally:
        log.setLogLevel(level)
    if image is None:
        raise SceneError("expected a PNG image, got one that is cut off or damaged; save it again")
    largest = 255 if image.dtype == np.uint8 else 65535
    colours = image[..., :3].mean(axis=2) if image.ndim == 3 else image
    transparent = image.ndim == 3 and image.shape[2] == 4 and image[..., 3] < largest
    return np.where(transparent, np.nan, colours / np.float64(largest))
