"""A run folder: everything about one episode, in files that other tools read, complete or not there at all.

config.yaml      all parameters, as they were resolved
episode.json     the results, the keys of `info["episode_slam"]` at the top level
groundtruth.txt  true poses of the camera's optical frame at every rendered frame, TUM format
estimate.txt     the SLAM's final poses in the evaluated map, TUM format
fed_frames.txt   stamps of the frames that the SLAM was given, for `slamgym eval --frames`
frames.csv       one row a rendered frame: motion of the robot, and the SLAM's answer where the frame was fed
map.png          seen from above: grid, planned and true path, aligned estimate, losses
slam.log         what the SLAM printed, the last MiB of it
"""

import json
import os
import tempfile
from itertools import count
from pathlib import Path

import pandas as pd
import yaml

from slamgym.errors import OutputError
from slamgym.eval.plots import plot_map
from slamgym.eval.robustness import estimate_by_frame, evaluated_frames
from slamgym.eval.summary import without_nan
from slamgym.eval.trajectories import Trajectory, write_stamps, write_tum
from slamgym.interrupt import deferred_interrupt
from slamgym.rollout import Episode
from slamgym.types import SlamRecord, TrackingState


def check_free(folder: Path) -> None:
    """Raise OutputError unless a run folder can be made at `folder`; to be asked before hours of work."""
    folder = folder.resolve()
    taken = folder.exists() and (not folder.is_dir() or any(folder.iterdir()))
    if taken or folder.is_mount() or Path.cwd().is_relative_to(folder):
        raise OutputError(f"output folder: expected a new or empty folder, got {folder}; remove it or name another")
    above = next(parent for parent in folder.parents if parent.exists())
    if not above.is_dir() or not os.access(above, os.W_OK | os.X_OK):
        raise OutputError(f"output folder: cannot write in {above}; name another folder, or change its permissions")


def write_run(episode: Episode, folder: Path) -> Path:
    """Write the run folder in one piece and return it; an interrupted episode's gets the suffix ".interrupted".

    Raises OutputError when the folder exists and is not empty or cannot be written. Ctrl-C waits until it is written.
    """
    folder = folder.resolve()
    if episode.summary["end"] == "interrupted":
        folder = _interrupted_folder(folder)
    check_free(folder)
    with deferred_interrupt() as interrupted:
        try:
            _write_at_once(episode, folder)
        except OSError as error:
            reason = error.strerror or str(error)
            raise OutputError(f"output folder: writing {folder} failed ({reason}); make room or name another") from None
    if interrupted():
        raise KeyboardInterrupt
    return folder


def _interrupted_folder(folder: Path) -> Path:
    """The first free name: what an earlier interrupted run left is kept."""
    suffixes = (".interrupted" if k == 1 else f".interrupted-{k}" for k in count(1))
    candidates = (folder.with_name(folder.name + suffix) for suffix in suffixes)
    return next(candidate for candidate in candidates if not candidate.exists())


def _write_at_once(episode: Episode, folder: Path) -> None:
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{folder.name}-", dir=folder.parent) as draft_folder:
        draft = Path(draft_folder) / folder.name
        draft.mkdir()
        _write_files(episode, draft)
        draft.replace(folder)


def frames_table(episode: Episode) -> pd.DataFrame:
    """One row a rendered frame; the `slam_*` columns are empty where the frame was not fed."""
    table = pd.DataFrame(
        {
            "stamp_ns": episode.stamps_ns,
            "x_m": episode.T_world_cam[:, 0, 3],
            "y_m": episode.T_world_cam[:, 1, 3],
            "speed_mps": [step.speed_mps for step in episode.steps],
            "yaw_rate_radps": [step.yaw_rate_radps for step in episode.steps],
            "progress_m": [step.progress_m for step in episode.steps],
            "collision": [step.collision for step in episode.steps],
        }
    )
    if episode.slam is None:
        return table
    return table.merge(_slam_table(episode.slam), on="stamp_ns", how="left")


def final_estimate(record: SlamRecord) -> Trajectory:
    """The SLAM's final poses (T_map_cam) in the evaluated map; empty when no frame was tracked."""
    T_map_cam, _ = estimate_by_frame(record)
    chosen = evaluated_frames(record)
    return Trajectory(record.stamps_ns[chosen], T_map_cam[chosen])


def _slam_table(record: SlamRecord) -> pd.DataFrame:
    position = record.T_map_cam[:, :3, 3]
    return pd.DataFrame(
        {
            "stamp_ns": record.stamps_ns,
            "slam_state": [TrackingState(state).label for state in record.states],
            "slam_map_id": pd.array(record.map_id, dtype="Int64"),
            "slam_tracked_points": pd.array(record.tracked_points, dtype="Int64"),
            "slam_event": list(record.events),
            "slam_x_m": position[:, 0],
            "slam_y_m": position[:, 1],
            "slam_z_m": position[:, 2],
        }
    )


def _write_files(episode: Episode, folder: Path) -> None:
    # Through JSON: a user may have given paths or NumPy's numbers, which YAML cannot write.
    config = json.loads(json.dumps(episode.config, default=str))
    (folder / "config.yaml").write_text(yaml.safe_dump(config, sort_keys=False))
    (folder / "episode.json").write_text(json.dumps(without_nan(episode.summary), indent=2, allow_nan=False) + "\n")
    write_tum(folder / "groundtruth.txt", Trajectory(episode.stamps_ns, episode.T_world_cam))
    frames_table(episode).to_csv(folder / "frames.csv", index=False, float_format="%.9g")
    (folder / "slam.log").write_text(episode.slam_log)
    if episode.slam is not None:
        write_tum(folder / "estimate.txt", final_estimate(episode.slam))
        write_stamps(folder / "fed_frames.txt", episode.slam.stamps_ns)
    plot_map(folder / "map.png", episode.grid, episode.path_xy, episode.T_world_cam, episode.slam, episode.summary)
