"""What makes the figures of an estimate mean something else than they seem to: one sentence each."""

import warnings

import numpy as np

from slamgym.errors import TrajectoryWarning
from slamgym.eval.trajectories import Trajectory
from slamgym.types import IntArray

OTHER_BODY_DEG = 30.0
OTHER_STAMPS_S = 1e-3
DENSER = 2.0


def tell(sentences: list[str]) -> None:
    """Each as a TrajectoryWarning."""
    for sentence in sentences:
        warnings.warn(sentence, TrajectoryWarning, stacklevel=4)


def of_the_order(truth: Trajectory, est: Trajectory) -> list[str]:
    """Whether the estimate looks like the truth, and the truth like an estimate."""
    if min(len(truth), len(est)) < 2:
        return []
    (begin, end), (est_begin, est_end) = (t.stamps_ns[[0, -1]] for t in (truth, est))
    if est_begin < begin and est_end > end and len(est) > DENSER * len(truth):
        return [
            f"the estimate has {len(est)} poses and covers more than the truth with {len(truth)}: are they swapped?"
        ]
    return []


def of_holes(truth: Trajectory, holes: IntArray, without: int, frames: int) -> list[str]:
    """Frames without a true pose; holes: the rows of the truth before them."""
    if not without:
        return []
    holes_s = float(np.diff(truth.stamps_ns)[holes].sum()) * 1e-9
    return [
        f"the truth has no pose for {without} of {frames} frames ({len(holes)} holes of {holes_s:.1f} s in all): these "
        "count as tracked or lost, but not how far off they are"
    ]


def of_repeated_poses(est: Trajectory) -> list[str]:
    """A SLAM that writes its last pose again while it is lost seems to track."""
    repeated = int((np.diff(est.T, axis=0) == 0).all(axis=(1, 2)).sum())
    if not repeated:
        return []
    return [f"{repeated} poses repeat the one before exactly and count as tracked: was the SLAM lost there?"]


def of_orientations(median_deg: float) -> list[str]:
    """Poses of another body, camera or IMU, have right positions and wrong orientations; NaN when none is known."""
    if not median_deg > OTHER_BODY_DEG:
        return []
    return [
        f"orientations are off by {median_deg:.0f} degrees at the median: are they those of another body (camera, IMU, "
        "robot), is w the first of the quaternions, or are the poses inverse? Rotation errors, RPE and correct rate "
        "suffer from it"
    ]


def of_stamps(frames_ns: IntArray, poses_ns: IntArray) -> list[str]:
    """Poses that are not at the frames they were matched with, int64 (M,) each."""
    if not len(frames_ns):
        return []
    median_s = float(np.median(np.abs(frames_ns - poses_ns))) * 1e-9
    if median_s <= OTHER_STAMPS_S:
        return []
    return [
        f"poses lie {1e3 * median_s:.0f} ms from the frames at the median: is this the list of the frames that the "
        "SLAM was given, and not of another camera? Some poses may be taken for those of a neighbouring frame"
    ]


def of_the_ends(truth: Trajectory, est: Trajectory, max_gap_s: float) -> list[str]:
    """A truth that was recorded for longer than the camera makes the estimate seem incomplete."""
    if not len(est):
        return []
    late_s = float(est.stamps_ns[0] - truth.stamps_ns[0]) * 1e-9
    early_s = float(truth.stamps_ns[-1] - est.stamps_ns[-1]) * 1e-9
    if max(late_s, early_s) <= max_gap_s:
        return []
    return [
        f"the truth begins {max(late_s, 0):.1f} s before the first pose, and ends {max(early_s, 0):.1f} s after the "
        "last: that counts as not tracked; give the frames if the camera ran for less"
    ]
