"""Faults of all kinds in the loop of an environment, one after another: each is an outcome, and nothing is left."""

import os
import tempfile
from pathlib import Path
from typing import NamedTuple
from uuid import uuid4

import gymnasium as gym
import numpy as np
import pytest

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.rollout import run_episode

DRIVE = {"camera": "small", "speed": 1.0, "path_length_m": 1.0}
FRAMES = range(2, 12)
"""Those that a fault may come at; the drive has some 30."""


class Fault(NamedTuple):
    backend: str
    status: str
    failure: str
    limits: dict[str, float] = {}  # noqa: RUF012


SHORT = {"slam_timeout_s": 1.5}
FAULTS = (
    Fault("Segfaults", "crashed", "Segmentation fault"),
    Fault("Aborts", "crashed", "Aborted"),
    Fault("Raises", "crashed", "ValueError"),
    Fault("Exits", "crashed", "exit code 0"),
    Fault("Sleeps", "timeout", "no answer", SHORT),
    Fault("Spins", "timeout", "no answer", SHORT),
    Fault("HoldsGil", "timeout", "no answer", SHORT),
    Fault("LeavesChildren", "timeout", "no answer", SHORT),
    Fault("LeavesFiles", "crashed", "Aborted"),
    Fault("GrowsMemory", "crashed", "more than its limit", {"slam_memory_mb": 300}),
    Fault("Chatters", "ok", ""),
    Fault("AnswersUnpicklable", "crashed", "expected the backend to answer"),
    Fault("AnswersNothing", "crashed", "expected the backend to answer"),
    Fault("AbortsAtStart", "crashed", "Aborted"),
    Fault("AbortsAtFinish", "crashed", "Aborted"),
    Fault("HangsAtFinish", "timeout", "no answer", {"slam_finish_timeout_s": 2.0}),
)


def descendants(mark: str) -> set[int]:
    """All processes that inherited the mark, those that lost their parents included, but this one."""
    found = set()
    for environ in Path("/proc").glob("[0-9]*/environ"):
        try:
            if mark.encode() in environ.read_bytes():
                found.add(int(environ.parent.name))
        except OSError:
            continue
    return found - {os.getpid()}


@pytest.fixture
def leftovers(monkeypatch, tmp_path):
    """A function that gives all that the runs so far have left behind."""
    mark = f"SLAMGYM_TEST_MARK={uuid4()}"
    monkeypatch.setenv(*mark.split("="))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    shared = set(Path("/dev/shm").iterdir())
    files = len(list(Path("/proc/self/fd").iterdir()))

    def found() -> dict[str, object]:
        return {
            "processes": descendants(mark),
            "files in memory": set(Path("/dev/shm").iterdir()) - shared,
            "temporary files": list(tmp_path.iterdir()),
            "open files": len(list(Path("/proc/self/fd").iterdir())) - files,
        }

    return found


NOTHING = {"processes": set(), "files in memory": set(), "temporary files": [], "open files": 0}


def episode(**params):
    env = gym.make("HomeRobotSLAM-v0", **DRIVE, **params)
    try:
        return run_episode(env, PathFollower(), seed=3)
    finally:
        env.close()


def inject(number: int, faulty) -> str:
    """One fault, at a random frame; what the episode came to."""
    rng = np.random.default_rng(number)
    fault = FAULTS[number % len(FAULTS)]
    summary = episode(slam=faulty(fault.backend), slam_options={"fault_frame": rng.choice(FRAMES)}, **fault.limits)
    assert summary.summary["status"] == fault.status, fault
    assert fault.failure in summary.summary["failure"], fault
    if fault.status != "ok":
        assert summary.summary["failure"], fault
    return fault.backend


def check_right_episode() -> None:
    summary = episode(slam="groundtruth").summary
    assert (summary["status"], summary["success"]) == ("ok", True)
    assert summary["ate_rmse_m"] < 1e-9


def run_faults(numbers, faulty, leftovers) -> None:
    episode(slam="groundtruth")  # what is opened once, as the renderer's library, is no leak
    before = leftovers()["open files"]
    for number in numbers:
        backend = inject(number, faulty)
        check_right_episode()
        assert leftovers() == {**NOTHING, "open files": before}, f"fault {number}, {backend}"


def test_each_kind_of_fault(faulty, leftovers):
    run_faults(range(len(FAULTS)), faulty, leftovers)


@pytest.mark.faults
def test_200_faults(faulty, leftovers):
    run_faults(range(200), faulty, leftovers)
