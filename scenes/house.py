"""What a scene is, whatever file or generator it came from: triangles with materials, rooms and lamps.

World frame: right-handed, z up, metres; the floor that the robot drives on is at z = 0.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Material:
    """How a surface looks. colour: factors in [0, 1]. texture: uint8 (H, W, 3), sRGB, repeated over uv, or None."""

    name: str
    colour: tuple[float, float, float] = (1.0, 1.0, 1.0)
    texture: NDArray[np.uint8] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A triangle mesh of one material, in world coordinates.

    vertices: float32 (V, 3). faces: int32 (F, 3), counter-clockwise seen from outside. uv: float32 (V, 2), (0, 0) at
    the texture's lower left, or None without texture. light: float32 (V, 3) factors that lighting multiplies the
    material with, or None before it is baked. colour: float32 (V, 3) factors in [0, 1] of the material, or None.
    solid: whether a robot bumps into it.
    """

    name: str
    material: Material
    vertices: NDArray[np.float32]
    faces: NDArray[np.int32]
    uv: NDArray[np.float32] | None = None
    light: NDArray[np.float32] | None = None
    colour: NDArray[np.float32] | None = None
    solid: bool = True


@dataclass(frozen=True, slots=True)
class Room:
    """An axis-aligned room: inner bounds on the floor, metres."""

    name: str
    kind: str
    x_min: float
    y_min: float
    x_max: float
    y_max: float


@dataclass(frozen=True, slots=True)
class Lamp:
    """A light of radius `radius` metres at `position`; intensity 1 lights a wall 2 m away well."""

    position: tuple[float, float, float]
    intensity: float = 1.0
    colour: tuple[float, float, float] = (1.0, 0.93, 0.82)
    radius: float = 0.12


@dataclass(frozen=True, slots=True)
class Window:
    """A rectangle that daylight comes in through: its centre and half sides, metres, world frame.

    Light comes in along half_u x half_v. intensity 1 is that of an overcast sky on a clear pane.
    """

    centre: tuple[float, float, float]
    half_u: tuple[float, float, float]
    half_v: tuple[float, float, float]
    intensity: float = 1.0
    colour: tuple[float, float, float] = (0.93, 0.97, 1.0)


@dataclass(frozen=True, slots=True, eq=False)
class House:
    """A scene: `parts` in world coordinates; names of parts of one piece of furniture share the text before '/'.

    assumptions: what was taken for granted when it was read, such as "up axis: y, as glTF has it". defects: what was
    repaired or left out, each naming file and node. One line each.
    """

    name: str
    parts: tuple[Part, ...]
    rooms: tuple[Room, ...] = ()
    lamps: tuple[Lamp, ...] = ()
    windows: tuple[Window, ...] = ()
    assumptions: tuple[str, ...] = ()
    defects: tuple[str, ...] = ()
