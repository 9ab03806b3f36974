from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from slamgym.geometry import from_quaternion
from slamgym.types import FloatArray

PairMaker = Callable[..., tuple[FloatArray, FloatArray]]


def random_frame(rng):
    return from_quaternion(10.0 * rng.normal(size=(1, 3)), rng.normal(size=(1, 4)))[0]


@pytest.fixture(scope="session")
def random_pair() -> PairMaker:
    """random_pair(seed, n, noise): a random walk and a noisy copy in another frame, (n, 4, 4) each.

    noise: in metres and radians. planar: truth in the plane z = 0, turning about z. pauses: after the fourth pose half
    of the steps turn without moving.
    """

    def make(seed: int, n: int, noise: float = 0.1, *, planar: bool = False, pauses: bool = False):
        rng = np.random.default_rng(seed)
        steps, turns = rng.normal(size=(2, n, 3))
        if planar:
            steps[:, 2] = 0.0
            turns[:, :2] = 0.0
        if pauses:
            steps[4:] *= rng.random((max(n - 4, 0), 1)) < 0.5
        ref_T = from_quaternion(np.cumsum(steps, axis=0), Rotation.from_rotvec(turns).as_quat())
        shake = Rotation.from_rotvec(noise * rng.normal(size=(n, 3)))
        noise_T = from_quaternion(noise * rng.normal(size=(n, 3)), shake.as_quat())
        return ref_T, random_frame(rng) @ ref_T @ noise_T

    return make


@pytest.fixture(scope="session")
def straight() -> Callable[..., FloatArray]:
    """straight([0, 1, 3]): poses at these x, metres, on the x axis; turned by these yaws, degrees, about z."""

    def make(x, yaw_deg=0.0) -> FloatArray:
        T = np.tile(np.eye(4), (len(x), 1, 1))
        T[:, 0, 3] = x
        yaws = np.broadcast_to(yaw_deg, len(x))[:, None]
        T[:, :3, :3] = Rotation.from_euler("z", yaws, degrees=True).as_matrix()
        return T

    return make
