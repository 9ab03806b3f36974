"""A recorded RGB-D sequence, whatever format its files have."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from slamgym.camera import PinholeCamera
from slamgym.eval.trajectories import Trajectory
from slamgym.types import BoolArray, FloatArray, Frame, IntArray

Images = tuple[NDArray[np.uint8], NDArray[np.float32]]
"""Colour (H, W, 3), RGB, and depth (H, W), metres along the optical axis, 0 where nothing was measured."""


@dataclass(frozen=True, slots=True, eq=False)
class Sequence:
    """N frames whose images are read when they are asked for, so that any length fits into memory.

    name: the folder's. camera: with its distortion. fps: frames a second, at the median. stamps_ns: int64 (N,),
    increasing. T_world_cam: true poses (N, 4, 4), interpolated between those of the truth, NaN without a truth.
    has_truth: bool (N,), whether the truth has a pose that belongs to the frame. truth: all true poses, None without.
    read_images: the images of frame k; raises SequenceError that names the file.
    """

    name: str
    camera: PinholeCamera
    fps: float
    stamps_ns: IntArray
    T_world_cam: FloatArray
    has_truth: BoolArray
    truth: Trajectory | None
    read_images: Callable[[int], Images]

    def __len__(self) -> int:
        return len(self.stamps_ns)

    def frame(self, k: int) -> Frame:
        """Frame k; raises SequenceError when its images cannot be read."""
        return Frame(int(self.stamps_ns[k]), *self.read_images(k), self.T_world_cam[k], bool(self.has_truth[k]))

    def rows(self, stride: int = 0) -> range:
        """The numbers of every (stride + 1)-th frame, the first one included."""
        return range(0, len(self), stride + 1)

    def frames(self, stride: int = 0) -> Iterator[Frame]:
        """The frames of these `rows`."""
        return map(self.frame, self.rows(stride))
