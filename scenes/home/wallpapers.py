"""Wallpapers made by code; all tile without a seam."""

from collections.abc import Callable

import cv2
import numpy as np

from slamgym.scenes.home.colours import Colour
from slamgym.scenes.home.textures import Image, noise, plaster, tinted
from slamgym.types import FloatArray


def striped_wallpaper(rng: np.random.Generator, colour: Colour, size: int = 512) -> Image:
    """Upright stripes of uneven width and tone on rough paper."""
    edges = np.sort(rng.choice(size, 18, replace=False))
    tone = rng.normal(0.0, 0.08, len(edges) + 1)
    tone[-1] = tone[0]
    stripes = tone[np.searchsorted(edges, np.arange(size))][None, :]
    return tinted(colour, stripes + 0.05 * noise(rng, size, 0.7) + 0.04 * noise(rng, size, 1.6))


def floral_wallpaper(rng: np.random.Generator, colour: Colour, accent: Colour, size: int = 512) -> Image:
    """Flowers on stems, no two alike, scattered over pale paper."""
    image = plaster(rng, colour, size, 0.03)
    cells = 8
    for row, column in np.ndindex(cells, cells):
        centre = (np.array([column + 0.5 * (row % 2), row]) + rng.uniform(0.2, 0.8, 2)) * size / cells
        _wrapped(image, _flower(rng, centre, rng.uniform(0.028, 0.046) * size, colour, accent))
    return image


def _flower(
    rng: np.random.Generator, centre: FloatArray, radius: float, paper: Colour, ink: Colour
) -> Callable[[Image, FloatArray], None]:
    tones = [tuple(float(p + s * (i - p)) for p, i in zip(paper, ink, strict=True)) for s in rng.uniform(0.3, 0.85, 3)]
    petals, turn = int(rng.integers(4, 8)), rng.uniform(0.0, 2.0 * np.pi)
    bend = rng.uniform(-1.0, 1.0, 2) * radius

    def draw(image: Image, offset: FloatArray) -> None:
        at = centre + offset
        stem = (at + np.array([(0.0, 0.0), (bend[0], radius), (bend[1], 2.2 * radius)])).round().astype(np.int32)
        cv2.polylines(image, [stem], False, tones[0], 2, cv2.LINE_AA)
        for angle in turn + np.arange(petals) * 2.0 * np.pi / petals:
            petal = at + 0.6 * radius * np.array([np.cos(angle), np.sin(angle)])
            axes = (max(int(0.45 * radius), 1), max(int(0.25 * radius), 1))
            cv2.ellipse(image, _pixel(petal), axes, float(np.degrees(angle)), 0, 360, tones[1], -1, cv2.LINE_AA)
        cv2.circle(image, _pixel(at), max(int(0.25 * radius), 1), tones[2], -1, cv2.LINE_AA)

    return draw


def _pixel(point: FloatArray) -> tuple[int, int]:
    return round(float(point[0])), round(float(point[1]))


def _wrapped(image: Image, draw: Callable[[Image, FloatArray], None]) -> None:
    """Draws at all places where the tiled image shows the shape."""
    size = image.shape[0]
    for row, column in np.ndindex(3, 3):
        draw(image, np.array([column - 1.0, row - 1.0]) * size)


def geometric_wallpaper(rng: np.random.Generator, colour: Colour, accent: Colour, size: int = 512) -> Image:
    """Lozenges in a lattice, each of its own tone, between thin lines."""
    cells = int(rng.integers(5, 8))
    y, x = np.mgrid[:size, :size] * cells / size
    a, b = (x + y) % cells, (x - y) % cells
    tone = rng.uniform(0.0, 0.4, (cells, cells))[a.astype(int) % cells, b.astype(int) % cells]
    line = (np.minimum(a % 1.0, b % 1.0) < 0.05)[..., None]
    share = np.where(line, 0.65, tone[..., None])
    image = np.array(colour) * (1.0 - share) + np.array(accent) * share
    return tinted((255, 255, 255), image / 255.0 - 1.0 + 0.02 * noise(rng, size, 0.8)[..., None])
