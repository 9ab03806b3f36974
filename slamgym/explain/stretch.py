"""A stretch of a path, driven anew and rendered once, and the SLAM runs over it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np

from slamgym.agents import Agent
from slamgym.agents.follower import Action
from slamgym.errors import ConfigError
from slamgym.eval.datasets import Sequence, read_sequence
from slamgym.explain.cases import Metres
from slamgym.explain.changes import Setup
from slamgym.explain.source import DrivenRun
from slamgym.recording import record_drive
from slamgym.replay import replay
from slamgym.rollout import Episode
from slamgym.run_folder import frames_table
from slamgym.study.busy import busy
from slamgym.study.slam_work import as_driven


class Variant(NamedTuple):
    """One way to drive a stretch and to run the SLAM over it."""

    setup: Setup
    stretch_m: Metres


@dataclass(frozen=True, slots=True, eq=False)
class DrivenStretch:
    """episode: the drive without a SLAM. sequence: its frames, on the disk."""

    episode: Episode
    sequence: Sequence


@dataclass(slots=True)
class Stretches:
    """Drives stretches of a run's path and keeps their frames in `folder`, one drive for all variants that share it."""

    run: DrivenRun
    folder: Path
    on_step: Callable[[str], None]
    _driven: dict[tuple[str, Metres], DrivenStretch] = field(default_factory=dict, init=False, repr=False)

    def drive(self, variant: Variant) -> DrivenStretch:
        """The stretch, driven now or before. Raises ConfigError when the house is not that of the run, and what
        `record_drive` raises.
        """
        key = variant.setup.drive.model_dump_json(), variant.stretch_m
        if key not in self._driven:
            self.on_step(f"driving {variant.stretch_m[1] - variant.stretch_m[0]:.1f} m")
            self._driven[key] = self._drive(variant, self.folder / str(len(self._driven)))
        return self._driven[key]

    def _drive(self, variant: Variant, folder: Path) -> DrivenStretch:
        run = self.run
        agent = _OnStretch(run.agent(), {**run.reset_options, "stretch_m": variant.stretch_m})
        env = gym.make("HomeRobot-v0", **variant.setup.drive.model_dump())
        try:
            episode = record_drive(env, agent, run.seed, folder)
        finally:
            env.close()
        name = f"{run.agent.__module__}:{run.agent.__qualname__}"
        config = {**episode.config, "run": {**episode.config["run"], "agent": name}}
        return DrivenStretch(replace(episode, config=config), read_sequence(folder))


@dataclass(frozen=True, slots=True)
class _OnStretch:
    """An agent that drives a part of its path."""

    agent: Agent
    reset_options: Mapping[str, Any]

    def act(self, obs: Mapping[str, Any], info: Mapping[str, Any]) -> Action:
        return self.agent.act(obs, info)


def check_house(run: DrivenRun, unchanged: DrivenStretch) -> None:
    """Raise ConfigError when the house is not the one that the run was driven in."""
    got = unchanged.episode.config["run"]["versions"]["house_sha256"]
    if run.house_sha256 not in ("", got):
        raise ConfigError(
            f"{run.folder}: expected the house that it was driven in ({run.house_sha256}), got another one ({got}); "
            "explain it with the files and the version of slamgym that it was made with"
        )


def why_not_comparable(unchanged: DrivenStretch, changed: DrivenStretch) -> str:
    """Why what happens on the one stretch tells nothing of the other; "" where it does."""
    if changed.episode.summary["end"] != "path_driven":
        return "the robot does not get to the end of the stretch"
    if not np.array_equal(unchanged.episode.path_xy, changed.episode.path_xy):
        return "it changes the path"
    return ""


def quickest_turn(stretch: DrivenStretch, begin_m: float, window_m: Metres) -> float:
    """The largest yaw rate to either side in the window, rad/s; begin_m: where the stretch begins."""
    motion = stretch.episode.motion()
    progress_m = begin_m + np.array(motion["progress_m"])
    within = (progress_m >= window_m[0]) & (progress_m <= window_m[1])
    return float(np.max(np.abs(motion["yaw_rate_radps"]), where=within, initial=0.0))


def run_slam(stretch: DrivenStretch, setup: Setup) -> Episode:
    """One SLAM run over the stretch; raises what `replay` raises."""
    with busy(setup.busy_processes):
        return as_driven(replay(stretch.sequence, setup.slam), stretch.episode)


def is_lost(episode: Episode, begin_m: float, window_m: Metres) -> bool:
    """Whether a frame fed in the window was not tracked, those before the first initialisation left out, or none was
    tracked at all; begin_m: where on the planned path the stretch begins.
    """
    frames = frames_table(episode)
    fed = frames[frames["slam_state"].notna()]
    tracked = fed["slam_state"] == "ok"
    within = (begin_m + fed["progress_m"]).between(*window_m)
    return not tracked[within].any() or bool((within & tracked.cummax() & ~tracked).any())
