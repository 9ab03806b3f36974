"""A house at a glance: views along a path, the plan, figures, and what was assumed when it was loaded.

contact_sheet.png  views along a path, numbered as in the plan
plan.png           rooms, occupancy grid and path, from above
map.pgm, map.yaml  the occupancy grid, as ROS's map_server has it
scene.json         the figures, assumptions and defects
"""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from slamgym.agents.path import Path
from slamgym.agents.planner import plan_path
from slamgym.errors import OutputError
from slamgym.eval.plots import plot_floor_plan
from slamgym.eval.views import brightness, keypoint_count
from slamgym.files import check_free, draft
from slamgym.geometry import mast_camera_pose
from slamgym.params import DriveParams
from slamgym.render import Renderer
from slamgym.scenes.map_server import write_map
from slamgym.stage import Stage, load_stage

VIEWS = 12
COLUMNS = 4
VIEW_WIDTH = 480
"""Pixels of a view on the contact sheet."""

Image = NDArray[np.uint8]


@dataclass(frozen=True, slots=True, eq=False)
class SceneReport:
    """views: colour images (H, W, 3) along the path, at the distances `views_m`. figures: the content of scene.json."""

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
        views = tuple(renderer.render(_camera_pose(path, s, params.camera_height))[0] for s in views_m)
    return SceneReport(stage, path, views, views_m, _figures(stage, path, views))


def write_report(report: SceneReport, folder: FilePath) -> FilePath:
    """Write the report's files to a new folder, all or none, and return it; raises OutputError."""
    check_free(folder, "folder")
    with draft(folder) as place:
        place.mkdir()
        _write_png(place / "contact_sheet.png", _contact_sheet(report.views))
        stage, path = report.stage, report.path
        views_xy = path.point_at(np.array(report.views_m))
        figure = plot_floor_plan(stage.grid, stage.free, stage.house.rooms, path.xy, views_xy)
        figure.savefig(place / "plan.png", format="png")
        write_map(stage.grid, place / "map.yaml")
        (place / "scene.json").write_text(json.dumps(report.figures, indent=2) + "\n")
    return folder


def _camera_pose(path: Path, s: float, camera_height: float) -> NDArray[np.float64]:
    x, y = path.point_at(s).tolist()
    return mast_camera_pose(x, y, path.heading_at(s), camera_height)


def _figures(stage: Stage, path: Path, views: Sequence[Image]) -> dict[str, Any]:
    house, cell_m2 = stage.house, stage.grid.resolution_m**2
    grey = [np.asarray(cv2.cvtColor(view, cv2.COLOR_RGB2GRAY), dtype=np.uint8) for view in views]
    textures = {id(t): t for part in house.parts if (t := part.material.texture) is not None}
    keypoints = [keypoint_count(image) for image in grey]
    return {
        "scene": house.name,
        "rooms": [room.name for room in house.rooms],
        "floor_m2": round(float(np.count_nonzero(~stage.grid.occupied)) * cell_m2, 2),
        "free_m2": round(float(np.count_nonzero(stage.free)) * cell_m2, 2),
        "parts": len(house.parts),
        "triangles": sum(len(part.faces) for part in house.parts),
        "textures": len(textures),
        "texture_megapixels": round(sum(t.shape[0] * t.shape[1] for t in textures.values()) / 1e6, 1),
        "lamps": len(house.lamps),
        "windows": len(house.windows),
        "path_m": round(path.length_m, 2),
        "keypoints_a_view": keypoints,
        "brightness_a_view": [round(brightness(image), 1) for image in grey],
        "assumptions": list(house.assumptions),
        "defects": list(house.defects),
    }


def _contact_sheet(views: Sequence[Image]) -> Image:
    """The views in rows of four, each with its number."""
    tiles = [_tile(view, number) for number, view in enumerate(views, start=1)]
    rows = [np.hstack(tiles[i : i + COLUMNS]) for i in range(0, len(tiles), COLUMNS)]
    return np.vstack(rows)


def _tile(view: Image, number: int) -> Image:
    height = round(VIEW_WIDTH * view.shape[0] / view.shape[1])
    tile = cv2.resize(view, (VIEW_WIDTH, height), interpolation=cv2.INTER_AREA)
    for colour, thickness in (((0, 0, 0), 4), ((255, 255, 255), 1)):
        cv2.putText(tile, str(number), (8, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.7, colour, thickness, cv2.LINE_AA)
    return np.asarray(tile, dtype=np.uint8)


def _write_png(path: FilePath, image: Image) -> None:
    if not cv2.imwrite(str(path), cv2.cvtColor(image, cv2.COLOR_RGB2BGR)):
        raise OutputError(f"cannot write {path}; make room or name another folder")
