"""The view from a window: sky, hills in haze, houses and trees, a little out of focus and overexposed."""

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from slamgym.scenes.home.textures import Image, noise
from slamgym.types import FloatArray

_HAZE = np.array([226.0, 231.0, 236.0])
_SIZE = 512
_FACADES = ((196, 178, 152), (170, 122, 100), (206, 200, 188), (150, 140, 130), (188, 160, 120))
_ROOFS = ((118, 74, 60), (92, 88, 90), (130, 92, 72))


def outside(rng: np.random.Generator, height: int = 384) -> Image:
    """A street or a garden by day, uint8 (height, 512, 3)."""
    grain, clouds = noise(rng, _SIZE, 1.0), noise(rng, _SIZE, 2.0)
    image = _sky(clouds[:height], height)
    horizon = int(height * rng.uniform(0.52, 0.62))
    for level, share in ((0.0, 0.75), (0.05, 0.55)):
        _hill(image, horizon - height * (0.06 - level) - 7.0 * noise(rng, _SIZE, 1.8)[0], share, grain)
    for x in np.arange(-40, _SIZE, rng.integers(90, 150)):
        if rng.random() < 0.75:
            _house(rng, image, int(x), int(horizon + height * rng.uniform(0.06, 0.14)))
    _ground(image, horizon + int(0.1 * height), grain)
    for _ in range(int(rng.integers(5, 10))):
        _tree(rng, image, grain, rng.uniform(0, _SIZE), horizon - height * rng.uniform(-0.08, 0.18))
    blurred = cv2.GaussianBlur(image, (0, 0), 1.3)
    return np.asarray(np.clip(20.0 + 0.98 * blurred, 0, 255), dtype=np.uint8)


def _sky(clouds: FloatArray, height: int) -> FloatArray:
    fade = np.linspace(0.0, 1.6, height).clip(0.0, 1.0)[:, None, None]
    blue = np.array([150.0, 186.0, 224.0]) * (1.0 - fade) + _HAZE * fade
    cover = (0.25 + 0.45 * clouds).clip(0.0, 0.9)[..., None]
    return np.asarray(blue * (1.0 - cover) + 246.0 * cover)


def _hazy(colour: ArrayLike, share: float) -> FloatArray:
    return np.asarray(np.asarray(colour) * (1.0 - share) + _HAZE * share)


def _hill(image: FloatArray, ridge: FloatArray, share: float, grain: FloatArray) -> None:
    below = np.arange(len(image))[:, None] > ridge
    tone = 1.0 + 0.08 * grain[: len(image)][below]
    image[below] = _hazy((84, 106, 78), share) * tone[:, None]


def _house(rng: np.random.Generator, image: FloatArray, x: int, base: int) -> None:
    """A front with rows of windows under a pitched roof."""
    width, storeys = int(rng.integers(70, 120)), int(rng.integers(2, 5))
    eaves, ridge = base - 30 * storeys, base - 30 * storeys - int(rng.integers(14, 34))
    front, roof = (colours[int(rng.integers(len(colours)))] for colours in (_FACADES, _ROOFS))
    outline = np.array([(x - 4, eaves), (x + 12, ridge), (x + width - 12, ridge), (x + width + 4, eaves)])
    cv2.fillPoly(image, [outline.astype(np.int32)], _hazy(roof, 0.2).tolist(), cv2.LINE_AA)
    cv2.rectangle(image, (x, eaves), (x + width, base), (_hazy(front, 0.18) * rng.uniform(0.85, 1.1)).tolist(), -1)
    for y in range(eaves + 7, base - 16, 30):
        for left in range(x + 8, x + width - 14, 22):
            cv2.rectangle(image, (left - 1, y - 1), (left + 11, y + 17), (232, 230, 226), -1)
            cv2.rectangle(
                image, (left, y), (left + 10, y + 16), _hazy((70, 80, 92), rng.uniform(0.0, 0.5)).tolist(), -1
            )


def _ground(image: FloatArray, top: int, grain: FloatArray) -> None:
    depth = np.linspace(0.45, 0.0, len(image) - top)[:, None, None]
    lawn = np.array([112.0, 130.0, 84.0]) * (1.0 + 0.1 * grain[top : len(image), :, None])
    image[top:] = lawn * (1.0 - depth) + _HAZE * depth


def _tree(rng: np.random.Generator, image: FloatArray, grain: FloatArray, x: float, y: float) -> None:
    """A crown with a ragged edge, lit from above, on a trunk."""
    radius = rng.uniform(26.0, 58.0)
    trunk = (int(x), int(y)), (int(x), int(y + 2.2 * radius))
    cv2.line(image, *trunk, (84, 70, 58), max(3, int(radius / 9)), cv2.LINE_AA)
    left, top = max(0, int(x - 1.7 * radius)), max(0, int(y - 1.7 * radius))
    area = slice(top, int(y + 1.7 * radius)), slice(left, int(x + 1.7 * radius))
    patch = image[area]
    rows, columns = np.mgrid[: patch.shape[0], : patch.shape[1]]
    dx, dy = (columns + left - x) / radius, (rows + top - y) / (0.9 * radius)
    alpha = (6.0 * (1.0 - np.hypot(dx, dy) + 0.22 * grain[: len(image)][area])).clip(0.0, 1.0)[..., None]
    tone = (0.95 - 0.28 * dy + 0.2 * np.roll(grain, 7, axis=1)[: len(image)][area]).clip(0.35, 1.5)[..., None]
    green: NDArray[np.float64] = np.array([88.0, 112.0, 62.0]) * rng.uniform(0.8, 1.15)
    patch[:] = patch * (1.0 - alpha) + _hazy(green, 0.1) * tone * alpha
