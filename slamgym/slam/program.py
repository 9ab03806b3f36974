"""Running a program that must not outlive this process, whatever ends it, nor may what the program starts."""

import ctypes
import os
import shlex
import signal
import subprocess
import sys
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from slamgym.errors import SlamError

_PR_SET_PDEATHSIG = 1
_PR_SET_CHILD_SUBREAPER = 36


def run_program(words: Sequence[str], folder: Path, accepted: Collection[int]) -> None:
    """Run a program in a folder to its end, its output going where this process's goes.

    Raises SlamError when it cannot be started or ends with another exit code; 128 + n is that of signal n.
    """
    # Ours is made for this process, and would break a program of another Python.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    sys.stderr.write(f"{shlex.join(words)}\n")
    sys.stderr.flush()
    with _process_group() as group:
        try:
            process = subprocess.Popen(
                words, cwd=folder, env=environment, stdin=subprocess.DEVNULL, process_group=group
            )
        except OSError as error:
            raise SlamError(
                f"slam backend 'command': cannot start {words[0]}: {error.strerror}; is it built for this machine, or "
                "a script whose first line names its interpreter?"
            ) from None
        code = process.wait()
    code = 128 - code if code < 0 else code
    if code not in accepted:
        raise SlamError(
            f"slam backend 'command': {Path(words[0]).name} ended with exit code {code}{_signal_name(code)}, expected "
            f"{' or '.join(map(str, accepted))}; see its output, and if its trajectory is complete by then, name the "
            "code in the slam option 'accept_exit_codes'"
        )


def _signal_name(code: int) -> str:
    try:
        return f" ({signal.Signals(code - 128).name})"
    except ValueError:
        return ""


def adopt_orphans() -> None:
    """Become the parent of what descendants of this process leave behind: so nothing gets out of sight (prctl(2))."""
    ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, 1)


def signal_after(parent_pid: int, number: signal.Signals) -> None:
    """Have the kernel send this process a signal when its parent ends in whatever way (prctl(2), PR_SET_PDEATHSIG)."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, number)
    if os.getppid() != parent_pid:  # it ended before the line above
        signal.raise_signal(number)


@contextmanager
def _process_group() -> Iterator[int]:
    """A process group, for `subprocess.Popen`, all of which is killed after the block.

    It is also killed when this process ends within the block, even by SIGKILL: its leader, a process that only waits,
    is told so by the kernel.
    """
    watched = os.getpid()
    leader = os.fork()
    if leader == 0:
        _kill_group_after(watched)
    os.setpgid(leader, leader)  # both do it, since neither can know which comes first
    try:
        yield leader
    finally:
        os.killpg(leader, signal.SIGKILL)
        os.waitpid(leader, 0)


def _kill_group_after(watched: int) -> None:
    os.setpgid(0, 0)
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM})
    signal_after(watched, signal.SIGTERM)
    signal.sigwait({signal.SIGTERM})
    os.killpg(0, signal.SIGKILL)
