"""What a SLAM prints: of a chatterbox that never ends, only the end is kept, and only that much disk is taken."""

import ctypes
import os
import tempfile

KEPT_BYTES = 2**20
_ENOUGH_TO_FREE = 16 * 2**20
_KEEP_SIZE, _PUNCH_HOLE = 1, 2
"""Of fallocate(2)."""


class LogFile:
    """A file without a name, that the process which prints writes to, from wherever it is."""

    def __init__(self) -> None:
        self._file = tempfile.TemporaryFile()  # noqa: SIM115  open as long as this object is
        self._freed = 0
        self._libc = ctypes.CDLL(None, use_errno=True)

    def fileno(self) -> int:
        return self._file.fileno()

    def tail(self) -> str:
        """The end of what was printed, whole lines but for the first; empty after `close`."""
        if self._file.closed:
            return ""
        # Read without moving the offset: the process writes at the same one.
        end = os.fstat(self.fileno()).st_size
        return os.pread(self.fileno(), KEPT_BYTES, max(0, end - KEPT_BYTES)).decode(errors="replace")

    def free_disk(self) -> None:
        """Give back the disk space of all but the end, once there is much of it."""
        old = os.fstat(self.fileno()).st_size - KEPT_BYTES
        if old - self._freed > _ENOUGH_TO_FREE:
            # A file system that cannot do it keeps it all.
            hole = map(ctypes.c_long, (self._freed, old - self._freed))
            self._libc.fallocate(self.fileno(), _KEEP_SIZE | _PUNCH_HOLE, *hole)
            self._freed = old

    def close(self) -> None:
        """A second call does nothing."""
        self._file.close()
