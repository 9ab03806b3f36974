"""The computer that results were made on."""

import os
import platform
from functools import cache
from pathlib import Path


def cores() -> int:
    """How many cores this process may use."""
    return len(os.sched_getaffinity(0))


@cache
def computer_name() -> str:
    """The processor and how many of its cores this process may use, such as "AMD EPYC, 2 cores"."""
    usable = cores()
    return f"{_processor()}, {usable} core{'' if usable == 1 else 's'}"


def _processor() -> str:
    """What Linux calls it, of processors without a name the architecture."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(filter(None, names), platform.machine())
