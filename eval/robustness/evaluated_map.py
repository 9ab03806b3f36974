"""Final poses by fed frame, and the maps that are evaluated: poses of two maps are never aligned together."""

from typing import Literal, cast, get_args

import numpy as np

from slamgym.errors import ConfigError, unknown_word
from slamgym.eval.robustness.losses import tracked_frames
from slamgym.types import BoolArray, FloatArray, IntArray, SlamRecord

MapPolicy = Literal["largest", "first", "each"]
"""Which maps of a run are evaluated; see `frames_by_policy`."""
MAP_POLICIES: tuple[str, ...] = get_args(MapPolicy)


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


def first_map(map_ids: IntArray) -> int:
    """The map id of the first frame that is in a map; -1 when none is."""
    return next((int(map_id) for map_id in map_ids if map_id >= 0), -1)


def frames_by_policy(map_ids: IntArray, map_policy: str) -> BoolArray:
    """Which frames (N,) are in an evaluated map; map_ids: int64 (N,), -1 for none.

    "largest": the `most_frequent_map`; "first": the one that the first frame in any is in; "each": all of them.
    Raises ConfigError for another policy.
    """
    match map_policy:
        case "largest":
            evaluated = map_ids == most_frequent_map(map_ids)
        case "first":
            evaluated = map_ids == first_map(map_ids)
        case "each":
            evaluated = np.ones(len(map_ids), dtype=np.bool_)
        case _:
            raise ConfigError(unknown_word("map policy", map_policy, MAP_POLICIES))
    return cast(BoolArray, evaluated & (map_ids >= 0))


def evaluated_frames(record: SlamRecord, map_policy: str = "largest") -> BoolArray:
    """Whether each fed frame is tracked in an evaluated map (N,): the `tracked` of plain trajectories.

    The maps are those of `estimate_by_frame`, so that maps which were merged are one. Raises ConfigError.
    """
    return frames_by_policy(estimate_by_frame(record)[1], map_policy)
