"""Grey images of maps: PGM, written and read, and PNG, read."""

import re
import struct
import warnings
from io import BytesIO

import numpy as np
from numpy.typing import NDArray
from PIL import Image

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
        return _decode_png(content, _checked_size(width, height, max_pixels))
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


def _decode_png(content: bytes, size: tuple[int, int]) -> FloatArray:
    try:
        with warnings.catch_warnings(action="ignore"):  # of the sizes of further headers
            Image.open(BytesIO(content), formats=("PNG",)).verify()  # to its end, which decoding does not look for
            with Image.open(BytesIO(content), formats=("PNG",)) as image:
                return _brightness(image, size)
    except Exception as error:  # a broken file may fail in any way
        why = " ".join(str(error).split())[:200]
        raise SceneError(f"expected a PNG image, got one that is cut off or damaged ({why}); save it again") from None


def _brightness(image: Image.Image, size: tuple[int, int]) -> FloatArray:
    if image.size != size:
        raise ValueError(f"two sizes, {size} and {image.size}")
    if image.mode.startswith("I"):  # grey of 16 bits
        return np.asarray(image) / np.float64(65535)
    pixels = np.asarray(image.convert("RGBA" if image.has_transparency_data else "RGB"))
    transparent = (pixels[..., 3:] < 255).any(axis=2)
    return np.where(transparent, np.nan, pixels[..., :3].mean(axis=2) / 255)
