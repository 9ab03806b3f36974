"""A house at a glance: views along a path, the plan, figures, and what was assumed when it was loaded.

contact_sheet.png  views along a path, numbered as in the plan
plan.png           rooms, occupancy grid and path, from above
map.pgm, map.yaml  the occupancy grid, as ROS's map_server has it
scene.json         the figures, assumptions and defects
house.glb, suncg/  the house in other formats, where asked for
"""

import json
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from slamgym.agents.path import Path
from slamgym.agents.planner import plan_path
from slamgym.errors import ConfigError, unknown_word
from slamgym.eval.plots import plot_floor_plan
from slamgym.eval.plots.contact_sheet import Image, contact_sheet
from slamgym.eval.views import brightness, keypoint_count
from slamgym.files import check_free, draft
from slamgym.geometry import mast_camera_pose
from slamgym.params import DriveParams
from slamgym.render import Renderer
from slamgym.scenes.export import write_glb, write_suncg
from slamgym.scenes.house import Room
from slamgym.scenes.map_server import write_map
from slamgym.stage import Stage, load_stage

VIEWS = 12

EXPORTS: dict[str, Callable[[Stage, FilePath], object]] = {
    "glb": lambda stage, folder: write_glb(stage.house, folder / "house.glb"),
    # It has no place for light, and baking adds vertices for it.
    "suncg": lambda stage, folder: write_suncg(stage.unlit, folder / "suncg"),
}
"""Format -> what writes a stage's house in it into a folder."""


@dataclass(frozen=True, slots=True, eq=False)
class SceneReport:
    """views: colour images (H, W, 3) along the path, at the distances `views_m`, metres. figures: as in scene.json."""

    stage: Stage
    path: Path
    views: tuple[Image, ...]
    views_m: tuple[float, ...]
    figures: dict[str, Any]


def inspect_scene(
    params: DriveParams, seed: int = 0, on_progress: Callable[[float], None] | None = None
) -> SceneReport:
    """Look around in the scene of the parameters, along the path that `seed` picks, as a drive would see it.

    on_progress: called with the share of the light that is baked. Raises SceneError, ConfigError and RenderError.
    """
    stage = load_stage(params, on_progress)
    path = plan_path(stage.grid, stage.free, params.path_length_m, np.random.default_rng(seed))
    views_m = tuple(np.linspace(0.0, path.length_m, VIEWS, endpoint=False).tolist())
    with Renderer(stage.house, params.camera, params.lighting, params.brightness, params.multisampling) as renderer:
        frames = [renderer.render(_camera_pose(path, s, params.camera_height)) for s in views_m]
    views = tuple(colour for colour, _ in frames)
    open_share = float(np.mean([depth == 0.0 for _, depth in frames]))
    return SceneReport(stage, path, views, views_m, _figures(stage, path, views, open_share))


def check_exports(names: Collection[str]) -> None:
    """Raise ConfigError for a format that the house cannot be written in. To be asked before minutes of work."""
    for name in names:
        if name not in EXPORTS:
            raise ConfigError(unknown_word("export", name, EXPORTS))


def write_report(report: SceneReport, folder: FilePath, exports: Collection[str] = ()) -> FilePath:
    """Write the report's files to a new folder, all or none, and return it.

    exports: of EXPORTS, the formats to write the house in, too. Raises ConfigError for another, OutputError, and
    SceneError for a house that cannot be written.
    """
    check_exports(exports)
    check_free(folder, "folder")
    with draft(folder) as place:
        place.mkdir()
        _write_png(place / "contact_sheet.png", contact_sheet(report.views))
        stage, path = report.stage, report.path
        views_xy = path.point_at(np.array(report.views_m))
        figure = plot_floor_plan(stage.grid, stage.free, stage.house.rooms, path.xy, views_xy)
        figure.savefig(place / "plan.png", format="png")
        write_map(stage.grid, place / "map.yaml")
        (place / "scene.json").write_text(json.dumps(report.figures, indent=2) + "\n")
        for name in dict.fromkeys(exports):
            EXPORTS[name](stage, place)
    return folder


def _camera_pose(path: Path, s: float, camera_height: float) -> NDArray[np.float64]:
    """T_world_cam (4, 4) at distance `s` along the path, in its direction."""
    x, y = path.point_at(s).tolist()
    return mast_camera_pose(x, y, path.heading_at(s), camera_height)


def _figures(stage: Stage, path: Path, views: Sequence[Image], open_share: float) -> dict[str, Any]:
    """open_share: of the views' pixels, where nothing is; they are black.

    Of the areas, rooms_m2 is that within the rooms' bounds, None where no rooms are known, unobstructed_m2 that of the
    grid's cells that nothing stands on, free_m2 that of those where the robot's centre can be.
    """
    house, cell_m2 = stage.house, stage.grid.resolution_m**2
    grey = [np.asarray(cv2.cvtColor(view, cv2.COLOR_RGB2GRAY), dtype=np.uint8) for view in views]
    textures = {id(t): t for part in house.parts if (t := part.material.texture) is not None}
    keypoints = [keypoint_count(image) for image in grey]
    return {
        "scene": house.name,
        "rooms": [room.name for room in house.rooms],
        "rooms_m2": round(sum(_area_m2(room) for room in house.rooms), 2) if house.rooms else None,
        "unobstructed_m2": round(float(np.count_nonzero(~stage.grid.occupied)) * cell_m2, 2),
        "free_m2": round(float(np.count_nonzero(stage.free)) * cell_m2, 2),
        "parts": len(house.parts),
        "triangles": sum(len(part.faces) for part in house.parts),
        "textures": len(textures),
        "texture_megapixels": round(sum(t.shape[0] * t.shape[1] for t in textures.values()) / 1e6, 1),
        "lamps": len(house.lamps),
        "windows": len(house.windows),
        "path_m": round(path.length_m, 2),
        "open_share": round(open_share, 4),
        "keypoints_a_view": keypoints,
        "brightness_a_view": [round(brightness(image), 1) for image in grey],
        "assumptions": list(house.assumptions),
        "defects": list(house.defects),
    }


def _area_m2(room: Room) -> float:
    return (room.x_max - room.x_min) * (room.y_max - room.y_min)


def _write_png(path: FilePath, image: Image) -> None:
    # Encoded in memory: OpenCV would not say why a file cannot be written.
    path.write_bytes(cv2.imencode(".png", cv2.cvtColor(image, cv2.COLOR_RGB2BGR))[1].tobytes())
