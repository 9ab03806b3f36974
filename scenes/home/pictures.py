"""Pictures made by code, rich in corners and no two alike: posters, landscapes, maps, rugs."""

from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray

from slamgym.scenes.home.colours import Colour
from slamgym.scenes.home.textures import Image, noise, tinted

Points = NDArray[np.int32]

WORDS = ("JAZZ", "NORD", "OPERA", "PARIS", "CINEMA", "MUSEUM", "OSLO", "EXPO", "BAUHAUS", "TANGO", "LUNA", "RIO")
FONTS = (cv2.FONT_HERSHEY_DUPLEX, cv2.FONT_HERSHEY_TRIPLEX, cv2.FONT_HERSHEY_COMPLEX)


def random_ink(rng: np.random.Generator, low: int = 10, high: int = 250) -> tuple[int, int, int]:
    """A muted, warm colour: printers' inks and dyes are never as pure as random numbers."""
    pure = rng.integers(low, high, 3)
    r, g, b = (np.array([1.0, 0.97, 0.9]) * (0.6 * pure + 0.4 * pure.mean())).astype(int).tolist()
    return r, g, b


def canvas(height: int, width: int, colour: Colour) -> Image:
    return np.full((height, width, 3), colour, dtype=np.uint8)


def aged(rng: np.random.Generator, image: Image) -> Image:
    """Paper grain and uneven fading."""
    size = max(image.shape[:2])
    field = 0.045 * noise(rng, size, 1.2)[: image.shape[0], : image.shape[1], None]
    return np.clip(image * (1.0 + field), 0, 255).astype(np.uint8)


def abstract(rng: np.random.Generator, height: int = 320, width: int = 240) -> Image:
    """Overlapping discs, bars, triangles and arcs."""
    image = canvas(height, width, random_ink(rng, 190, 250))
    for kind in rng.integers(0, 4, 46).tolist():
        p, q, r = rng.integers(0, (width, height), (3, 2)).astype(np.int32)
        radius = int(rng.integers(6, width // 6))
        if kind == 0:
            cv2.circle(image, tuple(p.tolist()), radius, random_ink(rng), int(rng.choice([-1, 3])), cv2.LINE_AA)
        elif kind == 1:
            cv2.rectangle(image, tuple(p.tolist()), tuple((p + radius).tolist()), random_ink(rng), -1)
        elif kind == 2:
            middle = (p + q + r) // 3
            cv2.fillPoly(image, [middle + (np.array([p, q, r]) - middle) // 3], random_ink(rng), cv2.LINE_AA)
        else:
            cv2.line(image, tuple(p.tolist()), tuple(((p + q) // 2).tolist()), random_ink(rng), 2, cv2.LINE_AA)
    return aged(rng, image)


def landscape(rng: np.random.Generator, height: int = 256, width: int = 360) -> Image:
    """Sky, sun, ridges one behind the other, trees and houses in front."""
    fade = np.linspace(0.0, 1.0, height)[:, None, None]
    sky = np.array(random_ink(rng, 110, 200)) * (1 - fade) + np.array([245, 225, 190]) * fade
    image = np.repeat(sky, width, axis=1).astype(np.uint8)
    sun = (int(rng.integers(width)), int(rng.integers(20, height // 3)))
    cv2.circle(image, sun, int(rng.integers(12, 26)), (255, 240, 200), -1, cv2.LINE_AA)
    tone = np.array(random_ink(rng, 60, 140))
    hills = noise(rng, 512, 1.3)[::128, :width]
    for level, hill in zip((0.45, 0.58, 0.7, 0.83), hills, strict=True):
        ridge = height * (level + 0.06 * hill)
        image[np.arange(height)[:, None] > ridge] = tone = tone * 0.78
        _trees(rng, image, ridge, int(40 * level))
    return aged(rng, image)


def _trees(rng: np.random.Generator, image: Image, ridge: NDArray[np.float64], count: int) -> None:
    height, width = image.shape[:2]
    for x in rng.integers(0, width, count).tolist():
        y, size = int(ridge[x]), int(rng.integers(8, height // 9))
        tree: Points = np.array([[x - size // 3, y + 4], [x, y - size], [x + size // 3, y + 4]], dtype=np.int32)
        cv2.fillPoly(image, [tree], random_ink(rng, 25, 110), cv2.LINE_AA)


def text_lines(rng: np.random.Generator, image: Image, top: int, bottom: int, left: int, right: int) -> None:
    """Lines of small dark word-like blocks."""
    for y in range(top, bottom - 4, 9):
        x, end = left, int(rng.integers((left + 2 * right) // 3, right))
        while x < end:
            length = int(rng.integers(5, 24))
            cv2.rectangle(image, (x, y), (min(x + length, end), y + 3), random_ink(rng, 20, 80), -1)
            x += length + 4


def poster(rng: np.random.Generator, height: int = 448, width: int = 320) -> Image:
    """A title, an abstract picture and paragraphs of small print."""
    image = canvas(height, width, random_ink(rng, 150, 245))
    word = str(rng.choice(WORDS))
    font = int(rng.choice(FONTS))
    scale = (width - 60) / cv2.getTextSize(word, font, 1.0, 1)[0][0]
    cv2.putText(image, word, (26, 34 + int(18 * scale)), font, scale, random_ink(rng, 10, 90), 4, cv2.LINE_AA)
    top = 50 + int(20 * scale)
    image[top : height - 90, 20:-20] = abstract(rng, height - 90 - top, width - 40)
    text_lines(rng, image, height - 76, height - 16, 20, width - 20)
    return aged(rng, image)


def town_map(rng: np.random.Generator, height: int = 384, width: int = 448) -> Image:
    """Blocks of a town cut out by crooked streets, a river and names."""
    image = canvas(height, width, (228, 222, 205))
    for x, y in rng.integers(0, (width, height), (170, 2)).tolist():
        w, h = rng.integers(8, 34, 2).tolist()
        cv2.rectangle(image, (x, y), (x + w, y + h), random_ink(rng, 140, 215), -1)
        cv2.rectangle(image, (x, y), (x + w, y + h), (120, 112, 100), 1)
    for _ in range(14):
        street = np.cumsum(rng.normal(rng.uniform(-26, 26, 2), 14.0, (24, 2)), axis=0) + np.array(
            [width / 2, height / 2]
        )
        cv2.polylines(image, [street.astype(np.int32)], False, (250, 246, 232), 5, cv2.LINE_AA)
    river = np.column_stack([np.linspace(0, width, 30), height / 2 + np.cumsum(rng.normal(0, 12, 30))]).astype(np.int32)
    cv2.polylines(image, [river], False, (120, 165, 200), 14, cv2.LINE_AA)
    for x, y in rng.integers((0, 20), (width - 60, height), (9, 2)).tolist():
        cv2.putText(image, str(rng.choice(WORDS)), (x, y), FONTS[0], 0.42, (50, 45, 40), 1, cv2.LINE_AA)
    return aged(rng, image)


PICTURES: tuple[Callable[[np.random.Generator], Image], ...] = (abstract, landscape, poster, town_map)


DYES: tuple[Colour, ...] = (
    (128, 42, 38),
    (30, 44, 74),
    (222, 204, 168),
    (96, 104, 74),
    (54, 34, 30),
    (190, 130, 74),
)


def rug(rng: np.random.Generator, size: int = 512) -> Image:
    """A woven rug: borders, a field of medallions and small figures, each row dyed a little differently."""
    inks = [DYES[i] for i in rng.permutation(len(DYES))]
    image = canvas(size, size, inks[0])
    for inset, ink in zip((12, 26, 34, 60, 66), inks[1:], strict=True):
        cv2.rectangle(image, (inset, inset), (size - inset, size - inset), ink, -1)
    for x, y in rng.integers(80, size - 80, (60, 2)).tolist():
        figure(rng, image, (x, y), int(rng.integers(6, 22)), inks)
    for at in np.linspace(47, size - 47, 15).astype(int).tolist():
        for spot in ((at, 47), (at, size - 47), (47, at), (size - 47, at)):
            figure(rng, image, spot, 9, inks)
    for x, y, radius in ((size // 2, size // 2, 84), (size // 2, 150, 44), (size // 2, size - 150, 44)):
        for share in (1.0, 0.8, 0.6, 0.35):
            figure(rng, image, (x, y), int(radius * share), inks)
    return aged(rng, tinted((255, 255, 255), image / 255.0 - 1.0 + 0.08 * noise(rng, size, 0.6, 6.0)[..., None]))


def figure(rng: np.random.Generator, image: Image, at: tuple[int, int], radius: int, inks: list[Colour]) -> None:
    corners = int(rng.integers(4, 9))
    angle = np.linspace(0.0, 2.0 * np.pi, 2 * corners, endpoint=False)
    reach = radius * np.where(np.arange(2 * corners) % 2, rng.uniform(0.5, 0.9), 1.0)
    star = (np.array(at) + reach[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])).astype(np.int32)
    cv2.fillPoly(image, [star], inks[int(rng.integers(len(inks)))], cv2.LINE_AA)
