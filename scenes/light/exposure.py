"""From light to factors that materials are multiplied with: exposed as a camera in the house would."""

from typing import NamedTuple

import numpy as np

from slamgym.scenes.light.illumination import GAMMA, Illumination
from slamgym.scenes.light.rays import sphere
from slamgym.types import FloatArray, IntArray

GREY = 0.5
"""Mean of the images, of 1."""
BRIGHTEST_MEDIAN = 0.95
"""Factors' median in dark houses, which stay darker than grey."""
DARKEST, BRIGHTEST = 0.05, 1.2
CODING = 1 / 1.5
"""Exponent between light and image: that of sRGB would be 1 / 2.2, but cameras render with more contrast."""
BALANCE = 0.7
"""How far the light's mean colour is turned to white, as cameras do."""
LOOKS = 128
LEVEL = 0.8
"""Cameras look about level: up and down no further than this, of 1."""
VIEWS = 200


class Exposure(NamedTuple):
    """gain: (3,) of the light, before highlights are rolled off and the result is coded as in images."""

    gain: FloatArray

    def __call__(self, light: FloatArray) -> FloatArray:
        """Factors (V, 3) in [DARKEST, BRIGHTEST] of light (V, 3)."""
        rolled = 1.0 - np.exp(-self.gain * np.maximum(light, 0.0))
        factors: FloatArray = np.maximum(BRIGHTEST * rolled**CODING, DARKEST)
        return factors


def exposure_of(room: Illumination, light: FloatArray, places: FloatArray) -> Exposure:
    """The exposure that makes what is seen from the places (P, 3) grey in the mean. light: (V, 3) of the surface."""
    faces = _seen_faces(room, places)
    arriving = light[room.surface.faces[faces]].mean(axis=1)
    colour = room.reflected[faces] ** (1.0 / GAMMA)
    mean = np.maximum(arriving.mean(axis=0), 1e-6)
    balance = (mean.mean() / mean) ** BALANCE
    low, high = -12.0, 12.0
    for _ in range(40):
        middle = (low + high) / 2.0
        factors = Exposure(2.0**middle * balance)(arriving)
        bright = (factors * colour).mean() > GREY or np.median(factors) > BRIGHTEST_MEDIAN
        low, high = (low, middle) if bright else (middle, high)
    return Exposure(2.0**low * balance)


def _seen_faces(room: Illumination, places: FloatArray) -> IntArray:
    """Faces of the surface that rays from the places meet, one for each ray; all faces where there are no places."""
    looks = sphere(LOOKS)
    looks = looks[np.abs(looks[:, 2]) < LEVEL]
    places = places[:: max(1, len(places) // VIEWS)]
    hits = room.rays.first_hits(np.repeat(places, len(looks), axis=0), np.tile(looks, (len(places), 1)))
    matt = hits.face[(hits.face >= 0) & (hits.face < len(room.surface.faces))]
    return matt if len(matt) else np.arange(len(room.surface.faces))
