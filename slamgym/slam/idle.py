"""Whether a process only idles, read from Linux's /proc. Lock-step waits for that after each frame.

A SLAM's threads poll their queues a few milliseconds apart. So one look says little: a process idles when between two
looks none of its threads used more CPU than polling costs, and none wants to run. The state matters on a busy machine,
where a thread that waits for a core uses no CPU either.
"""

import time
from collections.abc import Callable
from pathlib import Path

from slamgym.errors import ConfigError

LOOK_INTERVAL_S = 0.006
"""Longer than the longest sleep between two polls of ORB-SLAM3's threads (loop closing: 5 ms)."""

POLLING_NS = 300_000
"""CPU time that a thread may use between two looks and still be called idle."""

Look = dict[int, tuple[str, int]]
"""Thread id -> state letter as in `ps`, and CPU time used so far, nanoseconds."""


def check_lockstep_possible() -> None:
    """Raise ConfigError where the kernel does not tell the CPU time of threads."""
    if not Path("/proc/self/schedstat").exists():
        raise ConfigError("slam_sync 'lockstep' needs Linux's /proc/PID/schedstat, missing here; use slam_sync='free'")


def look(pid: int) -> Look:
    """What the threads of a process do now; empty when it is gone."""
    seen: Look = {}
    try:
        for task in Path(f"/proc/{pid}/task").iterdir():
            seen[int(task.name)] = _thread(task)
    except OSError:  # a thread or the process ended meanwhile: the next look tells
        pass
    return seen


def _thread(task: Path) -> tuple[str, int]:
    # The state follows the command name, which is in brackets and may hold any character.
    state = (task / "stat").read_text().rpartition(")")[2].split()[0]
    return state, int((task / "schedstat").read_text().split()[0])


def only_idled(before: Look, after: Look) -> bool:
    """Whether nothing but polling happened between two looks; a thread that came or went is work."""
    return before.keys() == after.keys() and all(
        state not in "RD" and cpu_ns - before[thread][1] < POLLING_NS for thread, (state, cpu_ns) in after.items()
    )


def wait_until_idle(pid: int, limit_s: float, on_look: Callable[[], None] = lambda: None) -> bool:
    """Block until the process only idles or is gone; False when that took longer than `limit_s` seconds.

    on_look: called at every look; what it raises ends the wait.
    """
    deadline = time.monotonic() + limit_s
    before = look(pid)
    while time.monotonic() < deadline:
        time.sleep(LOOK_INTERVAL_S)
        on_look()
        after = look(pid)
        if only_idled(before, after):
            return True
        before = after
    return False
