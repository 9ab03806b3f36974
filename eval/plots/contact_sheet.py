"""Many views in one picture, each with its number."""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]

COLUMNS = 4
VIEW_WIDTH = 480
"""Pixels of a view."""


def contact_sheet(views: Sequence[Image]) -> Image:
    """Colour images (H, W, 3) of one size, as many as fill rows of four, in one, numbered from 1 on."""
    tiles = [_tile(view, number) for number, view in enumerate(views, start=1)]
    rows = [np.hstack(tiles[i : i + COLUMNS]) for i in range(0, len(tiles), COLUMNS)]
    return np.vstack(rows)


def _tile(view: Image, number: int) -> Image:
    height = round(VIEW_WIDTH * view.shape[0] / view.shape[1])
    tile = cv2.resize(view, (VIEW_WIDTH, height), interpolation=cv2.INTER_AREA)
    for colour, thickness in (((0, 0, 0), 4), ((255, 255, 255), 1)):
        cv2.putText(tile, str(number), (8, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.7, colour, thickness, cv2.LINE_AA)
    return np.asarray(tile, dtype=np.uint8)
