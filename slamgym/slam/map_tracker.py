"""Which map an ORB-SLAM3 frame belongs to, and what happened to the maps. No interface tells, so it is inferred.

From the state after each frame (`Tracking::Track` of ORB-SLAM3 1.0, checked by experiment):

- OK -> RECENTLY_LOST -> OK within about 3 s: found again in the same map.
- NO_IMAGES_YET after the first initialisation: the lost map was stored, the next OK frame starts a new one at identity.
- LOST: the lost map has so few keyframes that it is thrown away; the next OK frame starts a new one at identity.

From what it prints: "Creation of new map with id: A", and, when a place of a stored map is recognised and the active
map is merged into that one, "Change to map with id: B"; "*Loop detected" when a loop is closed. That happens in a
thread of its own between frames, so the next frame reports it; unless fed in lock-step, it may be one frame late.
"""

import re
from dataclasses import dataclass, field

import numpy as np

from slamgym.types import SlamEvent, SlamTrajectory, TrackingState

_PRINTED = re.compile(
    r"Creation of new map with id: (?P<new>\d+)|Change to map with id: (?P<merged>\d+)|\*(?P<loop>Loop)"
)


@dataclass(slots=True)
class MapTracker:
    """Follows one run. `map_id` counts maps from 0 in the order of their first frames and is -1 without a map."""

    map_id: int = -1
    thrown_away: set[int] = field(default_factory=set)
    """Ids of maps that the SLAM no longer has."""
    _maps: int = 0
    _was_ok: bool = False
    _start: SlamEvent = SlamEvent.INITIALIZED
    _pending: SlamEvent = SlamEvent.NONE
    _atlas_id: int = 0
    _by_atlas_id: dict[int, int] = field(default_factory=dict)

    def read(self, printed: str) -> None:
        """Take in what was printed since the last call; call it before each `update`."""
        for line in _PRINTED.finditer(printed):
            if line["new"]:
                self._atlas_id = int(line["new"])
            elif line["merged"]:
                # The merged map keeps the origin of the stored one, but takes the id of the active one. If the stored
                # one is unknown, the next frame counts as the first of a new map: poses must not be mixed.
                self.map_id = self._by_atlas_id[self._atlas_id] = self._by_atlas_id.pop(int(line["merged"]), -1)
                self._pending = SlamEvent.MAPS_MERGED
            else:
                self._pending = SlamEvent.LOOP_CLOSED

    def update(self, state: str) -> tuple[TrackingState, SlamEvent]:
        """State and event of a frame after which ORB-SLAM3's own state is `state`."""
        was_ok, self._was_ok = self._was_ok, state in ("OK", "OK_KLT")
        if self._was_ok:
            return TrackingState.OK, self._event_when_ok(was_ok)
        if self._maps == 0:
            return TrackingState.NOT_INITIALIZED, SlamEvent.NONE
        if state in ("NO_IMAGES_YET", "LOST") and self.map_id >= 0:
            self._drop_map(state)
        return TrackingState.LOST, SlamEvent.LOST if was_ok else SlamEvent.NONE

    def _event_when_ok(self, was_ok: bool) -> SlamEvent:
        if self.map_id < 0:
            self.map_id = self._by_atlas_id[self._atlas_id] = self._maps
            self._maps += 1
            return self._start
        if not was_ok:
            return SlamEvent.RELOCALIZED
        event, self._pending = self._pending, SlamEvent.NONE
        return event

    def _drop_map(self, state: str) -> None:
        if state == "LOST":
            self.thrown_away.add(self.map_id)
        self._start = SlamEvent.MAP_RESET if state == "LOST" else SlamEvent.NEW_MAP
        self.map_id = -1


def final_trajectory(online: SlamTrajectory, saved: SlamTrajectory, thrown_away: set[int]) -> SlamTrajectory:
    """What ORB-SLAM3 stands by at the end.

    online: the frames whose state was OK, as they were emitted. saved: the frames of its biggest map, merged ones
    included, after loop closing and bundle adjustment; it also holds frames with guessed poses, and some twice. The
    online frames among them get their saved poses and one common id. Frames of other maps keep their poses and ids;
    those of maps that were thrown away are left out.
    """
    stamps_ns, first = np.unique(saved.stamps_ns, return_index=True)
    in_biggest = np.isin(online.stamps_ns, stamps_ns)
    merged_ids = online.map_id[in_biggest]
    in_other = ~np.isin(online.map_id, [*merged_ids, *thrown_away])
    T_map_cam, map_id = online.T_map_cam.copy(), online.map_id.copy()
    if in_biggest.any():
        row = first[np.searchsorted(stamps_ns, online.stamps_ns[in_biggest])]
        T_map_cam[in_biggest] = saved.T_map_cam[row]
        map_id[in_biggest] = np.bincount(merged_ids).argmax()
    keep = in_biggest | in_other
    return SlamTrajectory(online.stamps_ns[keep], T_map_cam[keep], map_id[keep])
