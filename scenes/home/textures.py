"""Surface textures made by code: wood, tiles, fabric, wallpaper, plaster, marble, leaves.

All functions draw from the given generator, return uint8 (size, size, 3) sRGB, and tile without a seam. Each varies at
several scales (blemishes, tone of single planks or tiles, grain), for small repeated patterns of high contrast would
make every place look like every other to a feature matcher.
"""

from collections.abc import Callable
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from slamgym.types import FloatArray

Image = NDArray[np.uint8]
Colour = tuple[int, int, int]


def noise(rng: np.random.Generator, size: int, roughness: float = 1.6, stretch: float = 1.0) -> FloatArray:
    """A periodic random field (size, size), mean 0 and deviation 1, amplitude spectrum 1 / f^roughness.

    stretch: how much longer its blotches are along u than along v.
    """
    frequency = np.hypot(np.fft.fftfreq(size)[:, None], np.fft.rfftfreq(size) * stretch)
    spectrum = np.fft.rfft2(rng.standard_normal((size, size))) / (frequency + 1.0 / size) ** roughness
    spectrum[0, 0] = 0.0
    field = np.fft.irfft2(spectrum, (size, size))
    return np.asarray(field / field.std(), dtype=np.float64)


def tinted(colour: Colour, tone: FloatArray) -> Image:
    """The colour times (1 + tone), tone (H, W) or (H, W, 3)."""
    tone = tone if tone.ndim == 3 else tone[..., None]
    return np.clip(np.array(colour) * (1.0 + tone) + 0.5, 0, 255).astype(np.uint8)


def plaster(rng: np.random.Generator, colour: Colour, size: int = 512, contrast: float = 0.012) -> Image:
    """Painted wall: nearly plain, with the faint grain of a roller and large pale stains."""
    return tinted(colour, contrast * noise(rng, size, 0.3) + 1.5 * contrast * noise(rng, size, 1.8))


def woodchip(rng: np.random.Generator, colour: Colour, size: int = 512) -> Image:
    """Painted ingrain wallpaper: chips of a few millimetres that stand out and throw a small shadow."""
    chips = np.clip(noise(rng, size, 0.4) - 0.9, 0.0, 1.5)
    relief = chips - np.roll(chips, (2, 1), axis=(0, 1))
    return tinted(colour, 0.22 * relief + 0.015 * noise(rng, size, 0.5) + 0.018 * noise(rng, size, 1.8))


def _grain(rng: np.random.Generator, size: int) -> FloatArray:
    fine = noise(rng, size, 0.9, stretch=18.0)
    wide = noise(rng, size, 1.6, stretch=9.0)
    rings = np.sin(2.0 * np.pi * (2.2 * wide + np.linspace(0.0, 5.0, size, endpoint=False)[:, None]))
    return 0.06 * fine + 0.05 * wide + 0.035 * rings


def _knots(rng: np.random.Generator, size: int, count: int) -> FloatArray:
    tone = np.zeros((size, size))
    reach = np.arange(-size // 12, size // 12)
    for row, column in rng.integers(0, size, (count, 2)):
        distance = np.hypot(reach / 2.2, reach[:, None]) / (rng.uniform(0.006, 0.012) * size)
        knot = np.exp(-distance) * (1.0 + 0.4 * np.cos(5.0 * distance))
        tone[np.ix_((row + reach) % size, (column + reach) % size)] -= rng.uniform(0.25, 0.5) * knot
    return tone


def wood(rng: np.random.Generator, colour: Colour, size: int = 256) -> Image:
    """A board with its grain along u."""
    return tinted(colour, _grain(rng, size) + _knots(rng, size, 4))


def planks(rng: np.random.Generator, colour: Colour, rows: int = 16, size: int = 512) -> Image:
    """Floor boards along u, each with its own tone and grain, joints staggered at random."""
    grain = _grain(rng, size) + _knots(rng, size, 26)
    tone = np.empty((size, size))
    edges = np.linspace(0, size, rows + 1).astype(int)
    for top, bottom in pairwise(edges.tolist()):
        joints = np.sort(rng.integers(0, size, 3))
        board = np.searchsorted(joints, np.arange(size)) % 3
        tone[top:bottom] = np.roll(grain, rng.integers(size), axis=1)[top:bottom] + rng.normal(0.0, 0.1, 3)[board]
        tone[top:bottom, joints] -= 0.3
        tone[top] -= 0.22
    return tinted(colour, tone + 0.04 * noise(rng, size, 1.5))


def parquet(rng: np.random.Generator, colour: Colour, blocks: int = 8, size: int = 512) -> Image:
    """Square blocks of four staves, turned by 90 degrees in turn."""
    block, stave = size // blocks, size // blocks // 4
    grain = _grain(rng, size) + _knots(rng, size, 20)
    tone = np.empty((size, size))
    for row, column in np.ndindex(blocks, blocks):
        y, x = rng.integers(0, size - block, 2)
        patch = grain[y : y + block, x : x + block] + np.repeat(rng.normal(0.0, 0.1, 4), stave)[:, None]
        patch[::stave] -= 0.2
        patch[:, 0] -= 0.2
        rows, columns = slice(row * block, (row + 1) * block), slice(column * block, (column + 1) * block)
        tone[rows, columns] = patch if (row + column) % 2 else patch.T
    return tinted(colour, tone + 0.04 * noise(rng, size, 1.5))


def tiles(rng: np.random.Generator, colour: Colour, count: int = 6, size: int = 512, variation: float = 0.05) -> Image:
    """Square ceramic tiles, marbled, each with its own tone, in pale grout."""
    cell = np.linspace(0, count, size, endpoint=False)
    row, column = np.floor(cell).astype(int)[:, None], np.floor(cell).astype(int)[None, :]
    tone = rng.normal(0.0, variation, (count, count))[row, column]
    shift = rng.integers(0, size, (count, count))[row, column]
    pixel_y, pixel_x = np.mgrid[:size, :size]
    tone = tone + _veins(rng, size)[(pixel_y + shift) % size, (pixel_x + 3 * shift) % size]
    image = tinted(colour, tone + 0.02 * noise(rng, size, 0.5))
    joint = cell % 1.0 < 2.4 * count / size
    image[joint[:, None] | joint[None, :]] = (176, 172, 166)
    return image


def _veins(rng: np.random.Generator, size: int) -> FloatArray:
    ridge = 1.0 - np.minimum(np.abs(noise(rng, size, 1.9)) * 6.0, 1.0)
    return 0.05 * noise(rng, size, 1.5) - 0.16 * ridge**2 * (noise(rng, size, 2.0) > 0.2)


def marble(rng: np.random.Generator, colour: Colour, size: int = 256) -> Image:
    """Clouds, veins and speckles: worktops, stone."""
    speckles = np.where(noise(rng, size, 0.4) > 2.1, -0.25, 0.0)
    return tinted(colour, _veins(rng, size) + speckles + 0.02 * noise(rng, size, 0.2))


def fabric(rng: np.random.Generator, colour: Colour, size: int = 256) -> Image:
    """Woven cloth: threads of uneven tone, a little worn."""
    threads = rng.normal(0.0, 0.05, size)[:, None] + rng.normal(0.0, 0.05, size)[None, :]
    return tinted(colour, threads + 0.06 * noise(rng, size, 0.5) + 0.09 * noise(rng, size, 1.4))


def carpet(rng: np.random.Generator, colour: Colour, size: int = 512) -> Image:
    """Short pile, flecked, with trodden patches."""
    flecks = np.where(noise(rng, size, 0.9) > 1.8, 0.22, 0.0)
    return tinted(colour, 0.09 * noise(rng, size, 0.5) + 0.07 * noise(rng, size, 1.4) + flecks)


def checked(rng: np.random.Generator, colour: Colour, other: Colour, size: int = 256) -> Image:
    """Woven cloth with bands of a second colour, uneven in width."""
    edges = np.sort(rng.choice(size, 10, replace=False))
    band = (np.searchsorted(edges, np.arange(size)) % 2) * 0.5
    share = (band[:, None] + band[None, :])[..., None]
    cloth = fabric(rng, (255, 255, 255), size) / 255.0
    return np.asarray((np.array(colour) * (1 - share) + np.array(other) * share) * cloth, dtype=np.uint8)


def leaves(rng: np.random.Generator, colour: Colour = (92, 132, 74), size: int = 128) -> Image:
    """A leaf surface: blotches and a paler rib along u."""
    rib = np.exp(-((np.linspace(-1, 1, size) / 0.06) ** 2))[:, None]
    return tinted(colour, 0.1 * noise(rng, size, 1.4) + 0.06 * noise(rng, size, 0.6) + 0.35 * rib)


def striped_wallpaper(rng: np.random.Generator, colour: Colour, size: int = 512) -> Image:
    """Upright stripes of uneven width and tone on rough paper."""
    edges = np.sort(rng.choice(size, 18, replace=False))
    tone = rng.normal(0.0, 0.035, len(edges) + 1)
    tone[-1] = tone[0]
    stripes = tone[np.searchsorted(edges, np.arange(size))][None, :]
    return tinted(colour, stripes + 0.035 * noise(rng, size, 0.6) + 0.03 * noise(rng, size, 1.6))


def floral_wallpaper(rng: np.random.Generator, colour: Colour, accent: Colour, size: int = 512) -> Image:
    """Flowers on stems, no two alike, scattered over pale paper."""
    image = plaster(rng, colour, size, 0.03)
    cells = 6
    for row, column in np.ndindex(cells, cells):
        centre = (np.array([column + 0.5 * (row % 2), row]) + rng.uniform(0.2, 0.8, 2)) * size / cells
        _wrapped(image, _flower(rng, centre, rng.uniform(0.035, 0.06) * size, colour, accent))
    return image


def _flower(
    rng: np.random.Generator, centre: FloatArray, radius: float, paper: Colour, ink: Colour
) -> Callable[[Image, FloatArray], None]:
    tones = [tuple(float(p + s * (i - p)) for p, i in zip(paper, ink, strict=True)) for s in rng.uniform(0.25, 0.6, 3)]
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
