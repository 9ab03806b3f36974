"""A function in a process of its own, with bounded memory and time: readers of other people's files may need both.

Run as a program, this module is that process: what to call comes in by its input, the result goes into a
file in memory.
"""

import ctypes
import os
import pickle
import resource
import signal
import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO, ParamSpec, TypeVar

from slamgym.errors import SceneError

MEMORY_BYTES = 8 << 30
TIME_S = 300.0
_PR_SET_PDEATHSIG = 1

P = ParamSpec("P")
T = TypeVar("T")


def call_bounded(
    what: str, function: Callable[P, T], memory_bytes: int = MEMORY_BYTES, time_s: float = TIME_S
) -> Callable[P, T]:
    """`function`, of a module's top level, as one that runs in a process with at most so much memory and time.

    What goes in and out must be picklable. It raises SceneError: the function's own, or one that begins with `what`
    when memory or time is exhausted, the process crashes, or anything else is raised there.
    """

    def bounded(*args: P.args, **kwargs: P.kwargs) -> T:
        request = pickle.dumps((function, args, kwargs, what, memory_bytes, os.getpid()))
        with os.fdopen(os.memfd_create("slamgym-result"), "rb") as results:  # gone when both processes have closed it
            code = _run(request, results.fileno(), time_s)
            if code is None:
                raise SceneError(f"{what}: expected to be read within {time_s:g} s; simplify it")
            if code != 0:
                raise SceneError(f"{what}: its reader ended with {_ending(code)}; export it again, or simplify it")
            result: T | SceneError = pickle.load(results)
        if isinstance(result, SceneError):
            raise result
        return result

    return bounded


def _run(request: bytes, results_fd: int, time_s: float) -> int | None:
    """The exit status of this module as a program; None when it had to be killed."""
    try:
        done = subprocess.run(
            [sys.executable, "-P", "-m", __name__, str(results_fd)],
            input=request,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            pass_fds=(results_fd,),
            timeout=time_s,
            env=os.environ | {"PYTHONPATH": os.pathsep.join(path or str(Path.cwd()) for path in sys.path)},
            check=False,
        )
    except subprocess.TimeoutExpired:
        return None
    return done.returncode


def _ending(code: int) -> str:
    return signal.strsignal(-code) or str(code) if code < 0 else f"exit status {code}"


def _serve(requests: BinaryIO, results: BinaryIO) -> None:
    function, args, kwargs, what, memory_bytes, parent = pickle.load(requests)
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        return
    resource.setrlimit(resource.RLIMIT_AS, (memory_bytes, memory_bytes))
    result: object
    try:
        result = function(*args, **kwargs)
    except SceneError as error:
        result = error
    except MemoryError:
        result = SceneError(f"{what}: expected to need at most {memory_bytes >> 20} MB of memory; simplify it")
    except Exception as error:  # the reader's libraries may fail in any way
        why = " ".join(f"{type(error).__name__}: {error}".split())[:200]
        result = SceneError(f"{what}: cannot be read ({why}); export it again")
    pickle.dump(result, results, protocol=pickle.HIGHEST_PROTOCOL)
    results.flush()
    results.seek(0)  # both processes share the position


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    with os.fdopen(int(sys.argv[1]), "wb") as to_caller:
        _serve(sys.stdin.buffer, to_caller)
