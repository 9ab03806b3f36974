"""Dubins curves: the shortest ways from pose to pose that never turn tighter than a radius.

L. E. Dubins 1957; formulas from A. Shkel and V. Lumelsky, Classification of the Dubins set, 2001.
"""

from collections.abc import Iterator
from math import acos, atan2, ceil, cos, hypot, pi, sin, sqrt, tau

import numpy as np

from slamgym.types import FloatArray

Pose = tuple[float, float, float]
"""x and y in metres, heading in radians."""
Word = tuple[tuple[float, float], ...]
"""Three pieces: curvature (+1 left, 0, -1 right) and length, in units of the radius."""


def dubins_curves(start: Pose, goal: Pose, radius_m: float, spacing_m: float) -> list[FloatArray]:
    """Up to six curves from `start` to `goal`, shortest first, as points (P, 2) at most `spacing_m` metres apart."""
    dx, dy = goal[0] - start[0], goal[1] - start[1]
    distance, direction = hypot(dx, dy) / radius_m, atan2(dy, dx)
    alpha, beta = start[2] - direction, goal[2] - direction
    words = list(_left_words(distance, alpha, beta))
    # The words that begin with a right turn are those of the mirrored problem.
    words += [tuple((-turn, length) for turn, length in word) for word in _left_words(distance, -alpha, -beta)]
    words.sort(key=lambda word: sum(length for _, length in word))
    return [_trace(start, word, radius_m, spacing_m) for word in words]


def _left_words(d: float, alpha: float, beta: float) -> Iterator[Word]:
    """LSL, LSR and LRL from (0, 0, alpha) to (d, 0, beta), where they exist."""
    sa, sb, ca, cb = sin(alpha), sin(beta), cos(alpha), cos(beta)
    cos_ab = cos(alpha - beta)
    p2 = 2 + d * d - 2 * cos_ab + 2 * d * (sa - sb)
    if p2 >= 0:
        direction = atan2(cb - ca, d + sa - sb)
        yield (1, (direction - alpha) % tau), (0, sqrt(p2)), (1, (beta - direction) % tau)
    p2 = -2 + d * d + 2 * cos_ab + 2 * d * (sa + sb)
    if p2 >= 0:
        direction = atan2(-ca - cb, d + sa + sb) - atan2(-2.0, sqrt(p2))
        yield (1, (direction - alpha) % tau), (0, sqrt(p2)), (-1, (direction - beta) % tau)
    cos_p = (6 - d * d + 2 * cos_ab + 2 * d * (sb - sa)) / 8
    if abs(cos_p) <= 1:
        middle = 2 * pi - acos(cos_p)
        first = (-alpha + atan2(cb - ca, d + sa - sb) + middle / 2) % tau
        yield (1, first), (-1, middle), (1, (beta - alpha - first + middle) % tau)


def _trace(start: Pose, word: Word, radius_m: float, spacing_m: float) -> FloatArray:
    """Points (P, 2) along a word driven from `start`."""
    x, y, heading = start
    points = [np.array([[x, y]])]
    for turn, length in word:
        along = np.linspace(0.0, length, max(1, ceil(length * radius_m / spacing_m)) + 1)[1:] * radius_m
        curvature = turn / radius_m
        # A chord of an arc points half the turned angle away from where it began.
        chord = along * np.sinc(curvature * along / tau)
        direction = heading + curvature * along / 2
        points.append(np.stack([x + chord * np.cos(direction), y + chord * np.sin(direction)], axis=1))
        (x, y), heading = points[-1][-1], heading + turn * length
    return np.concatenate(points)
