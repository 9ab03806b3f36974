"""The worker process as the parent sees it: start it, ask it, end it."""

import os
import socket
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from pickle import UnpicklingError
from typing import IO, Any

from slamgym.slam.worker import Reply

_KILL_WAIT_S = 5.0

_spawners: dict[int, ThreadPoolExecutor] = {}


def _spawner() -> ThreadPoolExecutor:
    """The one thread that starts workers, lazily, one for each process (a fork inherits none).

    The kernel kills a worker when the thread that started it ends, and threads of the user's may end at any time.
    """
    pid = os.getpid()
    if pid not in _spawners:
        _spawners[pid] = ThreadPoolExecutor(max_workers=1, thread_name_prefix="slamgym-spawner")
    return _spawners[pid]


class WorkerProcess:
    """A worker with its socket. Its output goes to `log`; `memory_fd` is inherited."""

    def __init__(self, memory_fd: int, log: IO[bytes]) -> None:
        ours, theirs = socket.socketpair()
        with theirs:
            self._connection: Connection[Any, Any] = Connection(ours.detach())
            self._process = _spawner().submit(_spawn, theirs.fileno(), memory_fd, log).result()
        self._asked = 0

    @property
    def pid(self) -> int:
        return self._process.pid

    def send(self, request: str, *arguments: Any) -> None:
        """Raises ConnectionError when the worker is gone."""
        self._asked += 1
        self._connection.send((self._asked, request, *arguments))

    def receive(self, timeout_s: float) -> Reply:
        """The answer to the last request.

        Raises TimeoutError when there is none in time, ConnectionError when the worker is gone.
        """
        deadline = time.monotonic() + timeout_s
        while self._connection.poll(max(0.0, deadline - time.monotonic())):
            try:
                number, ok, value = self._connection.recv()
            except (EOFError, OSError, UnpicklingError) as error:
                raise ConnectionError("the worker is gone") from error
            # Ctrl-C may have ended the wait for an earlier answer, which comes first now.
            if number == self._asked:
                return ok, value
        raise TimeoutError(f"no answer within {timeout_s} s")

    def kill(self) -> None:
        """End the process at once and collect it. The worker keeps nothing that would need an orderly end."""
        self._process.kill()
        with suppress(subprocess.TimeoutExpired):  # the kernel may take its time, the user should not wait for it
            self._process.wait(_KILL_WAIT_S)
        self._connection.close()


def _spawn(socket_fd: int, memory_fd: int, log: IO[bytes]) -> subprocess.Popen[bytes]:
    # A session of its own: Ctrl-C in the terminal is for the user's program, which then ends the worker.
    return subprocess.Popen(
        [sys.executable, "-P", "-u", "-m", "slamgym.slam.worker", str(socket_fd), str(memory_fd), str(os.getpid())],
        stdin=subprocess.DEVNULL,
        stdout=log,
        stderr=log,
        pass_fds=(socket_fd, memory_fd),
        env=os.environ | {"PYTHONPATH": os.pathsep.join(path or str(Path.cwd()) for path in sys.path)},
        start_new_session=True,
    )
