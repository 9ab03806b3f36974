"""The wall clock beside the stamps of frames, for a SLAM that has to keep up."""

import math
import time


class Pace:
    """Runs from the first frame that is waited for; a frame is due when the time has passed that its stamp says."""

    def __init__(self) -> None:
        self._begin_s: float | None = None
        self._first_ns = 0

    def late_s(self, stamp_ns: int) -> float:
        """How long ago the frame was due, seconds; below 0 when it is still to come, as all are before the first."""
        if self._begin_s is None:
            return -math.inf
        return time.monotonic() - self._begin_s - (stamp_ns - self._first_ns) * 1e-9

    def wait_for(self, stamp_ns: int) -> float:
        """Block until the frame is due; how late it is then, seconds."""
        if self._begin_s is None:
            self._begin_s, self._first_ns = time.monotonic(), stamp_ns
        early_s = -self.late_s(stamp_ns)
        if early_s > 0:
            time.sleep(early_s)
        return max(0.0, self.late_s(stamp_ns))
