import json
from dataclasses import replace
from itertools import pairwise

import cv2
import numpy as np
import pytest

from slamgym import scene_report
from slamgym.errors import ConfigError, OutputError
from slamgym.eval.views import keypoint_count
from slamgym.geometry import mast_camera_pose
from slamgym.params import DriveParams
from slamgym.render import Renderer
from slamgym.scene_report import EXPORTS, inspect_scene, write_report
from slamgym.scenes.house import House, Lamp, Material, Part, Room, Window
from slamgym.scenes.loader import SceneOptions
from slamgym.scenes.map_server import read_map, write_map
from slamgym.scenes.occupancy import OccupancyGrid
from slamgym.scenes.registry import SCENES, load_scene

FLOOR = np.array([(0, 0), (6, 0), (6, 4), (0, 4)], np.float32)
TILES = np.random.default_rng(0).integers(0, 256, (500, 600, 3), np.uint8)


class Toy:
    """A floor of 6 x 4 m with four walls, open above. Seed 1 has two rooms."""

    Options = SceneOptions
    suffixes = ()

    @staticmethod
    def load(source, options):
        tiles = Material("tiles", texture=TILES)
        quads = [[(*corner, 0) for corner in FLOOR]]
        quads += [[(*a, 0), (*b, 0), (*b, 2.5), (*a, 2.5)] for a, b in pairwise([*FLOOR, FLOOR[0]])]
        parts = tuple(_quad(f"quad_{i}", tiles, corners) for i, corners in enumerate(quads))
        rooms = (Room("hall", "hall", 0, 0, 3, 4), Room("den", "den", 3, 0, 6, 3)) if source else ()
        windows = tuple(Window((x, 0.0, 1.5), (0.5, 0, 0), (0, 0, 0.5)) for x in (1.0, 2.0))
        return House("toy", parts, rooms, (Lamp((3, 2, 2)),), windows, ("up: z",), ("one leg is gone",))


def _quad(name, material, corners):
    uv = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32)
    return Part(name, material, np.array(corners, np.float32), np.array([(0, 1, 2), (0, 2, 3)], np.int32), uv)


@pytest.fixture(scope="module")
def params(tmp_path_factory):
    """The toy with a map of 20 x 30 cells of 0.2 m, of which the last five columns are occupied."""
    occupied = np.zeros((20, 30), np.bool_)
    occupied[:, 25:] = True
    yaml = write_map(OccupancyGrid(occupied, np.zeros(2), 0.2), tmp_path_factory.mktemp("map") / "toy.yaml")
    with pytest.MonkeyPatch.context() as patched:
        patched.setitem(SCENES, "toy", f"{__name__}:Toy")
        yield DriveParams(
            scene="toy:1", occupancy_map=yaml, camera="small", lighting="flat", camera_height=1.2, brightness=0.5,
            multisampling=4, path_length_m=6.0,
        )  # fmt: skip


@pytest.fixture(scope="module")
def report(params):
    with pytest.warns(match="one leg is gone"):
        return inspect_scene(params, seed=3)


def test_figures_of_the_house(report):
    # Free for a radius of 0.2 m, 0.05 m more, and half a cell: all but the outermost of 20 x 25 cells.
    expected = {
        "scene": "toy", "rooms": ["hall", "den"], "rooms_m2": 21.0, "unobstructed_m2": 20.0, "free_m2": 16.56,
        "parts": 5, "triangles": 10, "textures": 1, "texture_megapixels": 0.3, "lamps": 1, "windows": 2, "path_m": 6.0,
        "assumptions": ["up: z"], "defects": ["one leg is gone"],
    }  # fmt: skip
    assert {name: report.figures[name] for name in expected} == expected


def test_the_area_of_unknown_rooms_is_not_known(params):
    with pytest.warns(match="one leg is gone"):
        figures = inspect_scene(params.model_copy(update={"scene": "toy:0"})).figures
    assert figures["rooms"] == []
    assert figures["rooms_m2"] is None


def test_views_are_what_the_camera_sees(report, params):
    path, depths = report.path, []
    with Renderer(report.stage.house, params.camera, "flat", 0.5, 4) as renderer:
        for number, view in enumerate(report.views):
            s = 6.0 * number / 12
            colour, depth = renderer.render(mast_camera_pose(*path.point_at(s), path.heading_at(s), 1.2))
            assert np.array_equal(view, colour), number
            depths.append(depth)
    assert number == 11
    grey = [cv2.cvtColor(view, cv2.COLOR_RGB2GRAY) for view in report.views]
    assert report.figures["keypoints_a_view"] == [keypoint_count(image) for image in grey]
    assert report.figures["brightness_a_view"] == pytest.approx([image.mean() for image in grey], abs=0.051)
    assert report.figures["open_share"] == pytest.approx(np.mean(np.array(depths) == 0), abs=1e-4)
    assert 0.05 < report.figures["open_share"] < 0.5


def test_the_seed_picks_the_path_of_the_views(report, params):
    other = inspect_scene(params, seed=4)
    assert not np.array_equal(other.path.xy, report.path.xy)
    assert other.stage.house is report.stage.house


def test_the_report_is_whole(report, tmp_path):
    folder = write_report(report, tmp_path / "deep" / "report")
    names = {"contact_sheet.png", "plan.png", "map.pgm", "map.yaml", "scene.json"}
    assert {file.name for file in folder.iterdir()} == names
    sheet = cv2.imread(str(folder / "contact_sheet.png"))
    assert sheet.shape == (3 * 360, 4 * 480, 3)
    second = cv2.cvtColor(cv2.resize(report.views[1], (480, 360), interpolation=cv2.INTER_AREA), cv2.COLOR_RGB2BGR)
    assert np.array_equal(sheet[60:360, 480:960], second[60:])
    assert np.array_equal(read_map(folder / "map.yaml").occupied, report.stage.grid.occupied)
    assert json.loads((folder / "scene.json").read_text()) == report.figures
    assert cv2.imread(str(folder / "plan.png")).std() > 20


def test_views_are_marked_where_they_are(report, tmp_path, monkeypatch):
    drawn = []
    plot = scene_report.plot_floor_plan
    monkeypatch.setattr(scene_report, "plot_floor_plan", lambda *args: drawn.append(plot(*args)) or drawn[0])
    write_report(report, tmp_path / "report")
    path, views = drawn[0].axes[0].lines
    assert np.array_equal(path.get_xydata(), report.path.xy)
    assert np.array_equal(views.get_xydata(), [report.path.point_at(0.5 * number) for number in range(12)])


def test_exports_are_part_of_the_report(report, tmp_path):
    """glb has the house as it is drawn, SUNCG's layout as it was loaded; asked for twice is as good as once."""
    lit = [replace(part, light=np.full_like(part.vertices, 0.5)) for part in report.stage.house.parts]
    drawn = replace(report.stage.house, parts=tuple(lit[:3]))
    report = replace(report, stage=replace(report.stage, house=drawn))
    folder = write_report(report, tmp_path / "report", ("glb", "suncg", "glb"))
    from_glb = load_scene(str(folder / "house.glb"))
    assert sum(len(part.faces) for part in from_glb.parts) == 6
    assert all(np.allclose(part.light, 0.5, atol=1e-3) for part in from_glb.parts)
    (house_json,) = folder.glob("suncg/house/*/house.json")
    from_suncg = load_scene(str(house_json))
    assert sum(len(part.faces) for part in from_suncg.parts) == 10
    assert sum(len(part.vertices) for part in from_suncg.parts) == 20


def test_a_failing_export_leaves_nothing(report, tmp_path, monkeypatch):
    def fail(stage, folder):
        (folder / "half.txt").write_text("half")
        raise OutputError("full")

    monkeypatch.setitem(EXPORTS, "suncg", fail)
    with pytest.raises(OutputError, match="full"):
        write_report(report, tmp_path / "report", ("glb", "suncg"))
    with pytest.raises(ConfigError, match="did you mean 'glb'"):
        write_report(report, tmp_path / "report", ("gbl",))
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_overwritten(report, tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(OutputError, match="new or empty folder"):
        write_report(report, tmp_path)
    assert (tmp_path / "mine.txt").read_text() == "mine"
