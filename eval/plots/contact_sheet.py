"""Many views in one picture, each with its number."""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]

COLUMNS = 4
VIEW_WIDTH = 480
"""Pixels of a view."""
JPG_QUALITY = 85


def contact_sheet(views: Sequence[Image], columns: int = COLUMNS, view_width: int = VIEW_WIDTH) -> Image:
    """Colour images (H, W, 3) of one size, at least one, in rows of so many, numbered from 1 on; the rest is white.

    view_width: pixels that each is scaled to.
    """
    tiles = [_tile(view, number, view_width) for number, view in enumerate(views, start=1)]
    tiles += [np.full_like(tiles[0], 255)] * (-len(tiles) % columns)
    rows = [np.hstack(tiles[i : i + columns]) for i in range(0, len(tiles), columns)]
    return np.vstack(rows)


def scaled(view: Image, width: int) -> Image:
    """A colour image (H, W, 3) scaled down to so many pixels across."""
    height = round(width * view.shape[0] / view.shape[1])
    return np.asarray(cv2.resize(view, (width, height), interpolation=cv2.INTER_AREA), dtype=np.uint8)


def jpg(image: Image) -> bytes:
    """A colour image (H, W, 3), RGB, as the content of a JPEG file."""
    # Encoded in memory: OpenCV would not say why a file cannot be written.
    quality = [cv2.IMWRITE_JPEG_QUALITY, JPG_QUALITY]
    return cv2.imencode(".jpg", cv2.cvtColor(image, cv2.COLOR_RGB2BGR), quality)[1].tobytes()


def _tile(view: Image, number: int, width: int) -> Image:
    tile = scaled(view, width)
    for colour, thickness in (((0, 0, 0), 4), ((255, 255, 255), 1)):
        cv2.putText(tile, str(number), (8, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.7, colour, thickness, cv2.LINE_AA)
    return tile
