"""What a replay costs: a recorded sequence through the harness against a bare loop over the same files on the wheel.

Both read the images from the disk and track them with ORB-SLAM3, without waiting for its threads. The best of some
rounds each, taken in turns, so that a busy moment of the machine does not count. Run by `make bench`.
"""

import tempfile
import time
from pathlib import Path

import cv2
import gymnasium as gym
import numpy as np
import pyorbslam3
from rich.console import Console
from rich.table import Table

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.eval.datasets import Sequence, read_sequence
from slamgym.params import SlamParams
from slamgym.recording import record_drive
from slamgym.replay import replay
from slamgym.slam.backend import SlamConfig
from slamgym.slam.orb_settings import OrbOptions, settings
from slamgym.slam.vocabulary import vocabulary_path

ROUNDS = 3
WARM_UP = 30
"""Frames left out: initialisation and first use."""


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        env = gym.make("HomeRobot-v0", speed=0.4, path_length_m=6.0)
        record_drive(env, PathFollower(), 7, Path(folder))
        env.close()
        sequence = read_sequence(folder)
        bare_ms, ours_ms = zip(*((bare(sequence, Path(folder)), ours(sequence)) for _ in range(ROUNDS)), strict=True)
    table = Table("what", "value", title=f"replay, 640x480, {len(sequence)} frames from the disk")
    table.add_row("bare loop: read and track_rgbd", f"{min(bare_ms):.1f} ms a frame")
    table.add_row("replay, free", f"{min(ours_ms):.1f} ms a frame")
    table.add_row("replay / bare loop", f"{min(ours_ms) / min(bare_ms):.2f}  (aim: at most 1.05)")
    Console().print(table)


def ours(sequence: Sequence) -> float:
    """Milliseconds a frame of a replay in free mode."""
    begins: list[float] = []
    replay(sequence, SlamParams(slam_sync="free"), lambda _: begins.append(time.perf_counter()))
    return (begins[-1] - begins[WARM_UP]) / (len(begins) - 1 - WARM_UP) * 1e3


def bare(sequence: Sequence, folder: Path) -> float:
    """Milliseconds a frame of a loop with nothing of slamgym in it."""
    with tempfile.TemporaryDirectory() as temporary:
        path = Path(temporary) / "settings.yaml"
        path.write_text(settings(SlamConfig(sequence.camera, sequence.fps), OrbOptions()))
        slam = pyorbslam3.Slam(vocabulary_path(None), path, pyorbslam3.Sensor.RGBD)
    lines = [line.split() for line in (folder / "associations.txt").read_text().splitlines() if line[0] != "#"]
    begins = []
    for stamp, rgb_file, _, depth_file in lines:
        begins.append(time.perf_counter())
        bgr, raw = (cv2.imread(str(folder / name), cv2.IMREAD_UNCHANGED) for name in (rgb_file, depth_file))
        assert bgr is not None
        assert raw is not None
        depth = raw.astype(np.float32) / np.float32(5000.0)
        slam.track_rgbd(cv2.cvtColor(bgr, cv2.COLOR_BGR2RGB), depth, float(stamp))
    slam.shutdown()
    return (begins[-1] - begins[WARM_UP]) / (len(begins) - 1 - WARM_UP) * 1e3


if __name__ == "__main__":
    main()
