"""Which axis of a mesh points up."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from slamgym.scenes.importing.levels import Storey
from slamgym.types import FloatArray

SURE = 1.25
"""How much better than the format's another axis must look."""
LYING = 2.5
"""How much longer than a house of one storey is high it is along its floor, at least."""
DEEP = 1.5
"""By the height of a storey, the depth of rooms in even rows, which are no storeys."""
ROOM_M = (2.0, 4.5)
"""How high a storey is when an axis may be up."""
NARROWEST_M = 1.2
"""A scene's least width in a unit that is not the metre; inches taken for centimetres give less."""
LOW = 0.5
"""Height of a storey by what lies below it, below which its floor may be a ceiling."""
USUAL_STOREY_M = 2.7


class Units(NamedTuple):
    """Metres of the units in which a file may be: the usual ones, which is one when it is known, and all others."""

    usual: list[float]
    others: Sequence[float] = ()


def room_height(storey: Storey | None) -> float:
    """Height of the storey, or of what is below when its floor is rather a ceiling; 0 when there is none."""
    if storey is None:
        return 0.0
    return storey.below if storey.height < LOW * storey.below else storey.height


def seen_up(storeys: Sequence[Storey | None], extents: FloatArray, own: int, units: Units) -> int:
    """The axis, 0 to 2, that is up by the lowest storeys and the scene's extents (3,), both by axis.

    It is the format's, `own`, while a storey is as high as a room then and no other axis is clearly better; else the
    one with which a storey is most as high as a room; when it is with none, the one along which the scene is flat and
    whose floor fills the rectangle around the scene.
    """
    fitting = [_misfit(storeys[k], extents, k, units.usual) for k in range(3)]
    misfits = [fitting[k] if k == own or _rivals(storeys[k], storeys[own]) else np.inf for k in range(3)]
    best = int(np.argmin(misfits))
    possible = [k for k in range(3) if np.isfinite(fitting[k]) or not np.isfinite(fitting[own])]
    if lying := [k for k in possible if _lies(storeys, extents, own, k)]:
        return min(lying, key=lambda k: float(extents[k]))
    if np.isfinite(misfits[own]):
        return own if len(units.usual) == 1 or misfits[own] - misfits[best] <= np.log(SURE) else best
    if np.isfinite(misfits[best]):
        return best
    if np.isfinite(_misfit(storeys[own], extents, own, units.others)):
        return own
    coverage = np.array([storey.ground if storey else 0.0 for storey in storeys])
    scores = coverage / np.maximum(extents, 1e-12)
    return int(scores.argmax()) if scores.max() > SURE * scores[own] else own


def _rivals(storey: Storey | None, own: Storey | None) -> bool:
    """Whether the storey is lower than that of the format's axis, so that a low cellar stands as it is."""
    return storey is not None and (own is None or room_height(storey) < room_height(own))


def _misfit(storey: Storey | None, extents: FloatArray, up: int, units: Sequence[float]) -> float:
    """How far a storey is from the usual height, in the best of some units, metres; infinite when it is no room's."""
    narrowest = float(np.delete(extents, up).min())
    rooms = [
        room_height(storey) * unit
        for unit in units
        if ROOM_M[0] <= room_height(storey) * unit <= ROOM_M[1] and (unit == 1.0 or narrowest * unit >= NARROWEST_M)
    ]
    return min((abs(float(np.log(room / USUAL_STOREY_M))) for room in rooms), default=np.inf)


def _lies(storeys: Sequence[Storey | None], extents: FloatArray, own: int, other: int) -> bool:
    """Whether it is a house of one storey with `other` up, whose walls make odd storeys with `own` up."""
    upright, lying = storeys[other], storeys[own]
    if upright is None or lying is None or extents[other] > SURE * room_height(upright):
        return False
    stacked = lying.even and room_height(lying) < DEEP * room_height(upright)
    return not stacked and bool(extents[own] > LYING * extents[other])
