"""Printed things made by code: book spines, labels, a clock, a screen, notes, a mirror."""

import cv2
import numpy as np
from numpy.typing import NDArray

from slamgym.scenes.home.pictures import DYES, FONTS, WORDS, aged, canvas, figure, landscape, random_ink, text_lines
from slamgym.scenes.home.textures import Image


def _cloth(rng: np.random.Generator) -> NDArray[np.float64]:
    """A binding's colour: one of the dyes, paler or darker, or anything muted."""
    dye = np.array(DYES[int(rng.integers(len(DYES)))] if rng.random() < 0.6 else random_ink(rng, 25, 215))
    return np.asarray(np.minimum(dye * rng.uniform(0.3, 1.4), 255.0))


SPINES = (4, 24)
"""Rows and columns of book spines in `book_spines`."""


def book_spines(rng: np.random.Generator, size: int = 512) -> Image:
    """An atlas of SPINES book spines, upright: bands, ornaments and lettering."""
    image = canvas(size, size, (128, 128, 128))
    y = np.linspace(0, size, SPINES[0] + 1).astype(int)
    x = np.linspace(0, size, SPINES[1] + 1).astype(int)
    for row, column in np.ndindex(SPINES):
        cell = image[y[row] : y[row + 1], x[column] : x[column + 1]]
        cell[:] = _cloth(rng)
        _letter_spine(rng, cell)
    return aged(rng, image)


def _letter_spine(rng: np.random.Generator, spine: Image) -> None:
    height, width = spine.shape[:2]
    ink = random_ink(rng, 190, 255) if spine[0, 0].mean() < 130 else random_ink(rng, 5, 60)
    for y in rng.integers(4, height - 8, int(rng.integers(1, 4))).tolist():
        spine[y : y + int(rng.integers(2, 6))] = random_ink(rng)
    y, end = int(rng.integers(14, 40)), int(rng.integers(height // 2, height - 12))
    while y < end:
        length, indent = int(rng.integers(3, 8)), int(rng.integers(4, 7))
        spine[y : y + length, indent : width - indent] = ink
        y += length + int(rng.integers(2, 5))


LABELS = (4, 6)
"""Rows and columns of packages in `labels`."""


def labels(rng: np.random.Generator, size: int = 512) -> Image:
    """An atlas of LABELS printed packages and jars."""
    image = canvas(size, size, (200, 200, 200))
    y = np.linspace(0, size, LABELS[0] + 1).astype(int)
    x = np.linspace(0, size, LABELS[1] + 1).astype(int)
    for row, column in np.ndindex(LABELS):
        cell = image[y[row] : y[row + 1], x[column] : x[column + 1]]
        cell[:] = random_ink(rng, 90, 250)
        height, width = cell.shape[:2]
        for _ in range(5):
            figure(rng, cell, (int(rng.integers(width)), int(rng.integers(height))), width // 4, [random_ink(rng)])
        word, scale, ink = str(rng.choice(WORDS)), float(rng.uniform(0.35, 0.55)), random_ink(rng, 0, 60)
        cv2.putText(cell, word, (4, height // 3), FONTS[0], scale, ink, 1, cv2.LINE_AA)
        text_lines(rng, cell, 2 * height // 3, height - 6, 6, width - 6)
    return image


def clock_face(rng: np.random.Generator, size: int = 192) -> Image:
    """Twelve numerals and two hands."""
    image = canvas(size, size, (246, 243, 235))
    middle, radius = size // 2, 0.4 * size
    for hour in range(1, 13):
        angle = hour * np.pi / 6.0
        spot = (int(middle + radius * np.sin(angle)) - 9, int(middle - radius * np.cos(angle)) + 7)
        cv2.putText(image, str(hour), spot, FONTS[0], 0.55, (20, 20, 20), 1, cv2.LINE_AA)
    for length, thickness in ((0.2, 6), (0.31, 3)):
        angle = rng.uniform(0.0, 2.0 * np.pi)
        tip = (int(middle + length * size * np.sin(angle)), int(middle - length * size * np.cos(angle)))
        cv2.line(image, (middle, middle), tip, (20, 20, 20), thickness, cv2.LINE_AA)
    return image


def screen(rng: np.random.Generator, height: int = 256, width: int = 400) -> Image:
    """A desktop: windows with lines of text over a picture."""
    image = landscape(rng, height, width)
    for x, y in rng.integers((8, 8), (width // 2, height // 2), (3, 2)).tolist():
        w, h = int(rng.integers(110, 190)), int(rng.integers(80, 120))
        cv2.rectangle(image, (x, y), (x + w, y + h), (244, 244, 246), -1)
        cv2.rectangle(image, (x, y), (x + w, y + 10), random_ink(rng, 40, 160), -1)
        text_lines(rng, image, y + 16, y + h, x + 6, x + w - 6)
    return image


NOTES = (3, 4)
"""Rows and columns of sheets in `notes`."""


def notes(rng: np.random.Generator, size: int = 384) -> Image:
    """An atlas of NOTES sheets of paper: a calendar page, letters, children's drawings, coloured slips."""
    image = canvas(size, size, (238, 236, 228))
    y = np.linspace(0, size, NOTES[0] + 1).astype(int)
    x = np.linspace(0, size, NOTES[1] + 1).astype(int)
    for row, column in np.ndindex(NOTES):
        cell = image[y[row] : y[row + 1], x[column] : x[column + 1]]
        (_calendar, _letter, _drawing)[row](rng, cell)
    return image


def _calendar(rng: np.random.Generator, page: Image) -> None:
    height, width = page.shape[:2]
    page[: height // 2] = cv2.resize(landscape(rng, 160, 224), (width, height // 2), interpolation=cv2.INTER_AREA)
    step = width // 8
    for y in range(height // 2 + 6, height - 8, step - 3):
        for x in range(5, width - step, step):
            cv2.rectangle(page, (x, y), (x + step - 5, y + step - 8), random_ink(rng, 40, 150), -1)


def _letter(rng: np.random.Generator, page: Image) -> None:
    page[:] = random_ink(rng, 205, 255)
    text_lines(rng, page, 10, page.shape[0] - 8, 8, page.shape[1] - 8)


def _drawing(rng: np.random.Generator, page: Image) -> None:
    for _ in range(7):
        spot = int(rng.integers(page.shape[1])), int(rng.integers(page.shape[0]))
        figure(rng, page, spot, int(rng.integers(8, 26)), [random_ink(rng, 60, 220)])


def reflection(rng: np.random.Generator, size: int = 256) -> Image:
    """What a dim mirror shows: a blurred room, lighter above."""
    walls = np.linspace(150, 84, size)[:, None, None] * np.array([1.0, 0.97, 0.93])
    image = np.repeat(walls, size, axis=1).astype(np.uint8)
    for x, y in rng.integers(0, size, (9, 2)).tolist():
        w, h = rng.integers(size // 10, size // 3, 2).tolist()
        cv2.rectangle(image, (x, y), (x + w, y + h), random_ink(rng, 50, 170), -1)
    return np.asarray(cv2.GaussianBlur(image, (0, 0), size / 28), dtype=np.uint8)
