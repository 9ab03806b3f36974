"""Pictures made by code, rich in corners and never repeated: posters, rugs, book spines, labels, views, a clock."""

from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray

from slamgym.scenes.textures import Colour, Image, noise, tinted

Points = NDArray[np.int32]

_WORDS = ("JAZZ", "NORD", "OPERA", "PARIS", "CINEMA", "MUSEUM", "OSLO", "EXPO", "BAUHAUS", "TANGO", "LUNA", "RIO")
_FONTS = (cv2.FONT_HERSHEY_DUPLEX, cv2.FONT_HERSHEY_TRIPLEX, cv2.FONT_HERSHEY_COMPLEX)


def _ink(rng: np.random.Generator, low: int = 20, high: int = 235) -> tuple[int, int, int]:
    r, g, b = rng.integers(low, high, 3).tolist()
    return r, g, b


def _canvas(height: int, width: int, colour: Colour) -> Image:
    return np.full((height, width, 3), colour, dtype=np.uint8)


def _aged(rng: np.random.Generator, image: Image) -> Image:
    """Paper grain and uneven fading."""
    size = max(image.shape[:2])
    field = (0.025 * noise(rng, size, 0.4) + 0.05 * noise(rng, size, 1.7))[: image.shape[0], : image.shape[1], None]
    return np.clip(image * (1.0 + field), 0, 255).astype(np.uint8)


def abstract(rng: np.random.Generator, height: int = 384, width: int = 288) -> Image:
    """Overlapping discs, bars, triangles and arcs."""
    image = _canvas(height, width, _ink(rng, 190, 250))
    for kind in rng.integers(0, 4, 46).tolist():
        p, q, r = rng.integers(0, (width, height), (3, 2)).astype(np.int32)
        radius = int(rng.integers(6, width // 6))
        if kind == 0:
            cv2.circle(image, tuple(p.tolist()), radius, _ink(rng), int(rng.choice([-1, 3])), cv2.LINE_AA)
        elif kind == 1:
            cv2.rectangle(image, tuple(p.tolist()), tuple((p + radius).tolist()), _ink(rng), -1)
        elif kind == 2:
            middle = (p + q + r) // 3
            cv2.fillPoly(image, [middle + (np.array([p, q, r]) - middle) // 3], _ink(rng), cv2.LINE_AA)
        else:
            cv2.line(image, tuple(p.tolist()), tuple(((p + q) // 2).tolist()), _ink(rng), 2, cv2.LINE_AA)
    return _aged(rng, image)


def landscape(rng: np.random.Generator, height: int = 320, width: int = 448) -> Image:
    """Sky, sun, ridges one behind the other, trees and houses in front."""
    fade = np.linspace(0.0, 1.0, height)[:, None, None]
    sky = np.array(_ink(rng, 110, 200)) * (1 - fade) + np.array([245, 225, 190]) * fade
    image = np.repeat(sky, width, axis=1).astype(np.uint8)
    sun = (int(rng.integers(width)), int(rng.integers(20, height // 3)))
    cv2.circle(image, sun, int(rng.integers(12, 26)), (255, 240, 200), -1, cv2.LINE_AA)
    tone = np.array(_ink(rng, 60, 140))
    for level in (0.45, 0.58, 0.7, 0.83):
        ridge = height * level + 0.06 * height * noise(rng, 512, 1.3)[0, :width]
        image[np.arange(height)[:, None] > ridge] = tone = tone * 0.78
        _trees(rng, image, ridge, int(40 * level))
    return _aged(rng, image)


def _trees(rng: np.random.Generator, image: Image, ridge: NDArray[np.float64], count: int) -> None:
    height, width = image.shape[:2]
    for x in rng.integers(0, width, count).tolist():
        y, size = int(ridge[x]), int(rng.integers(8, height // 9))
        tree: Points = np.array([[x - size // 3, y + 4], [x, y - size], [x + size // 3, y + 4]], dtype=np.int32)
        cv2.fillPoly(image, [tree], _ink(rng, 25, 110), cv2.LINE_AA)


def _text_lines(rng: np.random.Generator, image: Image, top: int, bottom: int, left: int, right: int) -> None:
    """Lines of small dark word-like blocks."""
    for y in range(top, bottom - 4, 9):
        x, end = left, int(rng.integers((left + 2 * right) // 3, right))
        while x < end:
            length = int(rng.integers(5, 24))
            cv2.rectangle(image, (x, y), (min(x + length, end), y + 3), _ink(rng, 20, 80), -1)
            x += length + 4


def poster(rng: np.random.Generator, height: int = 448, width: int = 320) -> Image:
    """A title, an abstract picture and paragraphs of small print."""
    image = _canvas(height, width, _ink(rng, 150, 245))
    word = str(rng.choice(_WORDS))
    font = int(rng.choice(_FONTS))
    scale = (width - 40) / cv2.getTextSize(word, font, 1.0, 1)[0][0]
    cv2.putText(image, word, (20, 34 + int(18 * scale)), font, scale, _ink(rng, 10, 90), 4, cv2.LINE_AA)
    top = 50 + int(20 * scale)
    image[top : height - 90, 20:-20] = abstract(rng, height - 90 - top, width - 40)
    _text_lines(rng, image, height - 76, height - 16, 20, width - 20)
    return _aged(rng, image)


def town_map(rng: np.random.Generator, height: int = 384, width: int = 448) -> Image:
    """Blocks of a town cut out by crooked streets, a river and names."""
    image = _canvas(height, width, (228, 222, 205))
    for x, y in rng.integers(0, (width, height), (170, 2)).tolist():
        w, h = rng.integers(8, 34, 2).tolist()
        cv2.rectangle(image, (x, y), (x + w, y + h), _ink(rng, 140, 215), -1)
        cv2.rectangle(image, (x, y), (x + w, y + h), (120, 112, 100), 1)
    for _ in range(14):
        street = np.cumsum(rng.normal(rng.uniform(-26, 26, 2), 14.0, (24, 2)), axis=0) + (width / 2, height / 2)
        cv2.polylines(image, [street.astype(np.int32)], False, (250, 246, 232), 5, cv2.LINE_AA)
    river = np.column_stack([np.linspace(0, width, 30), height / 2 + np.cumsum(rng.normal(0, 12, 30))]).astype(np.int32)
    cv2.polylines(image, [river], False, (120, 165, 200), 14, cv2.LINE_AA)
    for x, y in rng.integers((0, 20), (width - 60, height), (9, 2)).tolist():
        cv2.putText(image, str(rng.choice(_WORDS)), (x, y), _FONTS[0], 0.42, (50, 45, 40), 1, cv2.LINE_AA)
    return _aged(rng, image)


PICTURES: tuple[Callable[[np.random.Generator], Image], ...] = (abstract, landscape, poster, town_map)


def rug(rng: np.random.Generator, size: int = 512) -> Image:
    """A woven rug: borders, a field of medallions and small figures, each row dyed a little differently."""
    inks = [_ink(rng, 50, 200) for _ in range(6)]
    image = _canvas(size, size, inks[0])
    for inset, ink in zip((12, 26, 34, 60, 66), inks[1:], strict=True):
        cv2.rectangle(image, (inset, inset), (size - inset, size - inset), ink, -1)
    for x, y in rng.integers(80, size - 80, (60, 2)).tolist():
        _figure(rng, image, (x, y), int(rng.integers(6, 22)), inks)
    for at in np.linspace(47, size - 47, 15).astype(int).tolist():
        for spot in ((at, 47), (at, size - 47), (47, at), (size - 47, at)):
            _figure(rng, image, spot, 9, inks)
    for x, y, radius in ((size // 2, size // 2, 84), (size // 2, 150, 44), (size // 2, size - 150, 44)):
        for share in (1.0, 0.8, 0.6, 0.35):
            _figure(rng, image, (x, y), int(radius * share), inks)
    return _aged(rng, tinted((255, 255, 255), image / 255.0 - 1.0 + 0.06 * noise(rng, size, 0.5, 6.0)[..., None]))


def _figure(rng: np.random.Generator, image: Image, at: tuple[int, int], radius: int, inks: list[Colour]) -> None:
    corners = int(rng.integers(4, 9))
    angle = np.linspace(0.0, 2.0 * np.pi, 2 * corners, endpoint=False)
    reach = radius * np.where(np.arange(2 * corners) % 2, rng.uniform(0.5, 0.9), 1.0)
    star = (np.array(at) + reach[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])).astype(np.int32)
    cv2.fillPoly(image, [star], inks[int(rng.integers(len(inks)))], cv2.LINE_AA)


SPINES = (4, 24)
"""Rows and columns of book spines in `book_spines`."""


def book_spines(rng: np.random.Generator, size: int = 512) -> Image:
    """An atlas of SPINES book spines, upright: bands, ornaments and lettering."""
    image = _canvas(size, size, (128, 128, 128))
    y = np.linspace(0, size, SPINES[0] + 1).astype(int)
    x = np.linspace(0, size, SPINES[1] + 1).astype(int)
    for row, column in np.ndindex(SPINES):
        cell = image[y[row] : y[row + 1], x[column] : x[column + 1]]
        cell[:] = _ink(rng, 25, 215)
        _letter_spine(rng, cell)
    return _aged(rng, image)


def _letter_spine(rng: np.random.Generator, spine: Image) -> None:
    height, width = spine.shape[:2]
    ink = _ink(rng, 170, 255) if spine[0, 0].mean() < 130 else _ink(rng, 10, 80)
    for y in rng.integers(4, height - 8, int(rng.integers(1, 4))).tolist():
        spine[y : y + int(rng.integers(2, 6))] = _ink(rng)
    y, end = int(rng.integers(14, 40)), int(rng.integers(height // 2, height - 12))
    while y < end:
        length, indent = int(rng.integers(3, 8)), int(rng.integers(4, 7))
        spine[y : y + length, indent : width - indent] = ink
        y += length + int(rng.integers(2, 5))


LABELS = (4, 6)
"""Rows and columns of packages in `labels`."""


def labels(rng: np.random.Generator, size: int = 512) -> Image:
    """An atlas of LABELS printed packages and jars."""
    image = _canvas(size, size, (200, 200, 200))
    y = np.linspace(0, size, LABELS[0] + 1).astype(int)
    x = np.linspace(0, size, LABELS[1] + 1).astype(int)
    for row, column in np.ndindex(LABELS):
        cell = image[y[row] : y[row + 1], x[column] : x[column + 1]]
        cell[:] = _ink(rng, 90, 250)
        height, width = cell.shape[:2]
        for _ in range(5):
            _figure(rng, cell, (int(rng.integers(width)), int(rng.integers(height))), width // 4, [_ink(rng)])
        scale = 0.35 + 0.2 * float(rng.random())
        cv2.putText(cell, str(rng.choice(_WORDS)), (4, height // 3), _FONTS[0], scale, _ink(rng, 0, 60), 1, cv2.LINE_AA)
        _text_lines(rng, cell, 2 * height // 3, height - 6, 6, width - 6)
    return image


def outside(rng: np.random.Generator, height: int = 384, width: int = 512) -> Image:
    """A bright street as seen through a window: clouds, house fronts, trees, a lawn."""
    clouds = np.clip(noise(rng, 512, 1.7)[:height, :width, None], 0.0, 1.5) / 1.5
    image = (np.array([165, 200, 240]) * (1 - clouds) + 250 * clouds).astype(np.uint8)
    x = 0
    while x < width:
        wide, top = int(rng.integers(70, 130)), int(rng.integers(height // 4, height // 2))
        _house_front(rng, image[top : int(0.78 * height), x : x + wide])
        x += wide + int(rng.integers(0, 40))
    image[int(0.76 * height) :] = tinted((140, 175, 105), 0.08 * noise(rng, 512, 1.0))[: height - int(0.76 * height)]
    for x in rng.integers(0, width, 7).tolist():
        _crown(rng, image, x, int(rng.integers(int(0.5 * height), int(0.72 * height))))
    return image


def _house_front(rng: np.random.Generator, front: Image) -> None:
    front[:] = _ink(rng, 150, 225)
    height, width = front.shape[:2]
    front[:10] = _ink(rng, 90, 150)
    for y in range(22, height - 24, 36):
        for x in range(10, width - 16, 26):
            front[y : y + 22, x : x + 14] = 240
            front[y + 2 : y + 20, x + 2 : x + 12] = _ink(rng, 60, 140)


def _crown(rng: np.random.Generator, image: Image, x: int, y: int) -> None:
    cv2.line(image, (x, y), (x, int(0.8 * image.shape[0])), (90, 70, 55), 6)
    for dx, dy in rng.normal(0.0, 17.0, (34, 2)).astype(int).tolist():
        green = _ink(rng, 70, 120)
        cv2.circle(image, (x + dx, y + dy), int(rng.integers(5, 13)), (green[0], green[1] + 45, 60), -1, cv2.LINE_AA)


def clock_face(rng: np.random.Generator, size: int = 192) -> Image:
    """Twelve numerals and two hands."""
    image = _canvas(size, size, (246, 243, 235))
    middle, radius = size // 2, 0.4 * size
    for hour in range(1, 13):
        angle = hour * np.pi / 6.0
        spot = (int(middle + radius * np.sin(angle)) - 9, int(middle - radius * np.cos(angle)) + 7)
        cv2.putText(image, str(hour), spot, _FONTS[0], 0.55, (20, 20, 20), 1, cv2.LINE_AA)
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
        cv2.rectangle(image, (x, y), (x + w, y + 10), _ink(rng, 40, 160), -1)
        _text_lines(rng, image, y + 16, y + h, x + 6, x + w - 6)
    return image
