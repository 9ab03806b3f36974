"""Other work on the computer, made on purpose: to see what it does to a SLAM."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from slamgym.errors import SlamError

# By itself and without slamgym, which takes a second to import. PR_SET_PDEATHSIG (1) with SIGKILL (9): see prctl(2).
_PROGRAM = """
import ctypes, os, sys
ctypes.CDLL(None).prctl(1, 9)
if os.getppid() == int(sys.argv[1]):
    os.write(1, b".")
    while True:
        pass
"""


@contextmanager
def busy(count: int) -> Iterator[None]:
    """Around a block: so many processes compute all the time, each on a core as far as there are cores.

    They end with the block, and also when this process, or the thread that entered the block, ends by whatever means.
    Raises SlamError when they cannot be started.
    """
    with ExitStack() as running:
        try:
            processes = [running.enter_context(_burning()) for _ in range(count)]
        except OSError as error:
            raise SlamError(f"busy_processes: cannot start {count}: {error.strerror}; take fewer") from None
        for process in processes:
            assert process.stdout is not None
            process.stdout.read(1)  # it is at work
        yield


@contextmanager
def _burning() -> Iterator["subprocess.Popen[bytes]"]:
    process = subprocess.Popen(
        [sys.executable, "-I", "-S", "-c", _PROGRAM, str(os.getpid())],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        bufsize=0,
    )
    with process:
        try:
            yield process
        finally:
            process.kill()
