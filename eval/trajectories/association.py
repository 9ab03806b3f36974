"""Which poses of two trajectories belong together, by time."""

from collections.abc import Callable

import numpy as np

from slamgym.errors import TrajectoryError, unknown_word
from slamgym.eval.trajectories.trajectory import Trajectory
from slamgym.types import IntArray

IndexPair = tuple[IntArray, IntArray]

_NS_PER_S = 1_000_000_000


def associate(ref: Trajectory, est: Trajectory, max_difference_ns: int, convention: str = "tum") -> IndexPair:
    """Indices into `ref` and `est` of the poses that belong together, in the order of time.

    convention: "tum" takes the pairs less than `max_difference_ns` apart, the closest first, each pose once (as
    `associate.py` of the TUM tools); "evo" takes for each pose of the shorter trajectory the nearest of the longer one
    when it is at most `max_difference_ns` away (as evo's `sync`), so a pose of the longer may come up twice.
    Raises TrajectoryError when nothing matches.
    """
    if convention not in _CONVENTIONS:
        raise TrajectoryError(unknown_word("association convention", convention, _CONVENTIONS))
    pair = _CONVENTIONS[convention](ref.stamps_ns, est.stamps_ns, max_difference_ns)
    if not len(pair[0]):
        spans = " and ".join(_span(trajectory.stamps_ns) for trajectory in (ref, est))
        raise TrajectoryError(
            f"expected stamps within {max_difference_ns / _NS_PER_S:g} s of each other, got {spans}: "
            "are both from the same clock and sequence?"
        )
    return pair


def _closest_first(ref_ns: IntArray, est_ns: IntArray, max_difference_ns: int) -> IndexPair:
    first = np.searchsorted(ref_ns, est_ns - max_difference_ns, side="right")
    counts = np.searchsorted(ref_ns, est_ns + max_difference_ns, side="left") - first
    counts = np.maximum(counts, 0)
    est = np.repeat(np.arange(len(est_ns)), counts)
    within = np.arange(len(est)) - np.repeat(np.cumsum(counts) - counts, counts)
    ref = np.repeat(first, counts) + within
    order = np.lexsort((est, ref, np.abs(ref_ns[ref] - est_ns[est])))
    partner: dict[int, int] = {}
    taken: set[int] = set()
    for i, j in zip(ref[order].tolist(), est[order].tolist(), strict=True):
        if i not in partner and j not in taken:
            partner[i] = j
            taken.add(j)
    pairs = np.array(sorted(partner.items()), dtype=np.int64).reshape(-1, 2)
    return pairs[:, 0], pairs[:, 1]


def _nearest_of_longer(ref_ns: IntArray, est_ns: IntArray, max_difference_ns: int) -> IndexPair:
    if len(est_ns) > len(ref_ns):
        return _nearest(ref_ns, est_ns, max_difference_ns)
    est, ref = _nearest(est_ns, ref_ns, max_difference_ns)
    return ref, est


def _nearest(short_ns: IntArray, long_ns: IntArray, max_difference_ns: int) -> IndexPair:
    if not len(long_ns):
        return np.empty(0, np.int64), np.empty(0, np.int64)
    after = np.clip(np.searchsorted(long_ns, short_ns, side="right"), 0, len(long_ns) - 1)
    before = np.maximum(after - 1, 0)
    nearest = np.where(np.abs(long_ns[after] - short_ns) < np.abs(short_ns - long_ns[before]), after, before)
    short = np.flatnonzero(np.abs(long_ns[nearest] - short_ns) <= max_difference_ns)
    return short, nearest[short]


_CONVENTIONS: dict[str, Callable[[IntArray, IntArray, int], IndexPair]] = {
    "tum": _closest_first,
    "evo": _nearest_of_longer,
}


def _span(stamps_ns: IntArray) -> str:
    if not len(stamps_ns):
        return "no pose"
    return f"{stamps_ns[0] / _NS_PER_S:.3f} to {stamps_ns[-1] / _NS_PER_S:.3f} s"
