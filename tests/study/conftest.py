import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from uuid import uuid4

import numpy as np
import pytest

from slamgym.camera import PinholeCamera
from slamgym.eval.datasets import SequenceWriter
from slamgym.study.spec import read_study
from slamgym.types import Frame

CAMERA = PinholeCamera(80, 60, 60.0, 60.0, 39.5, 29.5)

RUN = """
import sys
from pathlib import Path

from slamgym.study.run import run_study
from slamgym.study.spec import read_study

if __name__ == "__main__":
    file, out, workers = sys.argv[1:]
    run_study(read_study(file), Path(out), int(workers))
"""


@pytest.fixture(scope="session")
def sequences(tmp_path_factory):
    """Folders of three recorded sequences, 20 frames of noise along a straight line each: quick to run a SLAM over."""
    above = tmp_path_factory.mktemp("data") / "straight"
    rng = np.random.default_rng(0)
    for number in range(3):
        with SequenceWriter(above / f"line{number}", CAMERA, 20.0) as writer:
            for k in range(20):
                T_world_cam = np.eye(4)
                T_world_cam[0, 3] = 0.02 * (number + 1) * k
                rgb = rng.integers(256, size=(60, 80, 3), dtype=np.uint8)
                writer.add(Frame(k * 50_000_000, rgb, np.full((60, 80), 2.0, np.float32), T_world_cam))
    return sorted(above.iterdir())


@pytest.fixture
def study(tmp_path):
    """A function that makes a study of a file's text."""

    def make(text, name="study.yaml"):
        path = tmp_path / name
        path.write_text(text)
        return read_study(path)

    return make


class StudyProcess:
    """`run_study` in a process of its own, in a session of its own; `pids` are of all processes that it brought up."""

    def __init__(self, script: Path, file: Path, out: Path, workers: int = 2) -> None:
        self._mark = f"STUDY_OF_TEST={uuid4()}"
        name, _, value = self._mark.partition("=")
        self.process = subprocess.Popen(
            [sys.executable, script, file, out, str(workers)],
            env={**os.environ, name: value},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            text=True,
        )

    def pids(self) -> set[int]:
        found = set()
        for environment in Path("/proc").glob("[0-9]*/environ"):
            try:
                if self._mark.encode() in environment.read_bytes():
                    found.add(int(environment.parent.name))
            except OSError:  # ended meanwhile
                continue
        return found

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()

    def orphans(self) -> list[str]:
        """What is left of its processes after a while; one that was just starting looks for its parent when it has."""
        wait_for(lambda: not self.pids(), 60.0)
        return [Path(f"/proc/{pid}/cmdline").read_text() for pid in self.pids()]

    def close(self) -> None:
        for pid in self.pids():
            os.kill(pid, signal.SIGKILL)
        self.process.communicate()


def wait_for(happened: Callable[[], bool], longest_s: float) -> bool:
    deadline = time.monotonic() + longest_s
    while not (there := happened()) and time.monotonic() < deadline:
        time.sleep(0.02)
    return there


@pytest.fixture
def wait_until():
    return wait_for


@pytest.fixture
def started(tmp_path):
    """A function that starts a study's file in a process of its own."""
    script = tmp_path / "run.py"
    script.write_text(RUN)
    running = []

    def start(file, out, workers=2):
        running.append(StudyProcess(script, file, out, workers))
        return running[-1]

    yield start
    for one in running:
        one.close()
