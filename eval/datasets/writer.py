"""Recording frames as a sequence in the format of the TUM RGB-D benchmark."""

from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory
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
from slamgym.types import FloatArray, Frame

_THREADS = 2
_LONGEST_QUEUE = 8
_MAX_UINT16 = 65535


class SequenceWriter:
    """Writes frames into a new or empty folder; `read_sequence` and the programs of ORB-SLAM read it.

    rgb/*.png and depth/*.png (16 bits, 5000 a metre) are named by their stamp and written by threads while frames come;
    the lists rgb.txt, depth.txt and associations.txt, groundtruth.txt with the poses that are finite and no
    interpolation, and camera.yaml appear in `close`: a folder without lists is an unfinished recording. Colour is
    exact, stamps are to the nanosecond. Depth is rounded to 0.2 mm; what is not finite, not positive or farther than
    13.1 m becomes 0, no measurement.

    As a context manager it closes at the end of the block, and stops without lists when an exception leaves it.
    Raises OutputError when the folder is not new or empty, or something cannot be written.
    """

    def __init__(self, folder: Path, camera: PinholeCamera, fps: float) -> None:
        self._folder, self._camera, self._fps = folder, camera, fps
        self._stamps_ns: list[int] = []
        self._true_stamps_ns: list[int] = []
        self._true_poses: list[FloatArray] = []
        self._writing: deque[Future[None]] = deque()
        self._closed = False
        _make_folders(folder)
        self._threads = ThreadPoolExecutor(_THREADS, thread_name_prefix="sequence-writer")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if kind is None:
            self.close()
        else:
            self._stop()

    def add(self, frame: Frame) -> None:
        """Take a frame, whose arrays must not change any more; waits only while eight are still unwritten.

        Raises SequenceError when its stamp is not above the last one or its images do not have the camera's size,
        OutputError when an earlier one could not be written; nothing can be added after that.
        """
        if self._closed:
            raise OutputError(f"{self._folder}: expected a sequence that is still recorded, got a frame after its end")
        self._check(frame)
        self._wait_until_unwritten(_LONGEST_QUEUE - 1)
        self._writing.append(self._threads.submit(_write_images, self._folder, frame))
        self._stamps_ns.append(frame.stamp_ns)
        if frame.has_truth and np.isfinite(frame.T_world_cam).all():
            self._true_stamps_ns.append(frame.stamp_ns)
            self._true_poses.append(frame.T_world_cam.copy())

    def close(self) -> None:
        """Wait for the images and write the lists; nothing happens the second time. Raises OutputError."""
        if self._closed:
            return
        self._wait_until_unwritten(0)
        self._stop()
        try:
            with TemporaryDirectory(prefix=".lists-", dir=self._folder) as draft:
                for path in self._write_lists(Path(draft)):
                    path.replace(self._folder / path.name)
        except OSError as error:
            raise _cannot_write(self._folder, error) from None

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
        except OSError as error:
            self._stop()
            raise _cannot_write(self._folder, error) from None

    def _stop(self) -> None:
        self._closed = True
        self._threads.shutdown(cancel_futures=True)

    def _write_lists(self, folder: Path) -> list[Path]:
        """The files; those by which a reader knows a sequence come last."""
        stamps = [seconds_word(stamp_ns) for stamp_ns in self._stamps_ns]
        for kind in ("rgb", "depth"):
            lines = [f"{stamp} {kind}/{stamp}.png\n" for stamp in stamps]
            (folder / f"{kind}.txt").write_text("".join(["# timestamp filename\n", *lines]), encoding="utf-8")
        pairs = [f"{stamp} rgb/{stamp}.png {stamp} depth/{stamp}.png\n" for stamp in stamps]
        (folder / "associations.txt").write_text("".join(pairs), encoding="utf-8")
        if self._true_poses:
            truth = Trajectory(np.array(self._true_stamps_ns, dtype=np.int64), np.array(self._true_poses))
            write_tum(folder / "groundtruth.txt", truth)
        write_camera(folder / CAMERA_FILE, self._camera, self._fps)
        return sorted(folder.iterdir(), key=lambda path: path.name in ("rgb.txt", "associations.txt"))


def _make_folders(folder: Path) -> None:
    try:
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise OutputError(
                f"sequence folder: expected a new or empty folder, got {folder}; remove it or name another"
            )
        for kind in ("rgb", "depth"):
            (folder / kind).mkdir(parents=True)
    except OSError as error:
        raise _cannot_write(folder, error) from None


def _cannot_write(folder: Path, error: OSError) -> OutputError:
    return OutputError(f"writing the sequence {folder} failed ({error.strerror}); make room or name another folder")


def _write_images(folder: Path, frame: Frame) -> None:
    name = f"{seconds_word(frame.stamp_ns)}.png"
    bgr = np.asarray(cv2.cvtColor(frame.rgb, cv2.COLOR_RGB2BGR), dtype=np.uint8)
    (folder / "rgb" / name).write_bytes(png(bgr))
    (folder / "depth" / name).write_bytes(png(_to_units(frame.depth)))


def _to_units(depth_m: NDArray[np.float32]) -> NDArray[np.uint16]:
    with np.errstate(over="ignore", invalid="ignore"):
        units = np.rint(depth_m * np.float32(TUM_DEPTH_SCALE))
        return np.where((units > 0) & (units <= _MAX_UINT16), units, 0).astype(np.uint16)
