"""Recording frames as a sequence in the format of the TUM RGB-D benchmark."""

from collections import deque
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from contextlib import ExitStack, suppress
from pathlib import Path
from types import TracebackType
from typing import Self

import cv2
import numpy as np
from numpy.typing import NDArray

from slamgym.camera import PinholeCamera
from slamgym.errors import OutputError, SequenceError
from slamgym.eval.datasets.camera_file import CAMERA_FILE, TUM_DEPTH_SCALE, write_camera
from slamgym.eval.datasets.images import png
from slamgym.eval.trajectories import Trajectory, write_tum
from slamgym.eval.trajectories.stamp_words import seconds_word
from slamgym.files import check_free, draft
from slamgym.types import FloatArray, Frame

_THREADS = 2
_LONGEST_QUEUE = 8
_MAX_UINT16 = 65535


class SequenceWriter:
    """Writes frames into a new or empty folder; `read_sequence` and the programs of ORB-SLAM read it.

    rgb/*.png and depth/*.png (16 bits, 5000 a metre) are named by their stamp; beside them are the lists rgb.txt,
    depth.txt and associations.txt, groundtruth.txt with the poses that are finite and no interpolation, and
    camera.yaml. Colour is exact, stamps are to the nanosecond. Depth is rounded to 0.2 mm; what is not finite, not
    positive or farther than 13.1 m becomes 0, no measurement.

    Threads write the images to a draft beside the folder while frames come; `close` puts it in its place. As a context
    manager it closes at the end of the block, and leaves nothing when an exception ends it. Raises OutputError when the
    folder is not new or empty, or something cannot be written, which leaves nothing either.
    """

    def __init__(self, folder: Path, camera: PinholeCamera, fps: float) -> None:
        self._folder, self._camera, self._fps = folder, camera, fps
        self._stamps_ns: list[int] = []
        self._true_stamps_ns: list[int] = []
        self._true_poses: list[FloatArray] = []
        self._writing: deque[Future[None]] = deque()
        self._closed = False
        check_free(folder, "folder")
        with ExitStack() as opened:
            self._draft = opened.enter_context(draft(folder))
            for kind in ("rgb", "depth"):
                (self._draft / kind).mkdir(parents=True)
            self._threads = ThreadPoolExecutor(_THREADS, thread_name_prefix="sequence-writer")
            opened.callback(self._threads.shutdown, cancel_futures=True)
            self._opened = opened.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if kind is None:
            self.close()
        else:
            self._discard()

    def add(self, frame: Frame) -> None:
        """Take a frame, whose arrays must not change any more; waits only while eight are still unwritten.

        Raises SequenceError when its stamp is not above the last one or its images do not have the camera's size,
        OutputError when an earlier one could not be written; nothing can be added after that.
        """
        if self._closed:
            raise OutputError(f"{self._folder}: expected a sequence that is still recorded, got a frame after its end")
        self._check(frame)
        self._wait_until_unwritten(_LONGEST_QUEUE - 1)
        self._writing.append(self._threads.submit(_write_images, self._draft, frame))
        self._stamps_ns.append(frame.stamp_ns)
        if frame.has_truth and np.isfinite(frame.T_world_cam).all():
            self._true_stamps_ns.append(frame.stamp_ns)
            self._true_poses.append(frame.T_world_cam.copy())

    def close(self) -> None:
        """Wait for the images and write the lists; nothing happens the second time. Raises OutputError."""
        if not self._closed:
            self._closed = True
            with self._opened:
                self._wait_until_unwritten(0)
                self._write_lists()

    def _check(self, frame: Frame) -> None:
        if self._stamps_ns and frame.stamp_ns <= self._stamps_ns[-1]:
            raise SequenceError(f"expected a stamp above {self._stamps_ns[-1]} ns, got {frame.stamp_ns} ns")
        size = (self._camera.height, self._camera.width)
        if frame.rgb.shape != (*size, 3) or frame.depth.shape != size:
            raise SequenceError(
                f"expected images of the camera's {size[1]}x{size[0]} pixels, got colour of shape {frame.rgb.shape} "
                f"and depth of shape {frame.depth.shape}"
            )

    def _wait_until_unwritten(self, count: int) -> None:
        """Wait until at most so many frames are unwritten; what went wrong with a written one is raised here."""
        try:
            while self._writing and (len(self._writing) > count or self._writing[0].done()):
                self._writing.popleft().result()
        except OSError:
            self._closed = True
            with self._opened:  # the draft makes an OutputError of it
                raise

    def _discard(self) -> None:
        """Not by the exception that ended the recording: the draft would tell a foreign OSError as its own."""
        self._closed = True
        with suppress(CancelledError), self._opened:
            raise CancelledError

    def _write_lists(self) -> None:
        stamps = [seconds_word(stamp_ns) for stamp_ns in self._stamps_ns]
        for kind in ("rgb", "depth"):
            lines = [f"{stamp} {kind}/{stamp}.png\n" for stamp in stamps]
            (self._draft / f"{kind}.txt").write_text("".join(["# timestamp filename\n", *lines]), encoding="utf-8")
        pairs = [f"{stamp} rgb/{stamp}.png {stamp} depth/{stamp}.png\n" for stamp in stamps]
        (self._draft / "associations.txt").write_text("".join(pairs), encoding="utf-8")
        if self._true_poses:
            truth = Trajectory(np.array(self._true_stamps_ns, dtype=np.int64), np.array(self._true_poses))
            write_tum(self._draft / "groundtruth.txt", truth)
        write_camera(self._draft / CAMERA_FILE, self._camera, self._fps)


def _write_images(folder: Path, frame: Frame) -> None:
    name = f"{seconds_word(frame.stamp_ns)}.png"
    bgr = np.asarray(cv2.cvtColor(frame.rgb, cv2.COLOR_RGB2BGR), dtype=np.uint8)
    (folder / "rgb" / name).write_bytes(png(bgr))
    (folder / "depth" / name).write_bytes(png(_to_units(frame.depth)))


def _to_units(depth_m: NDArray[np.float32]) -> NDArray[np.uint16]:
    with np.errstate(over="ignore", invalid="ignore"):
        units = np.rint(depth_m * np.float32(TUM_DEPTH_SCALE))
        return np.where((units > 0) & (units <= _MAX_UINT16), units, 0).astype(np.uint16)
