"""The program that a SLAM runs in: `python -m slamgym.slam.worker SOCKET_FD MEMORY_FD PARENT_PID`.

It answers numbered requests on the socket: the number, and (True, value) or (False, what went wrong). Frames come
through shared memory. What the SLAM prints goes to the file that is its standard output, never to the socket.
"""

import ctypes
import os
import signal
import sys
import traceback
from multiprocessing.connection import Connection
from typing import Any, TypeVar

from slamgym.errors import SlamgymError
from slamgym.slam.backend import Backend, SlamConfig, load_backend
from slamgym.slam.frame_buffer import FrameBuffer
from slamgym.types import FloatArray, Frame, SlamTrajectory, TrackResult

Reply = tuple[bool, Any]
"""(True, value), or (False, a SlamgymError that the user can act on), or (False, text of a traceback)."""

Answer = TypeVar("Answer")

_PR_SET_PDEATHSIG = 1


def die_with_parent(parent_pid: int) -> None:
    """Have the kernel kill this process when its parent ends in whatever way, even when it hangs in C++."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent_pid:  # it ended before the line above
        os._exit(1)


class Server:
    """Builds the backend on the first request and drives it on the later ones."""

    def __init__(self, memory_fd: int) -> None:
        self._memory_fd = memory_fd
        self._backend: Backend | None = None
        self._frames: FrameBuffer | None = None

    def answer(self, request: str, *arguments: Any) -> Reply:
        try:
            return True, getattr(self, request)(*arguments)
        except BaseException as error:
            traceback.print_exc()
            return False, error if isinstance(error, SlamgymError) else traceback.format_exc()

    def start(self, name: str, config: SlamConfig) -> None:
        self._frames = FrameBuffer(config.camera, self._memory_fd)
        self._backend = load_backend(name)(config)

    def track(self, stamp_ns: int, T_world_cam: FloatArray) -> TrackResult:
        assert self._backend is not None
        assert self._frames is not None
        return _checked(TrackResult, self._backend.track(Frame(stamp_ns, *self._frames.read(), T_world_cam)))

    def finish(self) -> SlamTrajectory:
        assert self._backend is not None
        return _checked(SlamTrajectory, self._backend.finish())


def _checked(kind: type[Answer], answer: Answer) -> Answer:
    if not isinstance(answer, kind):
        raise TypeError(f"expected the backend to answer with a {kind.__name__}, got {answer!r}")
    return answer


def serve(connection: "Connection[Any, Any]", memory_fd: int) -> None:
    server = Server(memory_fd)
    while True:
        number, request, *arguments = connection.recv()
        connection.send((number, *server.answer(request, *arguments)))


def main() -> None:
    socket_fd, memory_fd, parent_pid = map(int, sys.argv[1:])
    die_with_parent(parent_pid)
    os.set_inheritable(socket_fd, False)
    try:
        serve(Connection(socket_fd), memory_fd)
    except (EOFError, ConnectionError):
        pass  # the parent is done with this run
    except BaseException:
        traceback.print_exc()
    # No interpreter shutdown: it would run destructors of a SLAM whose threads still work.
    os._exit(0)


if __name__ == "__main__":
    main()
