"""The first unit of a study's work: a drive that is rendered once, kept with what the results of its SLAM runs need.

drive.json   the planned drive, hashes of what it is made of, its config, and the drive's part of the results
drive.npz    motion at every frame, planned path, occupancy grid
views.jpg    some views, in the order of the drive
frames/      the frames, in the layout of TUM RGB-D; of a sequence that somebody recorded nothing is copied
"""

import hashlib
import json
import shutil
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from slamgym.agents import AGENTS
from slamgym.errors import ConfigError, SceneError, SequenceError, unknown_word
from slamgym.eval.datasets import Sequence, read_sequence
from slamgym.eval.plots.contact_sheet import Image, contact_sheet, jpg
from slamgym.eval.summary import without_nan
from slamgym.files import check_free, draft, short_hash
from slamgym.recording import record_drive
from slamgym.rollout import Episode, Step
from slamgym.scenes.fingerprint import array_sha256
from slamgym.scenes.occupancy import OccupancyGrid
from slamgym.study.canonical import canonical
from slamgym.study.planned import PlannedDrive

FRAMES = "frames"
FACTS = ("drive.json", "drive.npz", "views.jpg")
VIEWS, VIEW_COLUMNS, VIEW_WIDTH = 6, 3, 240


@dataclass(frozen=True, slots=True, eq=False)
class DriveFacts:
    """episode: the drive without a SLAM, None for a sequence that somebody recorded."""

    planned: PlannedDrive
    episode: Episode | None


@dataclass(frozen=True, slots=True, eq=False)
class RecordedDrive:
    """A drive's facts and its frames, whose poses are the true ones to the last bit."""

    facts: DriveFacts
    sequence: Sequence


def record_planned_drive(drive: PlannedDrive, folder: Path) -> None:
    """Drive and render, or look a recorded sequence through, and write the folder of the drive in one piece.

    Raises OutputError when the folder exists and is not empty or cannot be written, ConfigError, SceneError and
    RenderError for a drive that cannot be driven, SequenceError for a sequence that cannot be read.
    """
    check_free(folder, "folder")
    with draft(folder) as place:
        place.mkdir()
        if drive.sequence is None:
            episode = _driven(drive, place / FRAMES)
            sequence = read_sequence(place / FRAMES)
        else:
            episode, sequence = None, read_sequence(Path(drive.sequence))
        _write_facts(place, drive, sequence, episode)
        (place / "views.jpg").write_bytes(jpg(_views(sequence)))


def read_facts(folder: Path) -> DriveFacts:
    """What a study keeps of a drive, with or without its frames; raises SequenceError where it is not."""
    try:
        told = json.loads((folder / "drive.json").read_text())
        planned = PlannedDrive(**told["drive"])
        return DriveFacts(planned, None if planned.sequence else _read_episode(folder, told))
    except (OSError, EOFError, ValueError, KeyError, TypeError, zipfile.BadZipFile, zlib.error) as error:
        why = f"{type(error).__name__}: {error}".splitlines()[0]
        raise SequenceError(f"{folder}: expected a drive that a study recorded, got {why}; record it anew") from None


def load_drive(folder: Path) -> RecordedDrive:
    """What `record_planned_drive` wrote; raises SequenceError where it is not there or cannot be read."""
    facts = read_facts(folder)
    if facts.episode is None:
        assert facts.planned.sequence is not None
        return RecordedDrive(facts, read_sequence(Path(facts.planned.sequence)))
    truth = facts.episode.truth
    return RecordedDrive(facts, replace(read_sequence(folder / FRAMES), T_world_cam=truth.T, truth=truth))


def keep_facts(folder: Path, kept: Path) -> None:
    """Copy all but the frames of a drive's folder to a new folder, in one piece; where it is already, nothing happens,
    unless it cannot be read: then it is replaced.

    Raises OutputError.
    """
    if is_drive(kept):
        return
    shutil.rmtree(kept, ignore_errors=True)
    with draft(kept) as place:
        place.mkdir()
        for name in FACTS:
            if (folder / name).exists():
                shutil.copy(folder / name, place)


def is_drive(folder: Path) -> bool:
    """Whether the facts of a drive can be read there."""
    try:
        return bool(read_facts(folder))
    except SequenceError:
        return False


def _driven(drive: PlannedDrive, frames: Path) -> Episode:
    if drive.agent not in AGENTS:
        raise ConfigError(unknown_word("agent", drive.agent, AGENTS))
    env = gym.make("HomeRobot-v0", max_episode_steps=drive.max_episode_steps, **drive.params)
    try:
        return record_drive(env, AGENTS[drive.agent](), drive.seed, frames)
    except OSError as error:  # a scene's or an agent's own: the draft around this would tell it as a full disk
        why = f"{type(error).__name__}: {error}".splitlines()[0]
        raise SceneError(
            f"{drive.path}: expected a drive through the scene, got {why}; see to what is missing"
        ) from None
    finally:
        env.close()


def _made_of(drive: PlannedDrive, sequence: Sequence, episode: Episode | None) -> dict[str, str]:
    """Hashes of what the frames come from, by what a person calls it: the scene as it was loaded, a given map, or of a
    recorded sequence when its frames were taken and where.
    """
    if episode is None:
        parts = sequence.stamps_ns, sequence.T_world_cam
        digest = hashlib.sha256(b"".join(map(array_sha256, parts)) + repr(sequence.camera).encode())
        return {str(drive.sequence): short_hash(digest.hexdigest())}
    versions = episode.config["run"]["versions"]
    scene = " ".join([str(episode.config["scene"]), *_words(drive.params.get("scene_options", {}))])
    made_of = {scene: versions["house_sha256"]}
    if "occupancy_map_sha256" in versions:
        made_of[f"{episode.config['occupancy_map']} for {scene}"] = versions["occupancy_map_sha256"]
    return made_of


def _words(options: Mapping[str, Any]) -> list[str]:
    return [f"{name}={canonical(value)}" for name, value in sorted(options.items())]


def _write_facts(folder: Path, drive: PlannedDrive, sequence: Sequence, episode: Episode | None) -> None:
    told: dict[str, Any] = {"drive": asdict(drive), "made_of": _made_of(drive, sequence, episode)}
    if episode is not None:
        told |= {"config": episode.config, "summary": without_nan(episode.summary)}
        columns = zip(*episode.steps, strict=True)
        grid = episode.grid
        np.savez_compressed(
            folder / "drive.npz",
            allow_pickle=False,
            **dict(zip(Step._fields, map(np.array, columns), strict=True)),
            path_xy=episode.path_xy,
            occupied=grid.occupied,
            origin_xy=grid.origin_xy,
            resolution_m=grid.resolution_m,
        )
    (folder / "drive.json").write_text(json.dumps(told, indent=1, default=str, allow_nan=False) + "\n")


def _read_episode(folder: Path, told: Mapping[str, Any]) -> Episode:
    with np.load(folder / "drive.npz", allow_pickle=False) as arrays:
        steps = zip(*(_values(arrays[name]) for name in Step._fields), strict=True)
        return Episode(
            config=told["config"],
            seed=told["summary"]["seed"],
            steps=tuple(Step(*step) for step in steps),
            path_xy=arrays["path_xy"],
            grid=OccupancyGrid(arrays["occupied"], arrays["origin_xy"], float(arrays["resolution_m"])),
            slam=None,
            slam_log="",
            # JSON has no NaN, and nothing else of a drive's results is empty.
            summary={name: np.nan if value is None else value for name, value in told["summary"].items()},
        )


def _values(column: np.ndarray[Any, Any]) -> list[Any]:
    """Python's numbers of a column (N,), arrays of one with more dimensions."""
    return list(column.tolist() if column.ndim == 1 else column)


def _views(sequence: Sequence) -> Image:
    """From the first frame to the last, all of them of a sequence that is shorter."""
    rows = np.unique(np.linspace(0, len(sequence) - 1, VIEWS).astype(int)).tolist()
    return contact_sheet([sequence.frame(row).rgb for row in rows], VIEW_COLUMNS, VIEW_WIDTH)
