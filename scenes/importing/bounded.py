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
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, ParamSpec, TypeVar

from slamgym.errors import SceneError

MEMORY_BYTES = 8 << 30
TIME_S = 300.0
LAST_BYTES = 4096
LONGEST = 200
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
            code, why = _run(request, results.fileno(), time_s)
            if code is None:
                raise SceneError(f"{what}: expected to be read within {time_s:g} s; simplify it")
            if code != 0:
                # An exception that is not caught there is not the file's.
                remedy = "check the installation" if code == 1 else "export it again, or simplify it"
                raise SceneError(f"{what}: its reader ended with {_ending(code)}{why}; {remedy}")
            result: T | SceneError = pickle.load(results)
        if isinstance(result, SceneError):
            raise result
        return result

    return bounded


def _run(request: bytes, results_fd: int, time_s: float) -> tuple[int | None, str]:
    """The exit status of this module as a program, None when it had to be killed; and its last words, in brackets."""
    with os.fdopen(os.memfd_create("slamgym-errors"), "rb") as errors:
        try:
            done = subprocess.run(
                [sys.executable, "-P", "-m", __name__, str(results_fd)],
                input=request,
                stdout=subprocess.DEVNULL,
                stderr=errors,
                pass_fds=(results_fd,),
                timeout=time_s,
                env=os.environ | {"PYTHONPATH": os.pathsep.join(_search_path())},
                check=False,
            )
        except subprocess.TimeoutExpired:
            return None, ""
        return done.returncode, _last_line(errors)


def _search_path() -> list[str]:
    """Where this process finds modules; only absolute paths when the working directory has been deleted: Python does
    not start with others then, and an editable installation adds one that is no folder at all.
    """
    with suppress(FileNotFoundError):
        return [path or str(Path.cwd()) for path in sys.path]
    return [path for path in sys.path if Path(path).is_absolute()]


def _last_line(errors: BinaryIO) -> str:
    errors.seek(max(0, errors.seek(0, os.SEEK_END) - LAST_BYTES))
    words = errors.read().decode(errors="replace").strip().rpartition("\n")[2].split()
    return f" ({' '.join(words)[-LONGEST:]})" if words else ""


def _ending(code: int) -> str:
    return signal.strsignal(-code) or str(code) if code < 0 else f"exit status {code}"


def _serve(requests: BinaryIO, results: BinaryIO) -> None:
    function, args, kwargs, what, memory_bytes, parent = pickle.load(requests)
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        return
    result: object
    limits = resource.getrlimit(resource.RLIMIT_AS)
    try:
        _limit_memory(memory_bytes, limits[1])
        result = function(*args, **kwargs)
    except SceneError as error:
        result = error
    except MemoryError:
        result = SceneError(f"{what}: expected to need at most {memory_bytes >> 20} MB of memory; simplify it")
    except Exception as error:  # the reader's libraries may fail in any way
        why = " ".join(f"{type(error).__name__}: {error}".split())[:LONGEST]
        result = SceneError(f"{what}: cannot be read ({why}); export it again")
    resource.setrlimit(resource.RLIMIT_AS, limits)  # what has been read must also get out
    pickle.dump(result, results, protocol=pickle.HIGHEST_PROTOCOL)
    results.flush()
    results.seek(0)  # both processes share the position


def _limit_memory(memory_bytes: int, hard: int) -> None:
    """Limit this process, to less where the system's own limit `hard` is lower."""
    least = memory_bytes if hard == resource.RLIM_INFINITY else min(memory_bytes, hard)
    resource.setrlimit(resource.RLIMIT_AS, (least, hard))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    with os.fdopen(int(sys.argv[1]), "wb") as to_caller:
        _serve(sys.stdin.buffer, to_caller)
