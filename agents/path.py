"""A path on the floor, measured by arc length."""

from dataclasses import dataclass, field
from typing import cast

import numpy as np
from numpy.typing import NDArray

from slamgym.types import FloatArray

SPACING_M = 0.05
WAYPOINT_COUNT = 5
WAYPOINT_SPACING_M = 0.2
AHEAD_M: FloatArray = WAYPOINT_SPACING_M * np.arange(1.0, WAYPOINT_COUNT + 1)
PROJECTION_WINDOW_M = 0.5
AHEAD_PENALTY = 0.1


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """A polyline. xy: world points (P, 2), metres, P >= 2; arc_m: the distances (P,) along the path to each of them.
    goals_m: distances (G,) of the goals that it was planned through; its ends are none.
    """

    xy: FloatArray
    goals_m: FloatArray = field(default_factory=lambda: np.zeros(0))
    arc_m: FloatArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "arc_m", arc_length(self.xy))

    @property
    def length_m(self) -> float:
        return float(self.arc_m[-1])

    def point_at(self, s: float | FloatArray) -> FloatArray:
        """Points (..., 2) at the distances `s` (...) along the path, clamped to its ends."""
        return np.stack([np.interp(s, self.arc_m, self.xy[:, axis]) for axis in (0, 1)], axis=-1)

    def heading_at(self, s: float) -> float:
        """Direction of the path at distance `s`, radians from the x axis, counter-clockwise."""
        k = int(np.clip(np.searchsorted(self.arc_m, s, side="right") - 1, 0, len(self.xy) - 2))
        dx, dy = self.xy[k + 1] - self.xy[k]
        return float(np.arctan2(dy, dx))

    def next_goal(self, s: float) -> float:
        """Distance along the path of the first goal at or beyond distance `s`; infinite when there is none."""
        return float(np.min(self.goals_m[self.goals_m >= s], initial=np.inf))

    def project(self, xy: tuple[float, float] | FloatArray, s_hint: float) -> float:
        """Distance along the path of the point nearest to `xy` (2,), at `s_hint` or up to 0.5 m ahead of it.

        The last progress is the hint: so a path that crosses or retraces itself does not make progress jump, and
        progress never goes back.
        """
        first = int(np.clip(np.searchsorted(self.arc_m, s_hint, side="right") - 1, 0, len(self.xy) - 2))
        last = int(np.searchsorted(self.arc_m, s_hint + PROJECTION_WINDOW_M)) + 1
        a, b = self.xy[first:last][:-1], self.xy[first:last][1:]
        length = np.diff(self.arc_m[first:last])
        t = np.clip(np.sum((xy - a) * (b - a), axis=1) / np.maximum(length**2, 1e-12), 0.0, 1.0)
        s = np.maximum(self.arc_m[first:last][:-1] + t * length, min(s_hint, self.length_m))
        distance = np.linalg.norm(self.point_at(s) - xy, axis=1)
        # Where the path lies twice in the same place, the nearer in progress wins.
        return float(s[np.argmin(distance + AHEAD_PENALTY * (s - s[0]))])

    def waypoints(self, s: float, x: float, y: float, yaw: float) -> NDArray[np.float32]:
        """The next path points (5, 2), float32, 0.2 m apart along the path from distance `s` on, clamped to its end,
        in the frame of a robot at (x, y), metres, turned by `yaw`, radians: x forward, y left.
        """
        ahead = self.point_at(s + AHEAD_M) - (x, y)
        R_world_robot = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
        return cast("NDArray[np.float32]", (ahead @ R_world_robot).astype(np.float32))

    def cut(self, length_m: float) -> "Path":
        """The first `length_m` metres of the path."""
        return self.between(0.0, length_m)

    def between(self, start_m: float, end_m: float) -> "Path":
        """The metres `start_m` to `end_m` of the path, its goals among them; distances count from 0 at `start_m`."""
        inner = (self.arc_m > start_m + 1e-9) & (self.arc_m < end_m - 1e-9)
        goals_m = self.goals_m[(self.goals_m > start_m) & (self.goals_m < end_m)]
        return Path(np.vstack([self.point_at(start_m), self.xy[inner], self.point_at(end_m)]), goals_m - start_m)


def arc_length(xy: FloatArray) -> FloatArray:
    """Distances (P,) along a polyline (P, 2), from its first point."""
    return cast(FloatArray, np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(xy, axis=0), axis=1))]))


def resample(xy: FloatArray, spacing_m: float = SPACING_M) -> FloatArray:
    """The polyline (P, 2) with points at equal distances of about `spacing_m`, its ends kept."""
    arc_m = arc_length(xy)
    s = np.linspace(0.0, arc_m[-1], max(2, round(arc_m[-1] / spacing_m) + 1))
    resampled = np.stack([np.interp(s, arc_m, xy[:, axis]) for axis in (0, 1)], axis=-1)
    resampled[[0, -1]] = xy[[0, -1]]
    return resampled
