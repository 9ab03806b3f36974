import json
from dataclasses import asdict

import numpy as np
import pandas as pd
import pytest
import yaml

from slamgym.errors import ConfigError, TrajectoryWarning
from slamgym.study.folder import Plan, StudyFolder, write_plan
from slamgym.study.planned import PlannedDrive, PlannedRun
from slamgym.study.table import (
    joined,
    not_run_row,
    open_study,
    read_table,
    run_row,
    succeeded,
    was_run,
    write_table,
)

DRIVE = PlannedDrive("d-1", "procedural", "procedural:1 #7", {"scene": "procedural:1", "speed": 0.5}, 7)


def planned(name, **levels):
    return PlannedRun(f"d-1/{name}", DRIVE, {"slam": "groundtruth"}, 1, levels)


def make_run(folder, run, config, results):
    """A finished run's folder, with what the table needs."""
    path = folder.run(run.run_id)
    path.mkdir(parents=True)
    (path / "planned.json").write_text(json.dumps(asdict(run)))
    (path / "config.yaml").write_text(yaml.safe_dump(config))
    (path / "episode.json").write_text(json.dumps(results))
    return path


def plan_of(*runs, factors=()):
    return Plan("s", "", factors, tuple(run.run_id for run in runs))


def test_a_row_has_all_that_is_known_of_a_run(tmp_path):
    run = planned("r1", speed=0.5, camera="small", tour=[1, 2])
    config = {
        "speed": 0.5,
        "camera": {"width": 320, "distortion": [0.1]},
        "scene_options": {"texture": 2, "more": {"a": None}},
        "slam_options": {},
    }
    results = {"status": "ok", "ate_rmse_m": None, "losses": [{"a": 1}], "timing": {"track_ms": 2.5}, "seed": 7}
    assert run_row(make_run(StudyFolder(tmp_path), run, config, results)) == {
        "run_id": "d-1/r1",
        "dataset": "procedural",
        "path": "procedural:1 #7",
        "scene": "procedural:1",
        "seed": 7,
        "sequence": None,
        "repeat": 1,
        "drive_id": "d-1",
        "speed": 0.5,
        "camera": "small",
        "camera.width": 320,
        "camera.distortion": "[0.1]",
        "scene_options.texture": 2,
        "scene_options.more.a": None,
        "busy_processes": 0,
        "tour": "[1, 2]",
        "status": "ok",
        "ate_rmse_m": None,
        "timing.track_ms": 2.5,
    }


def test_a_run_that_could_not_be_begun_has_a_row_with_the_reason():
    row = not_run_row(planned("r1", speed=0.5), "no house")
    assert (row["status"], row["success"], row["failure"]) == ("not_run", None, "no house")
    assert (row["run_id"], row["speed"], row["slam"], row["scene"]) == ("d-1/r1", 0.5, "groundtruth", "procedural:1")


def test_every_column_has_one_type_on_the_disk_too(tmp_path):
    runs = [planned(name) for name in "abc"]
    columns = {
        "whole": [1, 2, 3],
        "gap": [1, None, 2.5],
        "truth": [True, False, True],
        "truth_gap": [True, None, False],
        "text_gap": ["x", None, "y"],
        "mixed": ["auto", 3.0, None],
        "mixed_truth": [True, 2, "x"],
        "nothing": [None, None, None],
    }
    rows = [
        {"run_id": run.run_id, "status": "ok", **{k: v[n] for k, v in columns.items()}} for n, run in enumerate(runs)
    ]
    table = joined(read_table(tmp_path / "none"), rows, plan_of(*runs))
    write_table(tmp_path / "runs.parquet", table)
    back = read_table(tmp_path / "runs.parquet")
    for read in (table, back):
        assert {name: read[name].tolist() for name in ("whole", "truth", "truth_gap")} == {
            name: columns[name] for name in ("whole", "truth", "truth_gap")
        }
        assert read["gap"].tolist() == pytest.approx([1, np.nan, 2.5], nan_ok=True)
        assert read["text_gap"].fillna("-").tolist() == ["x", "-", "y"]
        assert read["mixed"].fillna("-").tolist() == ["auto", "3", "-"]
        assert read["mixed_truth"].tolist() == ["True", "2", "x"]
        assert read["nothing"].isna().all()


def test_rows_come_in_the_order_of_the_plan_however_they_came_in():
    runs = [planned(name, speed=1.0) for name in "abcd"]
    plan = plan_of(*runs, factors=("speed",))
    first = joined(
        pd.DataFrame(columns=["run_id", "status"]), [not_run_row(run, "") for run in (runs[3], runs[1])], plan
    )
    both = joined(first, [{**not_run_row(runs[1], "again"), "extra": 1}, not_run_row(runs[0], "")], plan)
    assert both["run_id"].tolist() == ["d-1/a", "d-1/b", "d-1/d"]
    assert both["failure"].tolist() == ["", "again", ""]
    assert list(both.columns[:9]) == [
        *("run_id", "dataset", "path", "scene", "seed", "sequence", "repeat", "drive_id"),
        "speed",
    ]
    at_once = joined(
        pd.DataFrame(columns=["run_id", "status"]),
        [not_run_row(runs[0], ""), {**not_run_row(runs[1], "again"), "extra": 1}, not_run_row(runs[3], "")],
        plan,
    )
    pd.testing.assert_frame_equal(both, at_once)


def test_a_study_is_what_the_table_has_and_what_was_finished_since(tmp_path):
    folder = StudyFolder(tmp_path)
    runs = [planned(name) for name in "abc"]
    plan = plan_of(*runs)
    write_plan(folder, plan)
    assert open_study(tmp_path).runs.empty
    for run in runs[:2]:
        make_run(folder, run, {}, {"status": "ok", "success": True})
    write_table(folder.table, joined(read_table(folder.table), [{"run_id": "d-1/a", "status": "from table"}], plan))
    study = open_study(tmp_path)
    assert (study.planned, study.runs["status"].tolist()) == (3, ["from table", "ok"])
    write_table(folder.table, joined(study.runs, [not_run_row(runs[1], "before"), not_run_row(runs[2], "now")], plan))
    assert open_study(tmp_path).runs["status"].tolist() == ["from table", "ok", "not_run"]
    make_run(folder, planned("of another plan"), {}, {"status": "ok"})
    assert len(open_study(tmp_path).runs) == 3


@pytest.mark.parametrize("name", ["planned.json", "config.yaml", "episode.json"])
def test_a_damaged_run_folder_is_named(tmp_path, name):
    path = make_run(StudyFolder(tmp_path), planned("r1"), {}, {})
    (path / name).write_text("{ [")
    with pytest.raises(ConfigError, match="r1"):
        run_row(path)
    (path / name).unlink()
    with pytest.raises(ConfigError, match="r1"):
        run_row(path)


@pytest.mark.parametrize("content", ["no table", "", None, "other columns"])
def test_a_damaged_table_is_made_anew(tmp_path, content):
    folder, run = StudyFolder(tmp_path), planned("r1")
    write_plan(folder, plan_of(run))
    make_run(folder, run, {}, {"status": "ok", "success": True})
    if content is None:
        folder.table.mkdir()
    elif content == "other columns":
        pd.DataFrame({"a": [1]}).to_parquet(folder.table)
    else:
        folder.table.write_text(content)
    assert open_study(tmp_path).runs["status"].tolist() == ["ok"]


@pytest.mark.parametrize(
    ("name", "content"),
    [("episode.json", "[]"), ("episode.json", '{"status"'), ("config.yaml", ""), ("planned.json", "")],
)
def test_a_damaged_run_is_left_out_with_a_warning(tmp_path, name, content):
    folder, runs = StudyFolder(tmp_path), [planned("r1"), planned("r2")]
    write_plan(folder, plan_of(*runs))
    for run in runs:
        make_run(folder, run, {}, {"status": "ok", "success": True})
    (folder.run("d-1/r2") / name).write_text(content)
    with pytest.warns(TrajectoryWarning, match="r2.+it is left out"):
        assert open_study(tmp_path).runs["run_id"].tolist() == ["d-1/r1"]


def test_what_could_not_be_run_is_neither_judged_nor_a_success():
    runs = pd.DataFrame({"status": ["ok", "not_run", "lost"], "success": [True, None, False]})
    assert succeeded(runs).tolist() == [True, False, False]
    assert runs["status"][was_run(runs)].tolist() == ["ok", "lost"]
    assert succeeded(pd.DataFrame({"status": ["ok"]})).tolist() == [False]
