"""An agent that takes its speed from how well the SLAM tracks."""

from bisect import insort
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from slamgym.agents.follower import Action, PathFollower
from slamgym.errors import ConfigError

HEALTHY = 0.5
"""Share of the points that are usual in this episode, from which on it drives at full speed."""
SLOWEST = 0.2


@dataclass(slots=True)
class Cautious:
    """A path follower that slows down, along the same curve, when the SLAM tracks fewer points than usual.

    speed factor = clip(points / (HEALTHY * usual), SLOWEST, 1), usual: their median over the tracked frames of the
    episode so far. While the SLAM is not tracking it creeps at SLOWEST. Of `info` it takes `slam`, `stamp_ns` and
    `action_scale`; one agent drives one environment. Raises ConfigError where there is no SLAM in the loop.
    """

    reset_options: ClassVar[Mapping[str, Any]] = {"tour": "one_way"}
    _counts: list[int] = field(default_factory=list, init=False, repr=False)
    """Points of the tracked frames, sorted."""

    def act(self, obs: Mapping[str, Any], info: Mapping[str, Any]) -> Action:
        if "slam" not in info:
            raise ConfigError(
                "agent 'cautious': expected a SLAM in the loop, got none; use HomeRobotSLAM-v0, or agent 'follower'"
            )
        if info["stamp_ns"] == 0:
            self._counts = []
        return PathFollower().act(obs, info) * np.float32(self._speed_factor(info["slam"]))

    def _speed_factor(self, slam: Mapping[str, Any]) -> float:
        if slam["state"] != "ok":
            return SLOWEST
        points = int(slam["tracked_points"])
        if slam["fresh"] or not self._counts:
            insort(self._counts, points)
        usual = self._counts[len(self._counts) // 2]
        # A SLAM that counts no points is taken at its word.
        return float(np.clip(points / (HEALTHY * usual), SLOWEST, 1.0)) if usual > 0 else 1.0
