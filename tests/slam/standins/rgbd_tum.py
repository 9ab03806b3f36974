"""Stands in for the `rgbd_tum` of the ORB-SLAMs: the same command line, the same files read and written.

Its SLAM is the truth beside the images, or with `--slam orbslam3` the real ORB-SLAM3.
"""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation


def main() -> None:
    parser = argparse.ArgumentParser()
    for name in ("vocabulary", "settings", "sequence", "associations"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--slam", choices=SLAMS, default="truth")
    parser.add_argument("--leave-out", type=int, nargs="*", default=[])
    arguments = parser.parse_args()
    branching, depth = arguments.vocabulary.read_text().split(maxsplit=2)[:2]
    sys.stdout.write(f"vocabulary of {branching} branches and {depth} levels\n")
    SLAMS[arguments.slam](arguments)


def images(arguments: argparse.Namespace) -> list[tuple[float, np.ndarray, np.ndarray]]:
    """The frames as rgbd_tum reads them: no line of the list is a comment, each has four words."""
    frames = []
    for line in filter(None, arguments.associations.read_text().split("\n")):
        stamp, rgb, _, depth = line.split()
        pair = [image(arguments.sequence / name) for name in (rgb, depth)]
        assert [read.dtype for read in pair] == [np.uint8, np.uint16]
        frames.append((float(stamp), pair[0], pair[1]))
    return frames


def image(path: Path) -> np.ndarray:
    read = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    assert read is not None, path
    return np.asarray(read)


def follow_truth(arguments: argparse.Namespace) -> None:
    store = cv2.FileStorage(str(arguments.settings), cv2.FILE_STORAGE_READ)
    size = tuple(int(store.getNode(f"Camera.{side}").real()) for side in ("height", "width"))
    truth = np.loadtxt(arguments.sequence / "groundtruth.txt")
    T = RigidTransform.from_components(truth[:, 1:4], Rotation.from_quat(truth[:, 4:8]))
    lines = []
    for k, (stamp, rgb, _) in enumerate(images(arguments)):
        assert rgb.shape[:2] == size
        pose = T[0].inv() * T[int(np.abs(truth[:, 0] - stamp).argmin())]
        numbers = [*pose.translation, *pose.rotation.as_quat()]
        if k not in arguments.leave_out:
            lines.append(" ".join([f"{stamp:.6f}", *(f"{number:.7f}" for number in numbers)]) + "\n")
    Path("CameraTrajectory.txt").write_text("".join(lines))
    Path("KeyFrameTrajectory.txt").write_text("".join(lines[::5]))


def run_orbslam3(arguments: argparse.Namespace) -> None:
    import pyorbslam3

    slam = pyorbslam3.Slam(arguments.vocabulary, arguments.settings, pyorbslam3.Sensor.RGBD)
    for stamp, rgb, depth in images(arguments):
        slam.track_rgbd(rgb, depth, stamp)
    slam.shutdown()
    slam.save_trajectory_tum("CameraTrajectory.txt")
    slam.save_keyframe_trajectory_tum("KeyFrameTrajectory.txt")


SLAMS: dict[str, Callable[[argparse.Namespace], None]] = {"truth": follow_truth, "orbslam3": run_orbslam3}

if __name__ == "__main__":
    main()
