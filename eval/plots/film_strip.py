"""Some frames side by side, each with what is said about it."""

from collections.abc import Sequence

import cv2
import numpy as np

from slamgym.eval.plots.contact_sheet import Image, scaled

VIEW_WIDTH = 200
"""Pixels of a frame."""
CAPTION_HEIGHT, GAP = 22, 4
GREEN, VERMILION, WHITE = (0, 110, 80), (213, 94, 0), (255, 255, 255)
"""RGB: dark enough for white letters, and told apart in grey and by the colour-blind."""


def film_strip(views: Sequence[Image], captions: Sequence[str], good: Sequence[bool]) -> Image:
    """Colour images (H, W, 3) of one size in a row, below each its caption: on green where it is good, else on
    vermilion. Captions are in ASCII, at most some 22 letters.
    """
    parts = [_captioned(*one) for one in zip(views, captions, good, strict=True)]
    gap = np.full((parts[0].shape[0], GAP, 3), 255, dtype=np.uint8)
    return np.hstack([piece for part in parts for piece in (gap, part)][1:])


def _captioned(view: Image, caption: str, good: bool) -> Image:
    bar = np.full((CAPTION_HEIGHT, VIEW_WIDTH, 3), GREEN if good else VERMILION, dtype=np.uint8)
    cv2.putText(bar, caption, (6, 16), cv2.FONT_HERSHEY_SIMPLEX, 0.45, WHITE, 1, cv2.LINE_AA)
    return np.vstack([scaled(view, VIEW_WIDTH), bar])
