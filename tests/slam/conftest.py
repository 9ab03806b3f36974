import numpy as np
import pytest

from slamgym.camera import PinholeCamera
from slamgym.slam.backend import SlamConfig
from slamgym.types import Frame

TINY = PinholeCamera(32, 24, 30.0, 30.0, 15.5, 11.5)


@pytest.fixture
def config() -> SlamConfig:
    return SlamConfig(TINY, fps=30.0)


@pytest.fixture
def frame():
    """A tiny frame whose images are filled with the number that it is made from."""

    def make(number: int) -> Frame:
        shape = (TINY.height, TINY.width)
        pose = np.eye(4)
        pose[0, 3] = number
        return Frame(number, np.full((*shape, 3), number, np.uint8), np.full(shape, number, np.float32), pose)

    return make
