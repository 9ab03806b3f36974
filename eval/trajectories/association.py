"""Which poses of two trajectories belong together, by time."""

import warnings
from collections.abc import Callable
from heapq import heapify, heappop, heappush

import numpy as np

from slamgym.errors import ConfigError, TrajectoryError, TrajectoryWarning, unknown_word
from slamgym.eval.trajectories.trajectory import Trajectory
from slamgym.types import BoolArray, IndexPair, IntArray

_NS_PER_S = 1_000_000_000


def associate(
    ref: Trajectory, est: Trajectory, max_difference_ns: int = 20_000_000, convention: str = "tum"
) -> IndexPair:
    """Indices into `ref` and `est`, int64 (M,) each, of the poses that belong together, as `match_stamps` finds them.

    Warns (TrajectoryWarning) when more than half of the estimate's poses are left without a partner. Raises
    TrajectoryError when nothing matches, ConfigError for an unknown convention or a negative bound.
    """
    pair = match_stamps(ref.stamps_ns, est.stamps_ns, max_difference_ns, convention)
    if not len(pair[0]):
        spans = " and ".join(_span(trajectory.stamps_ns) for trajectory in (ref, est))
        raise TrajectoryError(
            f"expected stamps within {max_difference_ns / _NS_PER_S:g} s of each other, got {spans}: "
            "are both from the same clock and sequence?"
        )
    _warn_if_few(pair[1], len(est), max_difference_ns)
    return pair


def match_stamps(
    ref_ns: IntArray, est_ns: IntArray, max_difference_ns: int = 20_000_000, convention: str = "tum"
) -> IndexPair:
    """Indices, int64 (M,) each, of the stamps that belong together, in the order of time; M may be 0.

    ref_ns, est_ns: int64 (N,), nanoseconds, strictly increasing.
    convention:
        "tum": pairs less than `max_difference_ns` apart, the closest first, each stamp at most once; of pairs equally
            close the earlier stamp of `ref`, then of `est`, comes first. As `associate.py` of the TUM RGB-D tools.
        "evo": for each stamp of the shorter list (`est`, if they are equally long) the nearest of the longer one, the
            earlier of two equally near, if it is at most `max_difference_ns` away; a stamp of the longer one may come
            up twice. As evo's `sync.associate_trajectories`.
    The two differ by a few pairs, and so do errors computed from them: compare only figures of one convention.

    Raises ConfigError for an unknown convention or a negative bound.
    """
    if convention not in _CONVENTIONS:
        raise ConfigError(unknown_word("association convention", convention, _CONVENTIONS))
    if not max_difference_ns >= 0:
        raise ConfigError(f"expected a bound on the difference of stamps of 0 ns or more, got {max_difference_ns} ns")
    return _CONVENTIONS[convention](ref_ns, est_ns, max_difference_ns)


def _warn_if_few(matched: IntArray, n: int, max_difference_ns: int) -> None:
    alone = n - len(np.unique(matched))
    if 2 * alone > n:
        warnings.warn(
            f"{alone} of the estimate's {n} poses have no partner within {max_difference_ns / _NS_PER_S:g} s in the "
            "reference and are not evaluated: do both cover the same time, at the same rate?",
            TrajectoryWarning,
            stacklevel=3,
        )


def _closest_first(ref_ns: IntArray, est_ns: IntArray, max_difference_ns: int) -> IndexPair:
    stamps_ns = np.concatenate([ref_ns, est_ns])
    merged = np.argsort(stamps_ns, kind="stable")
    taken = _take_closest(stamps_ns[merged], merged < len(ref_ns), max_difference_ns)
    pairs = np.sort(merged[taken], axis=1)  # all of `ref` comes before all of `est`
    pairs = pairs[np.argsort(pairs[:, 0])]
    return pairs[:, 0], pairs[:, 1] - len(ref_ns)


def _take_closest(time_ns: IntArray, is_ref: BoolArray, max_difference_ns: int) -> IntArray:
    """Pairs (M, 2) of places in the merged order of time, by always taking the closest pair that is left.

    The closest pair are neighbours: a pose between the two would be closer to one of them. So the heap holds neighbours
    only, and a pair that is taken makes the poses beside it neighbours.
    """
    n = len(time_ns)
    time, side = time_ns.tolist(), is_ref.tolist()
    before, after = [n, *range(n)], [*range(1, n + 1), 0]  # a ring that place n closes
    close = (is_ref[1:] != is_ref[:-1]) & (np.diff(time_ns) < max_difference_ns)
    heap = [(time[k + 1] - time[k], k, k + 1) for k in np.flatnonzero(close).tolist()]
    heapify(heap)
    taken = []
    while heap:
        _, left, right = heappop(heap)
        if after[left] != right:
            continue  # one of them was taken
        taken.append((left, right))
        outer_left, outer_right = before[left], after[right]
        after[outer_left], before[outer_right] = outer_right, outer_left
        after[left] = after[right] = -1
        if n not in (outer_left, outer_right) and side[outer_left] != side[outer_right]:
            difference = time[outer_right] - time[outer_left]
            if difference < max_difference_ns:
                heappush(heap, (difference, outer_left, outer_right))
    return np.array(taken, dtype=np.int64).reshape(-1, 2)


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
