"""How the vocabulary that comes with slamgym is made: from images of procedural houses that no evaluation uses."""

import lzma
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from slamgym.camera import CAMERAS
from slamgym.geometry import mast_camera_pose
from slamgym.render import Renderer
from slamgym.scenes.light import bake_light
from slamgym.scenes.occupancy import free_space, occupancy_grid
from slamgym.scenes.registry import load_scene
from slamgym.slam.vocabulary import PACKED, Descriptors, Vocabulary, train

TRAINING_SEEDS = range(1_000_000, 1_000_012)
"""Seeds from 1,000,000 on are for training; evaluations use smaller ones."""

IMAGES_PER_HOUSE = 12
CAMERA_HEIGHTS_M = (0.3, 1.4)
_ROBOT_HEIGHT_M, _ROBOT_RADIUS_M = 0.5, 0.2


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


def image_descriptors(rgb: NDArray[np.uint8], features: int = 1000) -> Descriptors:
    """ORB descriptors (N, 32) of an image (H, W, 3), with N at most `features`."""
    orb = cv2.ORB_create(nfeatures=features, fastThreshold=12)  # type: ignore[attr-defined]
    descriptors = orb.detectAndCompute(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY), None)[1]
    return np.empty((0, 32), np.uint8) if descriptors is None else descriptors


def train_on_houses(seeds: range = TRAINING_SEEDS, images_per_house: int = IMAGES_PER_HOUSE) -> Vocabulary:
    """Vocabulary from rendered houses; takes about a minute for all of them."""
    return train([image_descriptors(rgb) for seed in seeds for rgb in house_images(seed, images_per_house)])


def write_packed(vocabulary: Vocabulary, path: Path = PACKED) -> None:
    """Write the text format, xz-compressed: by default over the vocabulary that comes with slamgym."""
    path.write_bytes(lzma.compress(vocabulary.to_text().encode(), preset=9 | lzma.PRESET_EXTREME))


if __name__ == "__main__":
    write_packed(train_on_houses())
