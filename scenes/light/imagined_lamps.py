"""Lamps for a house that came without any light: where a ceiling would be, so that each place sees one nearby."""

import numpy as np

from slamgym.scenes.house import Lamp
from slamgym.scenes.light.rays import Rays
from slamgym.types import BoolArray, FloatArray

REACH_M = 4.0
HIGHEST_M = 2.4
BELOW_CEILING_M = 0.35
MOST = 40
CLEAR_M, LEAST_CLEAR_M = 1.5, 0.8
"""A lamp's distance from walls: so much is best, and least."""


def imagined_lamps(places: FloatArray, rays: Rays) -> tuple[Lamp, ...]:
    """Lamps above some of the places (P, 3) where a camera could be, the first ones in the middle of open space."""
    high = places[places[:, 2] == places[:, 2].max(initial=-np.inf)]
    up = np.tile([0.0, 0.0, 1.0], (len(high), 1))
    room_above = rays.first_hits(high, up).distance - BELOW_CEILING_M
    spots = high + up * np.clip(room_above, 0.0, np.maximum(HIGHEST_M - high[:, 2:], 0.0).ravel())[:, None]
    lamps: list[Lamp] = []
    dark = np.ones(len(spots), dtype=bool)
    clear = _clearance(spots, rays)
    worth = np.array([_seen(spot, spots, rays).sum() for spot in spots]) * np.minimum(clear, CLEAR_M)
    worth[clear < LEAST_CLEAR_M] = 0.0
    while len(lamps) < MOST and (dark & (worth > 0.0)).any():
        best = int(np.argmax(np.where(dark, worth, 0.0)))
        lamps.append(Lamp((float(spots[best, 0]), float(spots[best, 1]), float(spots[best, 2]))))
        dark &= ~_seen(spots[best], spots, rays)
        dark[best] = False
    return tuple(lamps)


def _clearance(spots: FloatArray, rays: Rays) -> FloatArray:
    """Free distance (P,) around the spots (P, 3), in the directions of the compass."""
    angle = np.arange(8) * np.pi / 4.0
    looks = np.tile(np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1), (len(spots), 1))
    around = rays.first_hits(np.repeat(spots, 8, axis=0), looks).distance.reshape(-1, 8)
    nearest: FloatArray = around.min(axis=1)
    return nearest


def _seen(spot: FloatArray, spots: FloatArray, rays: Rays) -> BoolArray:
    """Which of the spots (P, 3) are near and in view, (P,)."""
    away = spots - spot
    distance: FloatArray = np.linalg.norm(away, axis=1)
    towards = away / np.maximum(distance, 1e-9)[:, None]
    return ~rays.blocked(np.broadcast_to(spot, away.shape), towards, distance) & (distance < REACH_M)
