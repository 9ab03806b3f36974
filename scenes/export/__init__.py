"""Houses written to files that other programs read, and slamgym's own loaders too."""

from slamgym.scenes.export.glb import write_glb
from slamgym.scenes.export.suncg import write_suncg

__all__ = ["write_glb", "write_suncg"]
