"""Light baked into a house's vertices with Embree, so that a frame costs no lighting."""

from slamgym.scenes.light.bake import bake_light
from slamgym.scenes.light.cache import baked

__all__ = ["bake_light", "baked"]
