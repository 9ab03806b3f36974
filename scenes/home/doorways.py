"""Which rooms are joined by doorways, and where."""

from itertools import combinations

import numpy as np

from slamgym.scenes.home.floorplan import Cell, Doorway

_DOOR_TO_CORNER = 0.68  # centre of a doorway to the end of the shared wall

# How willingly one walks through a room to reach the next.
_PRIVACY = {
    "hall": 0,
    "living_room": 1,
    "kitchen": 2,
    "dining_room": 2,
    "study": 3,
    "bedroom": 4,
    "nursery": 4,
    "bathroom": 9,
}


def _shared_wall(a: Cell, b: Cell) -> tuple[str, float, float, float] | None:
    """Direction of the wall between two cells, position across, start and end; None where no doorway fits."""
    for along, across in (("x", "y"), ("y", "x")):
        low = max(getattr(a, f"{along}_min"), getattr(b, f"{along}_min"))
        high = min(getattr(a, f"{along}_max"), getattr(b, f"{along}_max"))
        for one, other in ((a, b), (b, a)):
            at = getattr(one, f"{across}_max")
            if at == getattr(other, f"{across}_min") and high - low >= 2 * _DOOR_TO_CORNER:
                return along, at, low, high
    return None


def choose_doorways(rng: np.random.Generator, cells: list[Cell], kinds: list[str]) -> tuple[Doorway, ...]:
    """A tree from the most public room, then doors that close loops between public rooms; () if it is impossible."""
    walls = {
        pair: w for pair in combinations(range(len(cells)), 2) if (w := _shared_wall(cells[pair[0]], cells[pair[1]]))
    }
    privacy = [_PRIVACY[kind] for kind in kinds]
    reached, chosen = {int(np.argmin(privacy))}, []
    while len(reached) < len(cells):
        edges = [pair for pair in walls if len(reached.intersection(pair)) == 1]
        via = {pair: min(privacy[i] for i in pair if i in reached) for pair in edges}
        # Halls first: rooms open onto all corridors, not onto the one that happened to be reached.
        best = min(edges, key=lambda pair: (via[pair], sum(privacy[i] for i in pair) > 0, pair), default=None)
        if best is None or via[best] >= _PRIVACY["bathroom"]:
            return ()
        chosen.append(best)
        reached.update(best)
    public = [pair for pair in walls if pair not in chosen and sum(privacy[i] for i in pair) <= 4]
    return tuple(_doorway(rng, pair, walls[pair], privacy) for pair in chosen + public[:2])


def _doorway(
    rng: np.random.Generator, pair: tuple[int, int], wall: tuple[str, float, float, float], privacy: list[int]
) -> Doorway:
    """Near one end of the shared wall; private rooms have a door, public ones often an open passage."""
    along, across, low, high = wall
    spot = low + _DOOR_TO_CORNER if rng.random() < 0.5 else high - _DOOR_TO_CORNER
    inner = max(pair, key=lambda i: privacy[i])
    open_share = {0: 1.0, 1: 0.8, 2: 0.6}.get(privacy[inner], 0.0)
    leaf_in = None if rng.random() < open_share else inner
    return Doorway(pair, (spot, across) if along == "x" else (across, spot), along, leaf_in)
