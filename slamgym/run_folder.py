"""A run folder: everything about one SLAM run, in files that other tools read, complete or not there at all.

config.yaml      all parameters, as they were resolved
episode.json     the results, the keys of `info["episode_slam"]` at the top level
groundtruth.txt  true poses of the camera's optical frame, TUM format: at every rendered frame, or all of a sequence
estimate.txt     the SLAM's final poses in the evaluated map, of several the largest, TUM format
poses.csv        all its poses, with the map that each is in: as they were emitted ("online"), and the "final" ones
fed_frames.txt   stamps of the frames that the SLAM was given, for `slamgym eval --frames`
frames.csv       one row a frame: motion of the camera, and the SLAM's answer where the frame was fed
map.png          seen from above: grid and planned path of a drive, true path, aligned estimate, losses
slam.log         what the SLAM printed, the last MiB of it
"""

from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import pandas as pd

from slamgym.eval.plots import plot_map
from slamgym.eval.robustness import estimate_by_frame, evaluated_frames
from slamgym.eval.trajectories import Trajectory, write_stamps, write_tum
from slamgym.files import check_free, draft
from slamgym.geometry import quaternion_xyzw
from slamgym.interrupt import deferred_interrupt
from slamgym.run_record import write_record
from slamgym.scenes.occupancy import OccupancyGrid
from slamgym.types import FloatArray, IntArray, SlamRecord, Summary, TrackingState


class Run(Protocol):
    """What a run folder is written of: an `Episode` or a `Replay`."""

    @property
    def config(self) -> dict[str, Any]: ...
    @property
    def summary(self) -> Summary: ...
    @property
    def truth(self) -> Trajectory | None: ...
    @property
    def slam(self) -> SlamRecord | None: ...
    @property
    def slam_log(self) -> str: ...
    @property
    def grid(self) -> OccupancyGrid | None: ...
    @property
    def path_xy(self) -> FloatArray | None: ...
    def motion(self) -> dict[str, Any]:
        """Columns with a row a frame, `stamp_ns` among them."""
        ...


def write_run(run: Run, folder: Path, also: Callable[[Path], None] | None = None) -> Path:
    """Write the run folder in one piece and return it; an interrupted episode's gets the suffix ".interrupted".

    also: writes what else belongs into the folder, before that is in its place. Raises OutputError when the folder
    exists and is not empty or cannot be written. Ctrl-C waits until it is written.
    """
    folder = folder.resolve()
    if run.summary["end"] == "interrupted":
        folder = _interrupted_folder(folder)
    check_free(folder, "folder")
    with deferred_interrupt() as interrupted, draft(folder) as place:
        place.mkdir()
        _write_files(run, place)
        if also is not None:
            also(place)
    if interrupted():
        raise KeyboardInterrupt
    return folder


def _interrupted_folder(folder: Path) -> Path:
    """The first free name: what an earlier interrupted run left is kept."""
    suffixes = (".interrupted" if k == 1 else f".interrupted-{k}" for k in count(1))
    candidates = (folder.with_name(folder.name + suffix) for suffix in suffixes)
    return next(candidate for candidate in candidates if not candidate.exists())


def frames_table(run: Run) -> pd.DataFrame:
    """One row a frame; the `slam_*` columns are empty where the frame was not fed."""
    table = pd.DataFrame(run.motion())
    return table if run.slam is None else table.merge(_slam_table(run.slam), on="stamp_ns", how="left")


def final_estimate(record: SlamRecord, map_policy: str = "largest") -> Trajectory:
    """The SLAM's final poses (T_map_cam) in the evaluated map; empty when no frame was tracked.

    Of "each" map only the largest: a file of poses has one origin.
    """
    T_map_cam, _ = estimate_by_frame(record)
    chosen = evaluated_frames(record, "largest" if map_policy == "each" else map_policy)
    return Trajectory(record.stamps_ns[chosen], T_map_cam[chosen])


def poses_table(record: SlamRecord) -> pd.DataFrame:
    """All poses of the SLAM, `online` and `final`, each in the map `map_id`: those of two maps share no origin."""
    online = record.map_id >= 0
    final = record.final
    return pd.concat(
        [
            _poses("online", record.stamps_ns[online], record.T_map_cam[online], record.map_id[online]),
            _poses("final", final.stamps_ns, final.T_map_cam, final.map_id),
        ]
    )


def _poses(trajectory: str, stamps_ns: IntArray, T_map_cam: FloatArray, map_id: IntArray) -> pd.DataFrame:
    known = np.isfinite(T_map_cam).all(axis=(1, 2))
    T_map_cam = T_map_cam[known]
    values = np.hstack([T_map_cam[:, :3, 3], quaternion_xyzw(T_map_cam)])
    columns = dict(zip(("x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"), values.T, strict=True))
    return pd.DataFrame({"trajectory": trajectory, "stamp_ns": stamps_ns[known], "map_id": map_id[known], **columns})


def _slam_table(record: SlamRecord) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "stamp_ns": record.stamps_ns,
            "slam_state": [TrackingState(state).label for state in record.states],
            "slam_map_id": pd.array(record.map_id, dtype="Int64"),
            "slam_tracked_points": pd.array(record.tracked_points, dtype="Int64"),
            "slam_event": list(record.events),
        }
    )


def _write_files(run: Run, folder: Path) -> None:
    write_record(folder, run.config, run.summary)
    if run.truth is not None:
        write_tum(folder / "groundtruth.txt", run.truth)
    frames_table(run).to_csv(folder / "frames.csv", index=False, float_format="%.9g")
    (folder / "slam.log").write_text(run.slam_log, encoding="utf-8")
    if run.slam is not None:
        write_tum(folder / "estimate.txt", final_estimate(run.slam, run.config["map_policy"]))
        poses_table(run.slam).to_csv(folder / "poses.csv", index=False, float_format="%.9g")
        write_stamps(folder / "fed_frames.txt", run.slam.stamps_ns)
    plot_map(folder / "map.png", run.grid, run.path_xy, run.truth, run.slam, run.summary)
