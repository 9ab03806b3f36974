"""The program that a SLAM runs in: `python -m slamgym.slam.worker SOCKET_FD FRAMES_FD PARENT_PID`.

It answers numbered requests on the socket: the number, and (True, value) or (False, what went wrong). Frames come
through shared memory. What the SLAM prints goes to the file that is its standard output, never to the socket.
"""

import os
import signal
import sys
import traceback
import warnings
from multiprocessing.connection import Connection
from typing import Any

from slamgym.errors import SlamgymError, TrajectoryWarning
from slamgym.slam.answers import checked_points, checked_result, checked_trajectory
from slamgym.slam.backend import Backend, SlamConfig, load_backend
from slamgym.slam.frame_buffer import FrameBuffer
from slamgym.slam.program import adopt_orphans, signal_after
from slamgym.types import FloatArray, Frame, SlamTrajectory, TrackResult

Reply = tuple[bool, Any]
"""(True, value), or (False, a SlamgymError that the user can act on), or (False, another error in one line)."""


class Server:
    """Builds the backend on the first request and drives it on the later ones."""

    def __init__(self, frames_fd: int) -> None:
        self._frames_fd = frames_fd
        self._backend: Backend | None = None
        self._frames: FrameBuffer | None = None

    def answer(self, request: str, *arguments: Any) -> Reply:
        try:
            return True, getattr(self, request)(*arguments)
        except SlamgymError as error:
            sys.stderr.write(f"{error}\n")
            # A class of the backend's own may not be one that can be sent.
            return False, error if type(error).__module__ == SlamgymError.__module__ else _in_one_line(error)
        except BaseException as error:
            traceback.print_exc()
            return False, _in_one_line(error)

    def start(self, name: str, config: SlamConfig) -> None:
        self._frames = FrameBuffer(config.camera, self._frames_fd)
        self._backend = load_backend(name)(config)

    def track(self, stamp_ns: int, T_world_cam: FloatArray) -> TrackResult:
        assert self._backend is not None
        assert self._frames is not None
        return checked_result(self._backend.track(Frame(stamp_ns, *self._frames.read(), T_world_cam)))

    def map_points(self) -> FloatArray | None:
        """None from a backend that does not tell them."""
        tell = getattr(self._backend, "map_points", None)
        return None if tell is None else checked_points(tell())

    def finish(self) -> tuple[SlamTrajectory, list[str]]:
        """The final trajectory, and the texts of the TrajectoryWarnings about it, which nobody sees here."""
        assert self._backend is not None
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", TrajectoryWarning)
            trajectory = checked_trajectory(self._backend.finish())
        for one in caught:  # all of them, also those that are nothing of ours, stay in the log
            warnings.showwarning(one.message, one.category, one.filename, one.lineno)
        return trajectory, [str(one.message) for one in caught if issubclass(one.category, TrajectoryWarning)]


def _in_one_line(error: BaseException) -> str:
    first = next(iter(str(error).strip().splitlines()), "")
    return f"{type(error).__name__}: {first}"


def serve(connection: "Connection[Any, Any]", frames_fd: int) -> None:
    server = Server(frames_fd)
    while True:
        number, request, *arguments = connection.recv()
        connection.send((number, *server.answer(request, *arguments)))


def main() -> None:
    socket_fd, frames_fd, parent_pid = map(int, sys.argv[1:])
    signal_after(parent_pid, signal.SIGKILL)  # even when it hangs in C++
    os.set_inheritable(socket_fd, False)
    adopt_orphans()
    try:
        serve(Connection(socket_fd), frames_fd)
    except (EOFError, ConnectionError):
        pass  # the parent is done with this run
    except BaseException:
        traceback.print_exc()
    # No interpreter shutdown: it would run destructors of a SLAM whose threads still work.
    os._exit(0)


if __name__ == "__main__":
    main()
