"""The run that is to be explained, as its folder tells it."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from slamgym.agents import AGENTS, Agent, Cautious
from slamgym.errors import ConfigError, SlamgymError, TrajectoryWarning
from slamgym.explain.changes import Setup
from slamgym.params import DriveParams, SlamInLoopParams
from slamgym.run_record import read_config, read_results
from slamgym.study.slam_work import read_planned
from slamgym.study.table import open_study


@dataclass(frozen=True, slots=True)
class Loss:
    """number: from 1. start_s: since the first frame. progress_m: along the planned path. cause: a word of the rules
    in `slamgym.eval.robustness`, "unknown" where they name none.
    """

    number: int
    start_s: float
    progress_m: float
    cause: str
    explanation: str


@dataclass(frozen=True, slots=True)
class DrivenRun:
    """A run whose drive can be repeated. reset_options: of its agent. stretch_m: metres of the planned path that it
    drove. house_sha256: as it is recorded, "" where it is not. losses: in the order of time.
    """

    folder: Path
    setup: Setup
    seed: int
    agent: type[Agent]
    reset_options: Mapping[str, Any]
    stretch_m: tuple[float, float]
    house_sha256: str
    losses: tuple[Loss, ...]


def runs_in(path: Path) -> list[Path]:
    """The run folder itself, or the folders of a study's runs with a loss, but for those over recorded sequences, of
    which a TrajectoryWarning tells. Raises ConfigError where it is neither, or all losses are over such sequences.
    """
    if (path / "episode.json").is_file():
        return [path]
    if not (path / "plan.json").is_file():
        raise ConfigError(f"{path}: expected the folder of a run or of a study, got neither; name one of `slamgym run`")
    runs = open_study(path).runs
    if "loss_count" not in runs:
        return []  # none has finished yet
    lost = runs[runs["loss_count"].fillna(0) > 0]
    recorded = lost["sequence"].notna()
    if recorded.any():
        _tell_recorded(path, int(lost["loss_count"][recorded].sum()), all_losses=bool(recorded.all()))
    return [path / "runs" / run_id for run_id in lost["run_id"][~recorded]]


def _tell_recorded(path: Path, losses: int, all_losses: bool) -> None:
    if all_losses:
        raise ConfigError(f"{path}: all {losses} losses are over recorded sequences, where {FIXED}")
    message = f"{path}: {losses} losses are over recorded sequences, where nothing can be changed: left out"
    warnings.warn(message, TrajectoryWarning, stacklevel=3)


def read_run(folder: Path) -> DrivenRun:
    """The run in a folder of `slamgym run`, or of a study; raises ConfigError where it cannot be driven again."""
    config, results = read_config(folder, ANOTHER), read_results(folder, ANOTHER)
    try:
        if "sequence" in config["run"]:
            raise ConfigError(f"{folder}: expected a run over a drive, got one over a recorded sequence, where {FIXED}")
        return _driven_run(folder, config, results)
    except SlamgymError:
        raise
    except (OSError, ValueError, KeyError, TypeError, IndexError, AttributeError) as error:
        raise ConfigError(f"{folder}: expected the folder of a run, got {_damage(error)}; {ANOTHER}") from None


def _damage(error: Exception) -> str:
    """What is wrong with a folder, by what reading it came to."""
    if isinstance(error, OSError):
        return f"one whose {Path(str(error.filename)).name} cannot be read"
    if isinstance(error, KeyError):
        return f"a damaged one, without {error.args[0]!r}"
    return "a damaged one, whose config.yaml, episode.json and frames.csv cannot be those of one run"


ANOTHER = "name one of `slamgym run`"
FIXED = "nothing can be changed; explain a run of `slamgym run` or of a study's drive"


def _driven_run(folder: Path, config: Mapping[str, Any], results: Mapping[str, Any]) -> DrivenRun:
    run = config["run"]
    options = dict(run["reset_options"])
    begin_m = float(options.pop("stretch_m", (0.0,))[0])
    planned = read_planned(folder)
    setup = Setup(
        DriveParams.checked({name: config[name] for name in DriveParams.model_fields}),
        SlamInLoopParams.checked({name: config[name] for name in SlamInLoopParams.model_fields if name in config}),
        0 if planned is None else planned.busy_processes,
    )
    return DrivenRun(
        folder=folder,
        setup=setup,
        seed=int(run["seed"]),
        agent=_agent(folder, run["agent"]),
        reset_options=options,
        stretch_m=(begin_m, begin_m + results["planned_path_m"]),
        house_sha256=run["versions"].get("house_sha256", ""),
        losses=_losses(folder, results["losses"], begin_m),
    )


def _agent(folder: Path, target: str) -> type[Agent]:
    agents = {f"{agent.__module__}:{agent.__qualname__}": agent for agent in AGENTS.values() if agent is not Cautious}
    if target not in agents:
        names = [name for name, agent in AGENTS.items() if agent is not Cautious]
        raise ConfigError(
            f"{folder}: expected a drive by an agent of {', '.join(names)}, whose drive does not depend on the SLAM, "
            f"got {target}; explain another run"
        )
    return agents[target]


def _losses(folder: Path, losses: list[Mapping[str, Any]], begin_m: float) -> tuple[Loss, ...]:
    frames = pd.read_csv(folder / "frames.csv")
    fed_m = begin_m + frames["progress_m"][frames["slam_state"].notna()].to_numpy()
    return tuple(
        Loss(
            number=number,
            start_s=float(loss["start_s"]),
            progress_m=float(fed_m[loss["start_frame"]]),
            cause=(loss["context"] or {}).get("cause", "unknown"),
            explanation=(loss["context"] or {}).get("explanation", ""),
        )
        for number, loss in enumerate(losses, start=1)
    )
