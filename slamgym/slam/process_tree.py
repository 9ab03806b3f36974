"""A process and all that it started, as Linux's /proc tells of them."""

import os
from pathlib import Path

_PAGE_MB = os.sysconf("SC_PAGE_SIZE") / 1e6


def process_tree(pid: int) -> list[int]:
    """Ids of a process and of all its descendants that have not lost their parents; none when it is gone."""
    try:
        threads = list(Path(f"/proc/{pid}/task").iterdir())
    except OSError:
        return []
    return [pid, *(found for thread in threads for child in _children(thread) for found in process_tree(child))]


def _children(thread: Path) -> list[int]:
    try:
        return [int(child) for child in (thread / "children").read_text().split()]
    except OSError:  # the thread ended meanwhile, or this kernel does not tell
        return []


def resident_mb(pid: int) -> float:
    """Resident memory of one process, MB; what it shares with others counts in full. 0 when it is gone."""
    try:
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * _PAGE_MB
    except OSError:
        return 0.0


def own_mb(pid: int) -> float:
    """Memory of one process, MB, of what it shares only its part (PSS); takes longer. 0 when it is gone."""
    try:
        for line in Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines():
            if line.startswith("Pss:"):
                return int(line.split()[1]) * 1024 / 1e6
    except OSError:
        return 0.0
    return resident_mb(pid)
