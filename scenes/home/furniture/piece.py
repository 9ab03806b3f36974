"""A piece of furniture: components of several finishes that stand, move and collide together."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from slamgym.scenes.home import solids
from slamgym.scenes.home.palette import Finish
from slamgym.scenes.home.solids import Mesh
from slamgym.scenes.house import Part
from slamgym.types import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Component:
    """One mesh of one finish. glow: shines by itself, so its light is given and not baked."""

    name: str
    finish: Finish
    mesh: Mesh
    solid: bool = True
    glow: bool = False


@dataclass(frozen=True, slots=True)
class Top:
    """A level rectangle on which smaller things can stand, in the piece's frame, metres."""

    x: tuple[float, float]
    y: tuple[float, float]
    z: float


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """Components in one frame. front: metres in front of it that people need to use it, kept free of furniture."""

    kind: str
    components: tuple[Component, ...]
    tops: tuple[Top, ...] = ()
    front: float = 0.0

    @property
    def bounds(self) -> FloatArray:
        """Axis-aligned bounding box (2, 3): low corner, high corner."""
        vertices = np.concatenate([c.mesh.vertices for c in self.components])
        return np.stack([vertices.min(axis=0), vertices.max(axis=0)])

    def placed(self, yaw: float, at: ArrayLike) -> "Piece":
        """The piece turned by `yaw` and moved; its tops stay in the old frame and are dropped."""
        components = tuple(
            Component(c.name, c.finish, solids.placed(c.mesh, yaw, at), c.solid, c.glow) for c in self.components
        )
        return Piece(self.kind, components)

    def parts(self, name: str) -> Iterator[Part]:
        """The piece as parts of a house, named `name`/component."""
        for c in self.components:
            yield Part(
                name=f"{name}/{c.name}",
                material=c.finish.material,
                vertices=c.mesh.vertices.astype(np.float32),
                faces=c.mesh.faces.astype(np.int32),
                uv=None
                if c.finish.material.texture is None
                else (c.mesh.uv / (c.finish.tile or 1.0)).astype(np.float32),
                light=np.ones(c.mesh.vertices.shape, dtype=np.float32) if c.glow else None,
                solid=c.solid,
            )
