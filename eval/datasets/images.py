"""Colour and depth images as PNG files: checked by their header before anything is decoded."""

import struct
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from slamgym.camera import PinholeCamera
from slamgym.errors import SequenceError

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
# Signature, length and name of the first chunk, then width, height, bits a channel and the kind of colour.
_HEADER = struct.Struct(">8s4x4sIIBB")
_GREY = 0


def read_colour(path: Path, camera: PinholeCamera) -> NDArray[np.uint8]:
    """The image as uint8 (H, W, 3), RGB; raises SequenceError unless it is a PNG of 8 bits and the camera's size."""
    data = _read(path)
    _check_header(path, data, camera, bits=8)
    return np.asarray(cv2.cvtColor(_decode(path, data, cv2.IMREAD_COLOR), cv2.COLOR_BGR2RGB), dtype=np.uint8)


def read_depth(path: Path, camera: PinholeCamera, depth_scale: float) -> NDArray[np.float32]:
    """Depth float32 (H, W), metres, 0 where nothing was measured, from a grey PNG of 16 bits, `depth_scale` a metre.

    Raises SequenceError unless the file is such an image of the camera's size.
    """
    data = _read(path)
    _check_header(path, data, camera, bits=16)
    return np.divide(_decode(path, data, cv2.IMREAD_UNCHANGED), np.float32(depth_scale), dtype=np.float32)


def png(pixels: NDArray[np.uint8] | NDArray[np.uint16]) -> bytes:
    """The image, BGR or grey, as PNG, packed and read in the least time, and some 10 % larger than by default: level 1
    of 9, each row as its difference from the one above.
    """
    options = [cv2.IMWRITE_PNG_COMPRESSION, 1, cv2.IMWRITE_PNG_FILTER, cv2.IMWRITE_PNG_FILTER_UP]
    return cv2.imencode(".png", pixels, options)[1].tobytes()


def _read(path: Path) -> bytes:
    try:
        if path.exists() and not path.is_file():
            # Not even opened: a device could wait forever.
            raise SequenceError(f"cannot read the image {path}: expected a file, got something else")
        return path.read_bytes()
    except OSError as error:
        raise SequenceError(
            f"cannot read the image {path}: {error.strerror}; unpack the sequence again, or take it off the list"
        ) from None


def _check_header(path: Path, data: bytes, camera: PinholeCamera, bits: int) -> None:
    """What is not as expected would decode all the same, scaled or cut to something else, or fill the memory."""
    if len(data) < _HEADER.size or not data.startswith(_SIGNATURE):
        raise SequenceError(f"{path}: expected a PNG image, got another file or an empty one: convert it to PNG")
    _, chunk, width, height, got_bits, kind = _HEADER.unpack_from(data)
    wanted = "16 bits and one channel, a depth image" if bits == 16 else "8 bits a channel, a colour image"
    if chunk != b"IHDR" or got_bits != bits or (bits == 16 and kind != _GREY):
        raise SequenceError(
            f"{path}: expected a PNG of {wanted}, got {got_bits} bits of PNG colour type {kind}: are the two columns "
            "of the list swapped, or was the image converted?"
        )
    if (width, height) != (camera.width, camera.height):
        raise SequenceError(
            f"{path}: expected {camera.width}x{camera.height} pixels as the camera has, got {width}x{height}: "
            "name the camera that the sequence was recorded with"
        )


def _decode(path: Path, data: bytes, flags: int) -> cv2.typing.MatLike:
    pixels = cv2.imdecode(np.frombuffer(data, dtype=np.uint8), flags)
    if pixels is None:
        raise SequenceError(f"{path}: expected a whole PNG image, got a damaged one: is the file cut off? Get it again")
    return pixels
