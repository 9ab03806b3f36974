import json

import cv2
import numpy as np
import pytest

from slamgym.errors import OutputError
from slamgym.params import DriveParams
from slamgym.scene_report import VIEWS, inspect_scene, write_report
from slamgym.scenes.map_server import read_map


@pytest.fixture(scope="module")
def report():
    return inspect_scene(DriveParams(camera="small", lighting="flat", scene_options={"size": "small"}), seed=3)


def test_the_report_is_whole(report, tmp_path):
    folder = write_report(report, tmp_path / "deep" / "report")
    names = {"contact_sheet.png", "plan.png", "map.pgm", "map.yaml", "scene.json"}
    assert {file.name for file in folder.iterdir()} == names
    sheet = cv2.imread(str(folder / "contact_sheet.png"))
    assert sheet.shape == (3 * 360, 4 * 480, 3)
    first = cv2.cvtColor(cv2.resize(report.views[0], (480, 360), interpolation=cv2.INTER_AREA), cv2.COLOR_RGB2BGR)
    assert np.array_equal(sheet[60:360, :480], first[60:])
    assert np.array_equal(read_map(folder / "map.yaml").occupied, report.stage.grid.occupied)
    assert json.loads((folder / "scene.json").read_text()) == report.figures
    assert cv2.imread(str(folder / "plan.png")).std() > 20


def test_figures(report):
    figures, house = report.figures, report.stage.house
    assert figures["triangles"] == sum(len(part.faces) for part in house.parts)
    assert len(figures["keypoints_a_view"]) == len(report.views) == VIEWS
    assert max(figures["keypoints_a_view"]) > 100
    inside = sum((room.x_max - room.x_min) * (room.y_max - room.y_min) for room in house.rooms)
    assert 0.4 * inside < figures["floor_m2"] < 1.1 * inside
    assert 0 < figures["free_m2"] < figures["floor_m2"]
    assert figures["rooms"] == [room.name for room in house.rooms]


def test_the_seed_picks_the_path_of_the_views(report):
    other = inspect_scene(DriveParams(camera="small", lighting="flat", scene_options={"size": "small"}), seed=4)
    assert not np.array_equal(other.views[0], report.views[0])
    assert other.stage is report.stage


def test_nothing_is_overwritten(report, tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(OutputError, match="new or empty folder"):
        write_report(report, tmp_path)
    assert (tmp_path / "mine.txt").read_text() == "mine"
