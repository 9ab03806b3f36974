"""An agent that looks around wherever it has arrived."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf, pi, remainder, sqrt, tau
from typing import Any, ClassVar

import numpy as np

from slamgym.agents.follower import Action, PathFollower

BRAKING_MPS2 = 1.0
BRAKING_RADPS2 = 6.0
"""Half of what the robot can do, so that it stops where it means to."""
SLOWEST = 0.1
ARRIVED_M = 0.03
TURNED_RAD = 0.02
MOST_A_FRAME_RAD = pi / 4
"""Turned further between two frames, it could not tell how far."""
SAME_GOAL_M = 1e-6


@dataclass(slots=True)
class _Memory:
    """goal_m: where on the path the next goal is, kept while the robot rolls past it. done_m: that of the last one
    dealt with. turned: radians on the spot so far, None on the way. yaw, stamp_ns: of the last frame.
    """

    goal_m: float = inf
    done_m: float = 0.0
    turned: float | None = None
    yaw: float = 0.0
    stamp_ns: int = 0


@dataclass(slots=True)
class LookAround:
    """A path follower that stops at every goal of the path, turns once around on the spot, to the left, and goes on.

    Of `info` it takes `progress_m` and `goal_m` (where the next goal is), `robot` (how far it has turned), `stamp_ns`
    and `action_scale`. It remembers what it has done in this episode: one agent drives one environment.
    """

    reset_options: ClassVar[Mapping[str, Any]] = {"tour": "one_way"}
    _memory: _Memory = field(default_factory=_Memory, init=False, repr=False)

    def act(self, obs: Mapping[str, Any], info: Mapping[str, Any]) -> Action:
        if info["stamp_ns"] == 0:
            self._memory = _Memory()
        memory = self._memory
        to_goal_m = _to_goal(memory, info)
        turned, frame_s = _since_last_frame(memory, info)
        speed, turn_rate = info["action_scale"]
        if to_goal_m <= ARRIVED_M:
            memory.turned = 0.0 if memory.turned is None else memory.turned + turned
            if (left := tau - memory.turned) > TURNED_RAD:
                most = MOST_A_FRAME_RAD / max(frame_s * turn_rate, MOST_A_FRAME_RAD)
                return np.array([0.0, min(_braked(left, BRAKING_RADPS2, turn_rate), most)], dtype=np.float32)
            memory.done_m, memory.goal_m, memory.turned = memory.goal_m, inf, None
        # Slower along the same curve.
        return PathFollower().act(obs, info) * np.float32(_braked(max(to_goal_m, 0.0), BRAKING_MPS2, speed))


def _to_goal(memory: _Memory, info: Mapping[str, Any]) -> float:
    """Metres along the path to the next goal not dealt with; below 0 where the robot rolled past it."""
    progress_m = float(info["progress_m"])
    if progress_m < memory.goal_m:
        goal_m = progress_m + float(info["goal_m"])
        memory.goal_m = goal_m if goal_m > memory.done_m + SAME_GOAL_M else inf
    return memory.goal_m - progress_m


def _since_last_frame(memory: _Memory, info: Mapping[str, Any]) -> tuple[float, float]:
    """Radians turned to the left, and seconds, since the frame before."""
    yaw, stamp_ns = float(info["robot"][2]), int(info["stamp_ns"])
    since = remainder(yaw - memory.yaw, tau), (stamp_ns - memory.stamp_ns) * 1e-9
    memory.yaw, memory.stamp_ns = yaw, stamp_ns
    return since


def _braked(left: float, braking: float, full: float) -> float:
    """Share of the rate `full` from which the robot still stops within `left`: v^2 = 2 a d."""
    return min(max(sqrt(2 * braking * left) / full, SLOWEST), 1.0)
