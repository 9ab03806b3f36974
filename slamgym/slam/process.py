"""The worker process as the parent sees it: start it, ask it, end it."""

import os
import signal
import socket
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Literal

from slamgym.slam.log_file import LogFile
from slamgym.slam.process_tree import own_mb, process_tree, resident_mb
from slamgym.slam.worker import Reply

_KILL_WAIT_S = 5.0
_LOOK_INTERVAL_S = 0.05
"""Between two looks at the memory of a worker: it is ended before it has taken much more than it may."""

Outcome = Literal["crashed", "timeout"]


class WorkerLostError(Exception):
    """The worker cannot answer any more; `why` says in one line what happened."""

    def __init__(self, outcome: Outcome, why: str) -> None:
        super().__init__(why)
        self.outcome: Outcome = outcome
        self.why = why


_spawners: dict[int, ThreadPoolExecutor] = {}
_spawners_lock = threading.Lock()


def _spawner() -> ThreadPoolExecutor:
    """The one thread that starts workers, lazily, one for each process (a fork inherits none).

    The kernel kills a worker when the thread that started it ends, and threads of the user's may end at any time.
    """
    pid = os.getpid()
    with _spawners_lock:
        if pid not in _spawners:
            _spawners[pid] = ThreadPoolExecutor(max_workers=1, thread_name_prefix="slamgym-spawner")
        return _spawners[pid]


class WorkerProcess:
    """A worker with its socket. Its output goes to `log`; `frames_fd` is inherited; temporary files go to `scratch`.

    It is ended when it, with the programs that it started, takes more than `memory_limit_mb` of memory.
    """

    def __init__(self, frames_fd: int, log: LogFile, scratch: Path, memory_limit_mb: float) -> None:
        self._log = log
        self._memory_limit_mb = memory_limit_mb
        ours, theirs = socket.socketpair()
        with theirs:
            self._connection: Connection[Any, Any] = Connection(ours.detach())
            self._process = _spawner().submit(_spawn, theirs.fileno(), frames_fd, log, scratch).result()
        self._asked = 0
        self._next_look = 0.0

    @property
    def pid(self) -> int:
        return self._process.pid

    def send(self, request: str, *arguments: Any) -> None:
        """Ask; that the worker is gone is told by `receive`."""
        self._asked += 1
        with suppress(ConnectionError):
            self._connection.send((self._asked, request, *arguments))

    def receive(self, timeout_s: float) -> Reply:
        """The answer to the last request; raises WorkerLostError when there is none in time, or will never be one."""
        deadline = time.monotonic() + timeout_s
        while (left_s := deadline - time.monotonic()) > 0:
            answered = self._connection.poll(min(left_s, _LOOK_INTERVAL_S))
            self.look_after()
            if not answered:
                continue
            try:
                number, ok, value = self._connection.recv()
            except (EOFError, OSError):
                raise WorkerLostError("crashed", self._how_it_ended()) from None
            except Exception as error:  # whatever unpickling a strange answer may raise
                raise WorkerLostError("crashed", f"its answer cannot be read ({error!r})") from None
            # Ctrl-C may have ended the wait for an earlier answer, which comes first now.
            if number == self._asked:
                return ok, value
        raise WorkerLostError("timeout", f"no answer within {timeout_s:g} s")

    def look_after(self) -> None:
        """To be called often while it works: keeps its log small, raises WorkerLostError for too much memory."""
        if time.monotonic() < self._next_look:
            return
        self._next_look = time.monotonic() + _LOOK_INTERVAL_S
        self._log.free_disk()
        tree = process_tree(self.pid)
        # Programs that it forked share most of their memory: looked at closely only when there may be too much.
        if sum(map(resident_mb, tree)) > self._memory_limit_mb < (used_mb := sum(map(own_mb, tree))):
            limit = f"more than its limit of {self._memory_limit_mb:,.0f} MB"
            raise WorkerLostError("crashed", f"it took {used_mb:,.0f} MB of memory, {limit}")

    def _how_it_ended(self) -> str:
        """Looked at without collecting the process: as long as it is not, nobody else gets its number."""
        deadline = time.monotonic() + _KILL_WAIT_S
        while time.monotonic() < deadline:
            try:
                ended = os.waitid(os.P_PID, self.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT)
            except ChildProcessError:  # the user's program collects its children, or ignores their end
                return "its process ended"
            if ended is not None and ended.si_code == os.CLD_EXITED:
                return f"its process ended with exit code {ended.si_status}"
            if ended is not None:
                return f"its process was ended by signal {ended.si_status} ({signal.strsignal(ended.si_status)})"
            time.sleep(_LOOK_INTERVAL_S)
        return "it closed its socket"

    def kill(self) -> None:
        """End the process, and all that it started, at once. It keeps nothing that would need an orderly end."""
        if self._process.returncode is None:
            started = process_tree(self.pid)
            with suppress(ProcessLookupError):
                os.killpg(self.pid, signal.SIGKILL)
            for pid in started:  # those that left its group
                with suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
            with suppress(subprocess.TimeoutExpired):  # the kernel may take its time, the user should not wait for it
                self._process.wait(_KILL_WAIT_S)
        self._connection.close()


def _spawn(socket_fd: int, frames_fd: int, log: LogFile, scratch: Path) -> subprocess.Popen[bytes]:
    # A session of its own: Ctrl-C in the terminal is for the user's program, which then ends the worker and its group.
    return subprocess.Popen(
        [sys.executable, "-P", "-u", "-m", "slamgym.slam.worker", str(socket_fd), str(frames_fd), str(os.getpid())],
        stdin=subprocess.DEVNULL,
        stdout=log.fileno(),
        stderr=log.fileno(),
        pass_fds=(socket_fd, frames_fd),
        env=os.environ
        | {"PYTHONPATH": os.pathsep.join(path or str(Path.cwd()) for path in sys.path), "TMPDIR": str(scratch)},
        start_new_session=True,
    )
