"""Scene options that loaders of meshes share."""

from typing import Annotated, Literal

from pydantic import Field

from slamgym.scenes.loader import SceneOptions


class PlacedOptions(SceneOptions):
    """How a mesh lies in the world; each is told by the geometry unless given.

    up: the axis of the file that points up. unit: metres of one unit of the file. floor: height of the floor, metres.
    """

    up: Literal["auto", "x", "y", "z"] = "auto"
    unit: Literal["auto"] | Annotated[float, Field(gt=0.0)] = "auto"
    floor: Literal["auto"] | float = "auto"
