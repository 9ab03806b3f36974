"""Textures of other people's files: image files and images as uint8 arrays, bounded in size."""

from io import BytesIO

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from slamgym.errors import SceneError

FORMATS = ("BMP", "GIF", "JPEG", "PNG", "TGA", "TIFF", "WEBP")
"""What is decoded. Pillow knows more, and starts a program for some of it."""
MAX_SIDE = 2048
MAX_PIXELS = 1 << 27
HALF_CLEAR = 128


def decode_texture(data: bytes, opaque: bool = False) -> NDArray[np.uint8]:
    """The image of a file's content, see `texture_of`; raises SceneError."""
    return texture_of(_open(data), opaque)


def check_image(data: bytes) -> None:
    """Raise SceneError when data is not that of an image in one of FORMATS; nothing is decoded."""
    _open(data)


def texture_of(image: Image.Image, opaque: bool = False) -> NDArray[np.uint8]:
    """uint8 (H, W, 3), sRGB, at most 2048 pixels a side; larger ones are scaled down.

    Where the image is more clear than not, it takes the mean colour of the rest, as what lies behind is not known;
    `opaque`: its alpha is not looked at. Raises SceneError for an image that cannot be decoded, is in none of FORMATS,
    or has more than 2^27 pixels, of which none is decoded.
    """
    if image.format is not None and image.format not in FORMATS:
        raise SceneError(f"expected an image in one of {', '.join(FORMATS)}, got {image.format}; convert it")
    if image.width * image.height > MAX_PIXELS:
        raise SceneError(f"expected at most {MAX_PIXELS} pixels, got {image.width} x {image.height}; scale it down")
    try:
        image.draft("RGB", (MAX_SIDE, MAX_SIDE))
        pixels = image.convert("RGBA" if image.has_transparency_data and not opaque else "RGB")
        pixels.thumbnail((MAX_SIDE, MAX_SIDE), Image.Resampling.BOX)
    except MemoryError:
        raise
    except Exception as error:  # a broken file may fail in any way
        raise _unreadable(error) from None
    return _without_alpha(np.array(pixels))


def _without_alpha(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Pixels (H, W, 3) of (H, W, 3 or 4), their clear ones in the mean colour of the others."""
    colours = np.ascontiguousarray(pixels[..., :3])
    if pixels.shape[2] == 4 and (clear := pixels[..., 3] < HALF_CLEAR).any() and not clear.all():
        colours[clear] = colours[~clear].mean(axis=0).round().astype(np.uint8)
    return colours


def _open(data: bytes) -> Image.Image:
    try:
        return Image.open(BytesIO(data), formats=FORMATS)
    except Exception as error:  # a broken file may fail in any way
        raise _unreadable(error) from None


def _unreadable(error: Exception) -> SceneError:
    why = "something else" if isinstance(error, UnidentifiedImageError) else " ".join(str(error).split())[:200]
    return SceneError(f"expected an image in one of {', '.join(FORMATS)}, got: {why}; save it again")
