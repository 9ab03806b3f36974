"""The second unit of a study's work: one SLAM run over the frames of a drive."""

import json
from collections.abc import Callable, Mapping
from dataclasses import asdict, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

from slamgym.errors import ConfigError
from slamgym.eval.datasets import Sequence
from slamgym.params import SlamInLoopParams, SlamParams
from slamgym.replay import Replay, replay
from slamgym.rollout import Episode
from slamgym.run_folder import write_run
from slamgym.study.busy import busy
from slamgym.study.drive_work import RecordedDrive, load_drive
from slamgym.study.loss_views import write_loss_views
from slamgym.study.planned import PlannedDrive, PlannedRun
from slamgym.types import SlamRecord, Summary

PLANNED = "planned.json"
SLAM_ENV_ID = "HomeRobotSLAM-v0"


def run_planned(run: PlannedRun, drive_folder: Path, out: Path) -> Summary:
    """Run the SLAM over the frames in `drive_folder`, write the run folder `out`, and return its `episode.json`.

    The folder is that of a live drive with the same parameters, and has besides `planned.json`, the run as it was
    planned, and `losses/N.jpg`, see `write_loss_views`. When the SLAM is gone before the drive's end, the drive's
    figures are still those of the whole drive, and the frames that are left count as not tracked. Without the drive's
    environment, over a sequence that somebody recorded, it is the folder of a `Replay`.

    Raises ConfigError and SlamError for a SLAM that cannot be run, SequenceError for frames that cannot be read, and
    OutputError, all of which leave nothing behind.
    """
    drive = load_drive(drive_folder)
    episode = drive.facts.episode
    with busy(run.busy_processes):
        done = replay(drive.sequence, _params(run, episode))
    result = done if episode is None else as_driven(done, episode)
    write_run(result, out, _also(run, drive.sequence, done.slam))
    return result.summary


def as_driven(done: Replay, drive: Episode) -> Episode:
    """What a live episode would have been: the drive with the SLAM that its frames were replayed through."""
    return replace(
        drive,
        config=_as_driven_config(done.config, done.config["run"]["versions"], drive),
        slam=done.slam,
        slam_log=done.slam_log,
        summary=_as_driven_summary(done.summary, drive.summary),
    )


def config_of(run: PlannedRun, drive: RecordedDrive) -> dict[str, Any]:
    """What `config.yaml` of the run says, without running it. Raises ConfigError and SlamError for the SLAM."""
    sequence, episode = drive.sequence, drive.facts.episode
    params = _params(run, episode)
    recorded = params.recorded(params.config(sequence.camera, sequence.fps))
    versions = {"slamgym": version("slamgym"), **recorded.pop("slam_versions")}
    if episode is not None:
        return _as_driven_config(recorded, versions, episode)
    made = {"run": {"sequence": sequence.name, "versions": versions}}
    return {**made, "camera": asdict(sequence.camera), "fps": sequence.fps, **recorded}


def _params(run: PlannedRun, episode: Episode | None) -> SlamParams:
    """With the reward, which only a drive has, and which is recorded beside the rest."""
    return (SlamParams if episode is None else SlamInLoopParams).checked(run.slam)


def _as_driven_config(slam: Mapping[str, Any], versions: Mapping[str, str], drive: Episode) -> dict[str, Any]:
    """slam, versions: parameters of the SLAM, and what its results depend on."""
    run = drive.config["run"]
    return {
        **drive.config,
        "run": {**run, "env_id": SLAM_ENV_ID, "versions": {**run["versions"], **versions}},
        **{name: value for name, value in slam.items() if name in SlamInLoopParams.model_fields},
    }


def write_planned(run_folder: Path, run: PlannedRun) -> None:
    """Raises OSError."""
    (run_folder / PLANNED).write_text(json.dumps(asdict(run), indent=1, default=str) + "\n")


def read_planned(run_folder: Path) -> PlannedRun | None:
    """The run as a study planned it, None where no study did; raises ConfigError for what is not one."""
    path = run_folder / PLANNED
    if not path.exists():
        return None
    try:
        told = json.loads(path.read_text())
        return PlannedRun(**{**told, "drive": PlannedDrive(**told["drive"])})
    except (OSError, ValueError, TypeError, KeyError) as error:
        why = f"{type(error).__name__}: {error}".splitlines()[0]
        raise ConfigError(f"{path}: expected a run as a study planned it, got {why}; plan it anew") from None


def _as_driven_summary(slam: Summary, drive: Summary) -> Summary:
    """`seed` and `end` first, as of an episode; distances are those of the drive."""
    of_replay = {"sequence", "frames"}
    return {
        "seed": drive["seed"],
        "end": slam["end"] if slam["end"] == "slam_gone" else drive["end"],
        **{name: value for name, value in slam.items() if name not in of_replay | {"end", "timing"}},
        **{name: value for name, value in drive.items() if name not in {"seed", "end"}},
        "timing": slam["timing"],
    }


def _also(run: PlannedRun, sequence: Sequence, record: SlamRecord) -> Callable[[Path], None]:
    def write(folder: Path) -> None:
        write_planned(folder, run)
        write_loss_views(folder, sequence, record)

    return write
