"""Images in memory that two processes share. The memory has no name, so nothing is left behind when a process dies."""

import mmap
import os

import numpy as np
from numpy.typing import NDArray

from slamgym.camera import PinholeCamera
from slamgym.errors import ConfigError
from slamgym.types import Frame


class FrameBuffer:
    """Room for one frame. The owner creates it, and hands `fd` on to the process that attaches."""

    def __init__(self, camera: PinholeCamera, fd: int | None = None) -> None:
        self._shape = (camera.height, camera.width)
        pixels = camera.height * camera.width
        self._depth_offset = pixels * 3 + (-pixels * 3) % 4
        size = self._depth_offset + pixels * 4
        self._file = os.fdopen(os.memfd_create("slamgym-frame") if fd is None else fd, "r+b", buffering=0)
        if fd is None:
            self._file.truncate(size)
        self._memory = mmap.mmap(self._file.fileno(), size)

    @property
    def fd(self) -> int:
        """File descriptor of the memory, for the process that attaches."""
        return self._file.fileno()

    def write(self, frame: Frame) -> None:
        """Copy the images in; raises ConfigError when they do not fit the camera."""
        self._check("rgb", frame.rgb, (*self._shape, 3), np.uint8)
        self._check("depth", frame.depth, self._shape, np.float32)
        rgb, depth = self._views()
        rgb[:] = frame.rgb
        depth[:] = frame.depth

    def read(self) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        """Copies of the colour image (H, W, 3) and the depth image (H, W), metres."""
        rgb, depth = self._views()
        return rgb.copy(), depth.copy()

    def close(self) -> None:
        """Release the memory; a second call does nothing."""
        self._memory.close()
        self._file.close()

    def _views(self) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        rgb = np.ndarray((*self._shape, 3), np.uint8, self._memory)
        depth = np.ndarray(self._shape, np.float32, self._memory, self._depth_offset)
        return rgb, depth

    @staticmethod
    def _check(name: str, image: NDArray[np.generic], shape: tuple[int, ...], dtype: type[np.generic]) -> None:
        if image.shape != shape or image.dtype != dtype:
            raise ConfigError(
                f"frame.{name}: expected {np.dtype(dtype)} {shape}, got {image.dtype} {image.shape}; "
                "feed images of the camera that the SLAM was configured with"
            )
