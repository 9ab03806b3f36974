"""Rooms and lamps of a house.json."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from trimesh.transformations import transform_points

from slamgym.scenes.extras import FARTHEST_M, is_usable
from slamgym.scenes.house import Lamp, Part, Room
from slamgym.scenes.suncg.categories import LAMPS
from slamgym.scenes.suncg.house_file import Node
from slamgym.scenes.suncg.placing import group_of
from slamgym.types import FloatArray

Groups = Mapping[str, Sequence[Part]]
"""Parts in the world by what they belong to, see `group_of`."""


def rooms_of(nodes: Sequence[Node], T_world_scene: FloatArray, groups: Groups, defects: list[str]) -> Iterator[Room]:
    """The box of each Room, or else that of its floor; defects: gets a line for one that has neither."""
    for node in nodes:
        if node.type == "Room":
            floor = groups.get(group_of("floor", node), ())
            corners = np.concatenate([np.zeros((0, 3), np.float32), *(part.vertices for part in floor)])
            if node.bbox is not None:
                corners = transform_points([node.bbox.low, node.bbox.high], T_world_scene)
            if len(corners) == 0:
                defects.append(f"node {node.id}: bbox: expected the room's box, got none; it counts as no room")
                continue
            (x_min, y_min, _), (x_max, y_max, _) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
            kind = ", ".join(node.room_types).lower() or "room"
            room = Room(node.model or f"room {node.id}", kind, x_min, y_min, x_max, y_max)
            if is_usable(room):
                yield room
            else:
                got = f"{x_min:.3g} to {x_max:.3g} and {y_min:.3g} to {y_max:.3g} m"
                defects.append(
                    f"node {node.id}: bbox: expected sides, at most {FARTHEST_M:g} m from the origin, got {got}; it "
                    "counts as no room"
                )


def lamps_of(nodes: Sequence[Node], categories: Mapping[str, str], groups: Groups) -> Iterator[Lamp]:
    """A lamp in each model of a category that gives light."""
    for node in nodes:
        parts = groups.get(group_of(node.model, node), ())
        share = LAMPS.get(categories.get(node.model, ""))
        if node.type == "Object" and parts and share is not None:
            corners = np.concatenate([part.vertices for part in parts]).astype(np.float64)
            low, high = corners.min(axis=0), corners.max(axis=0)
            x, y, z = (low + (high - low) * (0.5, 0.5, share)).tolist()
            yield Lamp((x, y, z))
