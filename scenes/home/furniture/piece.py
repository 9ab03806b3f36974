"""A piece of furniture: components of several finishes that stand, move and collide together."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from slamgym.scenes.home import solids
from slamgym.scenes.home.palette import Finish, Palette
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
    bounds: FloatArray = field(init=False)
    """Axis-aligned bounding box (2, 3): low corner, high corner."""

    def __post_init__(self) -> None:
        vertices = np.concatenate([c.mesh.vertices for c in self.components])
        object.__setattr__(self, "bounds", np.stack([vertices.min(axis=0), vertices.max(axis=0)]))

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


Maker = Callable[[Palette, np.random.Generator], Piece]
"""Designs a piece in the materials of a house."""
Made = Callable[[Maker, Palette, np.random.Generator], Piece]
"""Gives the piece that stands where a maker's would: the maker's own, or another of its kind and about its size."""


def made_by_code(maker: Maker, palette: Palette, rng: np.random.Generator) -> Piece:
    """The maker's own piece."""
    return maker(palette, rng)
