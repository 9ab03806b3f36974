"""Images that vocabularies are trained from: of procedural houses that no evaluation uses, or from a folder.

Run as a program it makes the vocabulary that comes with slamgym anew.
"""

import lzma
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from slamgym.camera import CAMERAS
from slamgym.errors import ConfigError
from slamgym.files import write_atomically
from slamgym.geometry import mast_camera_pose
from slamgym.render import Renderer
from slamgym.scenes.light import bake_light
from slamgym.scenes.occupancy import free_space, occupancy_grid
from slamgym.scenes.registry import load_scene
from slamgym.slam.vocabulary import PACKED
from slamgym.slam.vocabulary_file import Descriptors, Vocabulary
from slamgym.slam.vocabulary_tree import train

TRAINING_SEEDS = range(1_000_000, 1_000_012)
"""Seeds from 1,000,000 on are for training; evaluations use smaller ones."""

IMAGES_PER_HOUSE = 12
FEATURES = 1000
CAMERA_HEIGHTS_M = (0.3, 1.4)
_ROBOT_HEIGHT_M, _ROBOT_RADIUS_M = 0.5, 0.2

IMAGE_SUFFIXES = (".png", ".jpg", ".jpeg")
LONGEST_SIDE = 1280
"""Pixels; larger photographs are made so small, as a SLAM's camera would see the same."""

_SMALLEST_SIDE = 63  # ORB leaves a border of 31 pixels out


def house_images(seed: int, count: int = IMAGES_PER_HOUSE) -> Iterator[NDArray[np.uint8]]:
    """Colour images (H, W, 3) of the procedural house `seed`, from random places where a robot can stand."""
    rng = np.random.default_rng(seed)
    house = bake_light(load_scene(f"procedural:{seed}"))
    grid = occupancy_grid(house, _ROBOT_HEIGHT_M)
    cells = rng.choice(np.argwhere(free_space(grid, _ROBOT_RADIUS_M)), count)
    with Renderer(house, CAMERAS["default"]) as renderer:
        for x, y in grid.centre_of(cells):
            pose = mast_camera_pose(x, y, rng.uniform(-np.pi, np.pi), rng.uniform(*CAMERA_HEIGHTS_M))
            yield renderer.render(pose)[0]


def image_files(folder: Path, limit: int) -> list[Path]:
    """At most `limit` PNG and JPEG files in the folder and below, evenly spread over all of them in order.

    Depth images, which sequences keep in folders named `depth`, are left out. Raises ConfigError without any image.
    """
    if not folder.is_dir():
        raise ConfigError(f"expected a folder of images, got {folder}; name an existing one")
    found = sorted(path for path in folder.rglob("*") if path.suffix.lower() in IMAGE_SUFFIXES)
    found = [path for path in found if "depth" not in path.relative_to(folder).parts[:-1]]
    if not found:
        raise ConfigError(f"expected images ({', '.join(IMAGE_SUFFIXES)}) in {folder}, got none; name another folder")
    return [found[k] for k in np.linspace(0, len(found) - 1, min(limit, len(found))).round().astype(int)]


def read_image(path: Path) -> NDArray[np.uint8] | None:
    """Colour image (H, W, 3), its longer side at most LONGEST_SIDE pixels; None when the file cannot be read."""
    try:
        with _silent_opencv():
            bgr = cv2.imdecode(np.fromfile(path, np.uint8), cv2.IMREAD_COLOR)
    except (OSError, cv2.error):
        return None
    if bgr is None:
        return None
    scale = LONGEST_SIDE / max(bgr.shape)
    small = bgr if scale >= 1 else cv2.resize(bgr, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    return np.ascontiguousarray(small[..., ::-1], dtype=np.uint8)


@contextmanager
def _silent_opencv() -> Iterator[None]:
    """OpenCV prints about bad files; whoever asked for them tells it in one line."""
    log = cv2.utils.logging
    level = log.getLogLevel()
    log.setLogLevel(log.LOG_LEVEL_SILENT)
    try:
        yield
    finally:
        log.setLogLevel(level)


def image_descriptors(rgb: NDArray[np.uint8], features: int = FEATURES) -> Descriptors:
    """ORB descriptors (N, 32) of an image (H, W, 3), with N at most `features`."""
    nothing = np.empty((0, 32), np.uint8)
    if min(rgb.shape[:2]) < _SMALLEST_SIDE:
        return nothing
    orb = cv2.ORB_create(nfeatures=features, fastThreshold=12)  # type: ignore[attr-defined]
    descriptors = orb.detectAndCompute(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY), None)[1]
    return nothing if descriptors is None else descriptors


def house_descriptors(
    seeds: Sequence[int] = TRAINING_SEEDS, images_per_house: int = IMAGES_PER_HOUSE, features: int = FEATURES
) -> Iterator[Descriptors]:
    """Descriptors (N, 32) of each image of each house, N at most `features`; about a minute for all defaults."""
    return (image_descriptors(rgb, features) for seed in seeds for rgb in house_images(seed, images_per_house))


def write_packed(vocabulary: Vocabulary, path: Path = PACKED) -> None:
    """Write the text format, xz-compressed: by default over the one that comes with slamgym; raises OutputError."""
    write_atomically(path, lzma.compress(vocabulary.to_text().encode(), preset=9 | lzma.PRESET_EXTREME))


if __name__ == "__main__":
    write_packed(train(list(house_descriptors())))
