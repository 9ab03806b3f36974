"""Surface textures made by code: wood, tiles, fabric, plaster, marble, leaves.

All functions draw from the given generator, return uint8 (size, size, 3) sRGB, and tile without a seam. Each varies at
several scales (blemishes, tone of single planks or tiles, grain), for small repeated patterns of high contrast would
make every place look like every other to a feature matcher.
"""

from functools import cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from slamgym.scenes.home.colours import Colour
from slamgym.types import FloatArray

Image = NDArray[np.uint8]


def noise(rng: np.random.Generator, size: int, roughness: float = 1.6, stretch: float = 1.0) -> FloatArray:
    """A periodic random field (size, size), mean 0 and deviation 1, amplitude spectrum 1 / f^roughness.

    stretch: how much longer its blotches are along u than along v.
    """
    spectrum = fft.rfft2(rng.standard_normal((size, size), dtype=np.float32)) * _falloff(size, roughness, stretch)
    field = fft.irfft2(spectrum, (size, size)).astype(np.float64)
    return np.asarray(field / field.std())


@cache
def _falloff(size: int, roughness: float, stretch: float) -> NDArray[np.float32]:
    """The amplitudes (size, size // 2 + 1) of `noise`; none at frequency 0."""
    frequency = np.hypot(np.fft.fftfreq(size)[:, None], np.fft.rfftfreq(size) * stretch)
    amplitude = (frequency + 1.0 / size) ** -roughness
    amplitude[0, 0] = 0.0
    return np.asarray(amplitude, dtype=np.float32)


def tinted(colour: Colour, tone: FloatArray) -> Image:
    """The colour times (1 + tone), tone (H, W) or (H, W, 3)."""
    tone = tone if tone.ndim == 3 else tone[..., None]
    return np.clip(np.array(colour) * (1.0 + tone) + 0.5, 0, 255).astype(np.uint8)


def softened(image: Image, strength: float) -> Image:
    """The image with its deviation from its mean colour times `strength`: 0 plain, 1 as it is, 2 bold."""
    mean = image.reshape(-1, 3).mean(axis=0)
    return np.asarray(np.clip(mean + strength * (image - mean) + 0.5, 0, 255), dtype=np.uint8)


def plaster(rng: np.random.Generator, colour: Colour, size: int = 512, contrast: float = 0.012) -> Image:
    """Painted wall: nearly plain, with the faint grain of a roller and large pale stains."""
    return tinted(colour, contrast * noise(rng, size, 0.3) + 1.5 * contrast * noise(rng, size, 1.8))


def woodchip(rng: np.random.Generator, colour: Colour, size: int = 512) -> Image:
    """Painted ingrain wallpaper: chips of a few millimetres that stand out and throw a small shadow."""
    chips = np.clip(noise(rng, size, 0.4) - 0.9, 0.0, 1.5)
    relief = chips - np.roll(chips, (2, 1), axis=(0, 1))
    return tinted(colour, 0.19 * relief + 0.02 * noise(rng, size, 0.5) + 0.03 * noise(rng, size, 1.8))


def _grain(rng: np.random.Generator, size: int) -> FloatArray:
    fine = noise(rng, size, 0.9, stretch=18.0)
    wide = noise(rng, size, 1.6, stretch=9.0)
    rings = np.sin(2.0 * np.pi * (2.2 * wide + np.linspace(0.0, 5.0, size, endpoint=False)[:, None]))
    return 0.08 * fine + 0.06 * wide + 0.05 * rings


def _knots(rng: np.random.Generator, size: int, count: int) -> FloatArray:
    tone = np.zeros((size, size))
    reach = np.arange(-size // 12, size // 12)
    for row, column in rng.integers(0, size, (count, 2)):
        distance = np.hypot(reach / 2.2, reach[:, None]) / (rng.uniform(0.007, 0.015) * size)
        knot = np.exp(-distance) * (1.0 + 0.4 * np.cos(5.0 * distance))
        tone[np.ix_((row + reach) % size, (column + reach) % size)] -= rng.uniform(0.35, 0.65) * knot
    return tone


def wood(rng: np.random.Generator, colour: Colour, size: int = 256) -> Image:
    """A board with its grain along u."""
    return tinted(colour, _grain(rng, size) + _knots(rng, size, 4))


def planks(rng: np.random.Generator, colour: Colour, rows: int = 16, size: int = 512) -> Image:
    """Floor boards along u, each with its own tone and grain, joints staggered at random."""
    grain = _grain(rng, size) + _knots(rng, size, 36)
    tone = np.empty((size, size))
    edges = np.linspace(0, size, rows + 1).astype(int)
    for top, bottom in pairwise(edges.tolist()):
        joints = np.sort(rng.integers(0, size, 3))
        board = np.searchsorted(joints, np.arange(size)) % 3
        tone[top:bottom] = np.roll(grain, rng.integers(size), axis=1)[top:bottom] + rng.normal(0.0, 0.15, 3)[board]
        tone[top:bottom, joints] -= 0.4
        tone[top] -= 0.32
    return tinted(colour, tone + 0.04 * noise(rng, size, 1.5))


def parquet(rng: np.random.Generator, colour: Colour, blocks: int = 8, size: int = 512) -> Image:
    """Square blocks of four staves, turned by 90 degrees in turn."""
    block, stave = size // blocks, size // blocks // 4
    grain = _grain(rng, size) + _knots(rng, size, 20)
    tone = np.empty((size, size))
    for row, column in np.ndindex(blocks, blocks):
        y, x = rng.integers(0, size - block, 2)
        patch = grain[y : y + block, x : x + block] + np.repeat(rng.normal(0.0, 0.14, 4), stave)[:, None]
        patch[::stave] -= 0.28
        patch[:, 0] -= 0.28
        rows, columns = slice(row * block, (row + 1) * block), slice(column * block, (column + 1) * block)
        tone[rows, columns] = patch if (row + column) % 2 else patch.T
    return tinted(colour, tone + 0.04 * noise(rng, size, 1.5))


def tiles(rng: np.random.Generator, colour: Colour, count: int = 6, size: int = 512, variation: float = 0.08) -> Image:
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
    return 0.07 * noise(rng, size, 1.5) - 0.28 * ridge**2 * (noise(rng, size, 2.0) > 0.2)


def marble(rng: np.random.Generator, colour: Colour, size: int = 256) -> Image:
    """Clouds, veins and speckles: worktops, stone."""
    speckles = np.where(noise(rng, size, 0.6) > 1.9, -0.4, 0.0)
    return tinted(colour, _veins(rng, size) + speckles + 0.02 * noise(rng, size, 0.2))


def fabric(rng: np.random.Generator, colour: Colour, size: int = 256) -> Image:
    """Woven cloth: threads of uneven tone, a little worn."""
    threads = rng.normal(0.0, 0.07, size)[:, None] + rng.normal(0.0, 0.07, size)[None, :]
    return tinted(colour, threads + 0.11 * noise(rng, size, 0.6) + 0.08 * noise(rng, size, 1.4))


def carpet(rng: np.random.Generator, colour: Colour, size: int = 512) -> Image:
    """Short pile, flecked, with trodden patches."""
    light, dark = (np.where(noise(rng, size, 0.9) > 1.8, tone, 0.0) for tone in (0.35, -0.35))
    return tinted(colour, 0.12 * noise(rng, size, 0.6) + 0.09 * noise(rng, size, 1.4) + light + dark)


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
