import os
from collections import Counter
from pathlib import Path
from weakref import WeakSet

import pytest

from slamgym.slam.session import SlamSession


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Real sequences, trajectories and scenes that are not part of the project."""
    folder = Path(__file__).resolve().parents[2] / "shared" / "data"
    if not folder.is_dir():
        pytest.skip(f"real test data not found: expected the folder {folder.parent.name}/data beside the checkout")
    return folder


@pytest.fixture
def children():
    """A function that gives the ids of all live descendants of this process."""

    def descendants() -> set[int]:
        parents = {}
        for stat in Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = stat.read_text().rpartition(")")[2].split()
            except OSError:
                continue
            if fields[0] != "Z":
                parents[int(stat.parent.name)] = int(fields[1])
        found = {os.getpid()}
        while grown := {pid for pid, parent in parents.items() if parent in found} - found:
            found |= grown
        return found - {os.getpid()}

    return descendants


@pytest.fixture
def faulty(monkeypatch):
    """Name of a backend in faulty_backends.py, for SlamSession; the worker inherits the import path."""
    monkeypatch.syspath_prepend(str(Path(__file__).parent / "slam"))
    return lambda name: f"faulty_backends:{name}"


@pytest.fixture(scope="session", autouse=True)
def _own_cache(tmp_path_factory):
    """Light is baked anew, once for all tests; what a user has in the cache is neither read nor touched."""
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("SLAMGYM_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


FRAMES_FED: Counter[str] = Counter()


@pytest.fixture(scope="session", autouse=True)
def _count_frames():
    """Count the frames that each backend really answered in this process, for the line below the results."""
    close = SlamSession.close
    counted: WeakSet[SlamSession] = WeakSet()

    def counting_close(session: SlamSession) -> None:
        if session not in counted:
            counted.add(session)
            FRAMES_FED[session.backend] += len(session.track_s)
        close(session)

    SlamSession.close = counting_close
    yield
    SlamSession.close = close


def pytest_terminal_summary(terminalreporter):
    frames = FRAMES_FED["slamgym.slam.orbslam3:OrbSlam3"]
    terminalreporter.write_line(f"real ORB-SLAM3 frames run in this process: {frames}")
