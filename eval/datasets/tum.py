"""Sequences in the format of the TUM RGB-D benchmark, which our own recordings have too.

Sturm et al., "A Benchmark for the Evaluation of RGB-D SLAM Systems", IROS 2012.
"""

import warnings
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from slamgym.camera import PinholeCamera
from slamgym.errors import SequenceError, TrajectoryError, TrajectoryWarning
from slamgym.eval.datasets.camera_file import CAMERA_FILE, find_camera
from slamgym.eval.datasets.file_lists import FileList, check_present, read_file_list
from slamgym.eval.datasets.images import read_colour, read_depth
from slamgym.eval.datasets.sequence import Images, Sequence
from slamgym.eval.trajectories import Trajectory, interpolate, match_stamps, read_trajectory
from slamgym.types import BoolArray, FloatArray, IntArray

MAX_DIFFERENCE_NS = 20_000_000
"""Stamps this close belong together, as in the benchmark's `associate.py`."""

# As users of ORB-SLAM2 call what `associate.py` printed.
_ASSOCIATIONS = ("associations.txt", "associate.txt", "association.txt")
_FILE_COLUMNS = "timestamp filename"
_PAIR_COLUMNS = "rgb_timestamp rgb_filename depth_timestamp depth_filename"


class _Pairs(NamedTuple):
    """The frames: stamps of the colour images int64 (N,), and N files each."""

    stamps_ns: IntArray
    colour: list[Path]
    depth: list[Path]


def recognise(folder: Path) -> bool:
    """Whether the folder looks like a sequence of this format."""
    return any((folder / name).is_file() for name in ("rgb.txt", *_ASSOCIATIONS))


def read_folder(folder: Path, camera: str | None) -> Sequence:
    """The sequence in a folder of rgb.txt and depth.txt, or of associations.txt, and of groundtruth.txt where it has
    one; see `slamgym.eval.datasets.read_sequence`.
    """
    lens = find_camera(folder, camera)
    pairs = _read_pairs(folder)
    truth = _read_truth(folder / "groundtruth.txt")
    T_world_cam, has_truth = _true_poses(truth, pairs.stamps_ns)
    if truth is not None and not has_truth.any():
        warnings.warn(
            f"{folder / 'groundtruth.txt'}: no pose within 0.02 s of any frame, so that no error can be told: are both "
            "from the same clock?",
            TrajectoryWarning,
            stacklevel=3,
        )
    return Sequence(
        name=folder.resolve().name,
        camera=lens.pinhole,
        fps=lens.fps or _median_fps(folder, pairs.stamps_ns),
        stamps_ns=pairs.stamps_ns,
        T_world_cam=T_world_cam,
        has_truth=has_truth,
        truth=truth,
        read_images=partial(_read_images, pairs, lens.pinhole, lens.depth_scale),
    )


def _read_images(pairs: _Pairs, camera: PinholeCamera, depth_scale: float, k: int) -> Images:
    return read_colour(pairs.colour[k], camera), read_depth(pairs.depth[k], camera, depth_scale)


def _read_pairs(folder: Path) -> _Pairs:
    listed = next((folder / name for name in _ASSOCIATIONS if (folder / name).is_file()), None)
    if listed is None:
        return _pair(*(read_file_list(folder / f"{kind}.txt", _FILE_COLUMNS) for kind in ("rgb", "depth")))
    pairs = read_file_list(listed, _PAIR_COLUMNS)
    check_present(pairs, np.arange(len(pairs.files)))
    return _Pairs(pairs.stamps_ns[:, 0], [files[0] for files in pairs.files], [files[1] for files in pairs.files])


def _pair(rgb: FileList, depth: FileList) -> _Pairs:
    stamps_ns = rgb.stamps_ns[:, 0]
    rgb_rows, depth_rows = match_stamps(stamps_ns, depth.stamps_ns[:, 0], MAX_DIFFERENCE_NS)
    alone = len(rgb.files) - len(rgb_rows)
    if not len(rgb_rows):
        raise SequenceError(
            f"{rgb.path}: expected colour images within 0.02 s of depth images of {depth.path.name}, got none: "
            "are both from the same clock and sequence?"
        )
    if alone:
        warnings.warn(
            f"{rgb.path}: {alone} of {len(rgb.files)} colour images have no depth image within 0.02 s and are left out",
            TrajectoryWarning,
            stacklevel=5,
        )
    check_present(rgb, rgb_rows)
    check_present(depth, depth_rows)
    return _Pairs(
        stamps_ns[rgb_rows], [rgb.files[row][0] for row in rgb_rows], [depth.files[row][0] for row in depth_rows]
    )


def _read_truth(path: Path) -> Trajectory | None:
    """None without the file, or without a pose in it."""
    if not path.exists():
        return None
    try:
        truth = read_trajectory(path, "tum", repair=True, allow_empty=True)
    except TrajectoryError as error:
        raise SequenceError(str(error)) from None
    return truth if len(truth) else None


def _true_poses(truth: Trajectory | None, stamps_ns: IntArray) -> tuple[FloatArray, BoolArray]:
    has_truth = np.zeros(len(stamps_ns), dtype=np.bool_)
    if truth is None:
        return np.full((len(stamps_ns), 4, 4), np.nan), has_truth
    has_truth[match_stamps(truth.stamps_ns, stamps_ns, MAX_DIFFERENCE_NS)[1]] = True
    return interpolate(truth, stamps_ns), has_truth


def _median_fps(folder: Path, stamps_ns: IntArray) -> float:
    if len(stamps_ns) < 2:
        raise SequenceError(
            f"{folder}: expected two frames or more to tell their rate, got {len(stamps_ns)}: write it into "
            f"{CAMERA_FILE} as fps"
        )
    return float(1e9 / np.median(np.diff(stamps_ns)))
