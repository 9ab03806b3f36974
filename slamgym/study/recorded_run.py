"""A run that its folder lets one repeat, whoever wrote it: `slamgym run`, Python, or a study."""

import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from operator import attrgetter
from pathlib import Path
from typing import Any

from slamgym.agents import Agent
from slamgym.errors import ConfigError
from slamgym.params import SlamParams
from slamgym.run_record import read_config
from slamgym.slam.backend import load_backend
from slamgym.study.slam_work import read_planned

Config = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class RecordedRun:
    """keywords: of `gym.make("HomeRobotSLAM-v0", ...)`. versions: name -> that of what its results depended on.

    busy_processes: how many kept the computer busy meanwhile, as a study had planned.
    """

    keywords: dict[str, Any]
    seed: int
    agent: type[Agent]
    versions: dict[str, str]
    busy_processes: int


def read_recorded_run(folder: Path) -> RecordedRun:
    """The run in a run folder. Raises ConfigError where there is none, or one that no environment drove."""
    config = _read_config(folder)
    run = config["run"]
    if "sequence" in run:
        raise ConfigError(
            f"{folder}: expected a drive, got a run over the recorded sequence {run['sequence']}; repeat it with: "
            f"{_replay_line(folder, config)}"
        )
    if "slam" not in config:
        raise ConfigError(f"{folder}: expected a run with a SLAM in the loop, got a drive without; name another")
    try:
        agent = _agent(run["agent"], run["reset_options"])
        keywords = {name: value for name, value in config.items() if name != "run"}
        planned = read_planned(folder)
        busy_processes = 0 if planned is None else planned.busy_processes
        return RecordedRun(keywords, run["seed"], agent, dict(run["versions"]), busy_processes)
    except KeyError as error:
        raise ConfigError(f"{folder / 'config.yaml'}: expected {error} of the run, got none; name another") from None


def changed_versions(then: Mapping[str, str], now: Mapping[str, str]) -> list[str]:
    """What the results depend on and is no longer as it was, a line each.

    >>> changed_versions({"slamgym": "0.1", "pyorbslam3": "0.1.1"}, {"slamgym": "0.2", "pyorbslam3": "0.1.1"})
    ['slamgym: 0.1 then, 0.2 now']
    """
    names = [name for name in {**then, **now} if then.get(name) != now.get(name)]
    return [f"{name}: {then.get(name, 'none')} then, {now.get(name, 'none')} now" for name in names]


def _read_config(folder: Path) -> dict[str, Any]:
    config = read_config(folder, "name another")
    if not isinstance(config.get("run"), dict):
        path = folder / "config.yaml"
        raise ConfigError(f"{path}: expected the parameters of a run, with an entry 'run', got none; name another")
    return config


def _agent(target: str, reset_options: Mapping[str, Any]) -> type[Agent]:
    """The class at "module:class"; where that resets the environment otherwise, one of its name that does as then."""
    module, _, name = target.partition(":")
    try:
        found: type[Any] = attrgetter(name)(import_module(module))
    except Exception as error:  # the module may be anybody's, and fail in any way
        why = f"{type(error).__name__}: {error}".splitlines()[0]
        raise ConfigError(
            f"agent {target}: expected one that can be imported, got {why}; install its package"
        ) from None
    if dict(getattr(found, "reset_options", {})) == dict(reset_options):
        return found
    attributes = {"reset_options": dict(reset_options), "__module__": module, "__qualname__": name}
    return type(found.__name__, (found,), attributes)


def _replay_line(folder: Path, config: Config) -> str:
    """What to type to repeat a replay: all that is not as it is by default."""
    planned = read_planned(folder)
    sequence = (planned and planned.drive.sequence) or config["run"]["sequence"]
    defaults = {name: info.get_default(call_default_factory=True) for name, info in SlamParams.model_fields.items()}
    changed = {name: config[name] for name in defaults if name in config and config[name] != defaults[name]}
    words = ["slamgym", "replay", str(sequence), "--out", "DIR"]
    for name, value in changed.items():
        given = _changed_options(config) if name == "slam_options" else [str(value)]
        words += [f"--{name.replace('_', '-')}", *given] if given else []
    return shlex.join(words)


def _changed_options(config: Config) -> list[str]:
    """Names and values of the backend's options that are not as they are by default."""
    fields = load_backend(config.get("slam", "orbslam3")).Options.model_fields
    defaults = {name: info.get_default(call_default_factory=True) for name, info in fields.items()}
    changed = {name: value for name, value in config["slam_options"].items() if value != defaults.get(name)}
    return [str(word) for pair in changed.items() for word in pair]
