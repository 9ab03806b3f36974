"""Final poses by fed frame, and the map that is evaluated: poses of two maps are never aligned together."""

from typing import cast

import numpy as np

from slamgym.eval.robustness.losses import tracked_frames
from slamgym.types import BoolArray, FloatArray, IntArray, SlamRecord


def final_by_frame(record: SlamRecord) -> tuple[FloatArray, IntArray]:
    """Final poses (N, 4, 4) and their maps (N,) by fed frame: NaN and -1 where the frame was not tracked, or where no
    final pose has its stamp.
    """
    T = np.full((len(record.stamps_ns), 4, 4), np.nan)
    map_id = np.full(len(record.stamps_ns), -1, dtype=np.int64)
    stamps, final = record.stamps_ns, record.final
    _, fed, rows = np.intersect1d(stamps, final.stamps_ns, assume_unique=True, return_indices=True)
    ok = tracked_frames(record)[fed]
    T[fed[ok]] = final.T_map_cam[rows[ok]]
    map_id[fed[ok]] = final.map_id[rows[ok]]
    return T, map_id


def estimate_by_frame(record: SlamRecord) -> tuple[FloatArray, IntArray]:
    """The final poses and maps (`final_by_frame`), or those emitted frame by frame of a SLAM that crashed or hung and
    left no final trajectory.
    """
    if record.outcome and not len(record.final.stamps_ns):
        return record.T_map_cam, np.where(tracked_frames(record), record.map_id, -1)
    return final_by_frame(record)


def most_frequent_map(map_ids: IntArray) -> int:
    """The map id with the most frames, the earliest of those that tie; -1 when no frame is in a map."""
    ids, first, count = np.unique(map_ids[map_ids >= 0], return_index=True, return_counts=True)
    return int(ids[np.lexsort((first, -count))[0]]) if len(ids) else -1


def evaluated_frames(record: SlamRecord) -> BoolArray:
    """Whether each fed frame is tracked in the evaluated map (N,): the `tracked` of plain trajectories."""
    _, maps = estimate_by_frame(record)
    return cast(BoolArray, (maps == most_frequent_map(maps)) & (maps >= 0))
