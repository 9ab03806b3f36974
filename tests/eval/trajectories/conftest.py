import numpy as np
import pytest

from slamgym.eval.trajectories import Trajectory
from slamgym.geometry import from_quaternion


@pytest.fixture(scope="session")
def trajectory_at():
    """trajectory_at(stamps_ns): poses at these stamps, all of them the identity."""

    def make(stamps_ns) -> Trajectory:
        return Trajectory(np.array(stamps_ns, dtype=np.int64), np.tile(np.eye(4), (len(stamps_ns), 1, 1)))

    return make


@pytest.fixture(scope="session")
def random_trajectory():
    """random_trajectory(n, seed): poses at stamps of today with all digits down to the nanosecond."""

    def make(n, seed=0) -> Trajectory:
        rng = np.random.default_rng(seed)
        stamps_ns = np.cumsum(rng.integers(1, 10**8, size=n)) + 1_305_031_102_160_407_003
        return Trajectory(stamps_ns, from_quaternion(rng.normal(size=(n, 3)), rng.normal(size=(n, 4))))

    return make


@pytest.fixture
def write(tmp_path):
    """write(text, name): the path of a new file with that text."""

    def write_file(text, name="t.txt"):
        (tmp_path / name).write_text(text, encoding="utf-8")
        return tmp_path / name

    return write_file
