"""Occupancy grids as ROS's map_server keeps them: an image, and a YAML file that says where it lies.

The format: http://wiki.ros.org/map_server. The image's first row is the one of the largest y.
"""

from pathlib import Path
from typing import ClassVar, Literal, Self

import numpy as np
import yaml
from pydantic import ConfigDict, Field, field_validator, model_validator

from slamgym.checked_params import Params
from slamgym.errors import ConfigError, OutputError, SceneError
from slamgym.files import write_atomically
from slamgym.scenes.importing.data_root import DataRoot, read_plain
from slamgym.scenes.map_image import decode_grey, encode_pgm
from slamgym.scenes.occupancy import OccupancyGrid
from slamgym.scenes.rasterise import MAX_CELLS
from slamgym.types import BoolArray, FloatArray

FREE, OCCUPIED = 254, 0
MAX_YAML_BYTES = 4096
MAX_BRACKETS = 20
"""Of a YAML file, where the origin takes one: thousands of open ones take PyYAML seconds."""
MAX_ORIGIN_M = 1e6


class MapDescription(Params):
    """The YAML file. A pixel of darkness p, 0 white to 1 black, or the reverse with `negate`, is free when
    p < free_thresh, occupied when p > occupied_thresh, else unknown.
    """

    model_config = ConfigDict(extra="ignore")  # other programs keep keys of theirs there

    kind: ClassVar[str] = "key"

    image: str
    mode: Literal["trinary", "scale"] = "trinary"
    resolution: float = Field(ge=0.001, le=10)
    origin: tuple[float, float, float]
    negate: bool = False
    occupied_thresh: float = Field(0.65, ge=0, le=1)
    free_thresh: float = Field(0.196, ge=0, le=1)

    @field_validator("origin")
    @classmethod
    def _near_and_not_turned(cls, origin: tuple[float, float, float]) -> tuple[float, float, float]:
        x, y, yaw = origin
        if max(abs(x), abs(y)) > MAX_ORIGIN_M:
            raise ValueError(f"origin: expected metres, up to {MAX_ORIGIN_M:.0f}, got {x}, {y}; correct it")
        if yaw != 0:
            raise ValueError(f"origin: expected a map that is not turned, yaw 0, got yaw {yaw}; turn its image")
        return origin

    @model_validator(mode="after")
    def _free_is_brighter(self) -> Self:
        if self.free_thresh > self.occupied_thresh:
            raise ValueError(
                f"free_thresh: expected at most occupied_thresh, {self.occupied_thresh}, got {self.free_thresh}; "
                "lower it"
            )
        return self


def write_map(grid: OccupancyGrid, path: Path) -> Path:
    """Write `path`, which ends in .yaml, and the image beside it, of the same name but .pgm; return `path`.

    Free cells are 254, occupied ones 0; no cell is unknown. The image comes first: where the YAML file is, all is.
    Raises OutputError, also for a cell or an origin that `read_map` would refuse.
    """
    if path.suffix not in (".yaml", ".yml"):
        raise OutputError(f"expected a map's name to end in .yaml, got {str(path)!r}; rename it")
    x, y = (float(value) for value in grid.origin_xy)
    values = {"image": path.with_suffix(".pgm").name, "resolution": grid.resolution_m, "origin": (x, y, 0.0)}
    try:
        description = MapDescription.checked(values)
    except ConfigError as error:
        raise OutputError(f"cannot write map {path}: {error}") from None
    write_atomically(path.with_suffix(".pgm"), encode_pgm(np.where(grid.occupied, OCCUPIED, FREE)[::-1]))
    content = {**description.model_dump(mode="json"), "negate": int(description.negate)}
    return write_atomically(path, yaml.safe_dump(content, sort_keys=False, default_flow_style=None))


def read_map(path: Path) -> OccupancyGrid:
    """The grid of a map's YAML file, which names a PGM or PNG image in its own folder. What is unknown is occupied.

    Raises SceneError for a file that is missing, malformed or too large, and for an origin that is turned.
    """
    try:
        description = _description(read_plain(path))
        brightness = decode_grey(DataRoot(path.parent).read(description.image), MAX_CELLS)
    except (ConfigError, SceneError) as error:
        raise SceneError(f"map {path}: {error}") from None
    x, y, _ = description.origin
    return OccupancyGrid(_occupied(brightness, description), np.array([x, y]), description.resolution)


def _description(content: bytes) -> MapDescription:
    if len(content) > MAX_YAML_BYTES:
        raise SceneError(f"expected a YAML file of at most {MAX_YAML_BYTES} bytes, got {len(content)}")
    if (brackets := content.count(b"[") + content.count(b"{")) > MAX_BRACKETS:
        raise SceneError(f"expected YAML with at most {MAX_BRACKETS} opening brackets, got {brackets}; simplify it")
    try:
        # Nested references would unfold without end in the message that shows the value.
        if any(isinstance(token, yaml.AliasToken) for token in yaml.scan(content)):
            raise SceneError("expected YAML without references (*name), got some; write the values out")
        values = yaml.safe_load(content)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        why = " ".join(str(error).split())
        raise SceneError(f"expected YAML with image, resolution and origin, got: {why}") from None
    if not (isinstance(values, dict) and all(isinstance(key, str) for key in values)):
        raise SceneError(f"expected YAML with image, resolution and origin, got {str(values)[:60]!r}")
    return MapDescription.checked(values)


def _occupied(brightness: FloatArray, description: MapDescription) -> BoolArray:
    """Cells (ny, nx), lowest y first, that are not surely free; brightness (ny, nx) is NaN where nothing is known."""
    p = brightness if description.negate else 1 - brightness
    return ~(p < description.free_thresh)[::-1]
