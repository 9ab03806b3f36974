"""What the page shows of a run, read from its folder."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from slamgym.errors import SlamgymError
from slamgym.run_record import read_results
from slamgym.types import BoolArray, FloatArray, IntArray

NOT_INITIALIZED, OK, LOST = "not_initialized", "ok", "lost"


@dataclass(frozen=True, slots=True, eq=False)
class RunFiles:
    """One run.

    summary: `episode.json`. fed_s: seconds from the first fed frame, of each of the N fed frames. states: "ok", "lost",
    "not_initialized". truth: true positions (N, 3), metres, NaN where unknown. estimate: final positions (N, 3), each
    in its own map's frame, map_ids int64 (N,), -1 where there is none. tracked_points (N,). frames_s (M,), speed_mps
    (M,) and turn_degps (M,) are of all frames of the drive, from the first fed to the last. flat: whether the robot
    drove on a floor, z upwards.
    """

    summary: dict[str, Any]
    fed_s: FloatArray
    states: tuple[str, ...]
    truth: FloatArray
    estimate: FloatArray
    map_ids: IntArray
    tracked_points: FloatArray
    frames_s: FloatArray
    speed_mps: FloatArray
    turn_degps: FloatArray
    flat: bool

    @property
    def tracked(self) -> BoolArray:
        return np.array([state == OK for state in self.states], dtype=np.bool_)


def read_run(folder: Path) -> RunFiles | None:
    """What a run folder holds; None where it is not there, or cannot be read: the table still has its figures."""
    try:
        return _read(folder)
    except (OSError, ValueError, KeyError, TypeError, SlamgymError):
        return None


def _read(folder: Path) -> RunFiles:
    summary = read_results(folder, "run it again")
    frames = _table(folder / "frames.csv", FRAME_COLUMNS)
    fed = frames[frames["slam_state"].notna()]
    start_ns = int(fed["stamp_ns"].iloc[0]) if len(fed) else 0
    last_ns = int(fed["stamp_ns"].iloc[-1]) if len(fed) else 0
    shown = frames[frames["stamp_ns"].between(start_ns, last_ns)]
    turn = shown["yaw_rate_radps"].fillna(shown["rotation_rate_radps"])
    estimate, map_ids = _estimate(_table(folder / "poses.csv", POSE_COLUMNS), fed["stamp_ns"].to_numpy(np.int64))
    tracked = (fed["slam_state"] == OK).to_numpy()
    return RunFiles(
        summary=summary,
        fed_s=_seconds(fed["stamp_ns"], start_ns),
        states=tuple(fed["slam_state"]),
        truth=_truth(fed),
        estimate=np.where(tracked[:, None], estimate, np.nan),
        map_ids=np.where(tracked, map_ids, -1),
        tracked_points=fed["slam_tracked_points"].to_numpy(np.float64),
        frames_s=_seconds(shown["stamp_ns"], start_ns),
        speed_mps=shown["speed_mps"].to_numpy(np.float64),
        turn_degps=np.degrees(turn.to_numpy(np.float64)),
        flat=bool(frames["z_m"].isna().all()),
    )


FRAME_COLUMNS = (
    "stamp_ns", "x_m", "y_m", "z_m", "has_truth", "speed_mps", "yaw_rate_radps", "rotation_rate_radps", "slam_state",
    "slam_tracked_points",
)  # fmt: skip
POSE_COLUMNS = ("trajectory", "stamp_ns", "map_id", "x_m", "y_m", "z_m")


def _table(path: Path, columns: tuple[str, ...]) -> pd.DataFrame:
    """The file's columns of these names, those that it has not empty; of a run that ended before any frame, no rows."""
    if not path.is_file():
        return pd.DataFrame(columns=list(columns))
    return pd.read_csv(path, usecols=lambda name: name in columns).reindex(columns=list(columns))


def _seconds(stamps_ns: "pd.Series[Any]", start_ns: int) -> FloatArray:
    return np.asarray((stamps_ns.to_numpy(np.int64) - start_ns) * 1e-9)


def _truth(fed: pd.DataFrame) -> FloatArray:
    """A drive on a floor has no z in its file."""
    known = fed.assign(z_m=0.0) if fed["z_m"].isna().all() else fed
    positions = known[["x_m", "y_m", "z_m"]].to_numpy(np.float64)
    unknown = fed["has_truth"].isin([False, "False"]).to_numpy()
    return np.where(unknown[:, None], np.nan, positions)


def _estimate(poses: pd.DataFrame, fed_ns: IntArray) -> tuple[FloatArray, IntArray]:
    """Final poses by fed frame, of a run that has none those that were emitted."""
    final = poses[poses["trajectory"] == "final"]
    used = final if len(final) else poses[poses["trajectory"] == "online"]
    positions, map_ids = np.full((len(fed_ns), 3), np.nan), np.full(len(fed_ns), -1, dtype=np.int64)
    stamps_ns = used["stamp_ns"].to_numpy(np.int64)
    _, fed, rows = np.intersect1d(fed_ns, stamps_ns, assume_unique=True, return_indices=True)
    positions[fed] = used[["x_m", "y_m", "z_m"]].to_numpy(np.float64)[rows]
    map_ids[fed] = used["map_id"].to_numpy(np.int64)[rows]
    return positions, map_ids
