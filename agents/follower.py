"""Agents, and the one that follows the planned path."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from slamgym.agents.path import WAYPOINT_SPACING_M
from slamgym.types import FloatArray

Action = NDArray[np.float32]
"""Forward and turn (2,), in [-1, 1]: shares of the robot's speed and of its turn rate, turning left above 0."""

FULL_SPEED_RADIUS_M = 0.3
"""Bends down to this radius are driven at full speed, up to `SWIFT_MPS`; faster, the yaw rate cannot follow."""
SWIFT_MPS = 0.9
BRAKING_DISTANCE_M = 0.35
BRAKING_MPS2 = 2.0
SLOWEST = 0.1
HARD_TURN = 0.8
TURN_ON_THE_SPOT_RAD = np.pi / 3
REACHED_M = 0.03


class Agent(Protocol):
    """Whatever drives the robot. An attribute `reset_options`, where it has one, goes to the reset of the environment
    as `options`.
    """

    def act(self, obs: Mapping[str, Any], info: Mapping[str, Any]) -> Action:
        """The action (2,), float32, in [-1, 1], for an observation and info of the environment."""
        ...


@dataclass(frozen=True, slots=True)
class PathFollower:
    """Pure pursuit of `obs["waypoints"]`. Of `info` it only takes what its actions mean, `action_scale`.

    R. C. Coulter, Implementation of the Pure Pursuit Path Tracking Algorithm, 1992. It slows down before bends that are
    tighter than 0.3 m and turns on the spot where the path leads back. It remembers nothing.
    """

    reset_options: ClassVar[Mapping[str, Any]] = {"tour": "one_way"}

    def act(self, obs: Mapping[str, Any], info: Mapping[str, Any]) -> Action:
        waypoints = np.asarray(obs["waypoints"], dtype=np.float64)
        target = _target(waypoints)
        distance = float(np.hypot(*target))
        bearing = float(np.arctan2(target[1], target[0]))
        if distance < REACHED_M:
            return np.zeros(2, dtype=np.float32)
        if abs(bearing) > TURN_ON_THE_SPOT_RAD:
            return np.array([0.0, np.sign(bearing)], dtype=np.float32)
        speed, turn_rate = info["action_scale"]
        forward = _allowed_speed(waypoints, speed)
        turn = forward * 2 * np.sin(bearing) / distance * speed / turn_rate
        # Slower where the turn comes near its limit: turning faster takes time, and at speed the robot would overshoot.
        ease = max(1.0, abs(turn) / HARD_TURN) ** 2
        return np.array([forward / ease, turn / ease], dtype=np.float32)


def _target(waypoints: FloatArray) -> FloatArray:
    """The point (2,) to steer for: 0.3 m along the path, or nearer where the path folds back before that."""
    first, second = waypoints[:2]
    if first @ (second - first) < 0 and first[0] > REACHED_M:
        return cast(FloatArray, first)
    ahead = np.vstack([(waypoints[:-1] + waypoints[1:]) / 2, waypoints[-1]])
    # Right at a fold the nearest of them lie under the robot; at the path's end all do.
    beyond = np.hypot(*ahead.T) > REACHED_M
    return cast(FloatArray, ahead[np.argmax(beyond) if beyond.any() else -1])


def _allowed_speed(waypoints: FloatArray, speed: float) -> float:
    """Share of full speed, `speed` m/s, that still lets the robot slow down for each bend in the waypoints (5, 2)."""
    full_speed_radius_m = FULL_SPEED_RADIUS_M * max(1.0, speed / SWIFT_MPS) ** 2
    braking_distance_m = max(BRAKING_DISTANCE_M, speed**2 / (2 * BRAKING_MPS2))
    segments = np.diff(waypoints, axis=0, prepend=np.zeros((1, 2)))
    (ax, ay), (bx, by) = segments[:-1].T, segments[1:].T
    curvature = np.abs(np.arctan2(ax * by - ay * bx, ax * bx + ay * by)) / WAYPOINT_SPACING_M
    in_bend = 1 / np.maximum(1.0, full_speed_radius_m * curvature)
    # A bend seen at one waypoint may have begun at the one before.
    distance = np.cumsum(np.hypot(ax, ay)) - WAYPOINT_SPACING_M
    # v^2 = v_bend^2 + 2 a d
    allowed = np.sqrt(in_bend**2 + np.maximum(distance, 0.0) / braking_distance_m)
    return float(np.clip(allowed.min(), SLOWEST, 1.0))
