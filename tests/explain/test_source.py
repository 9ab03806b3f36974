import json
import shutil

import pytest
import yaml

from slamgym.agents import Cautious, LookAround, PathFollower
from slamgym.errors import ConfigError, TrajectoryWarning
from slamgym.explain.source import read_run, runs_in
from slamgym.study.drive_work import FRAMES, record_planned_drive
from slamgym.study.folder import Plan, StudyFolder, write_plan
from slamgym.study.planned import PlannedDrive, PlannedRun
from slamgym.study.slam_work import run_planned
from tests.explain.conftest import HALL, drive


def test_what_a_run_folder_tells(dizzy_run):
    run = read_run(dizzy_run)
    assert (run.seed, run.agent, run.reset_options) == (0, PathFollower, {"tour": "one_way"})
    assert (run.setup.drive.scene, run.setup.drive.speed, run.setup.drive.turn_rate) == ("hall", 1.0, 2.0)
    assert (run.setup.drive.camera.width, run.setup.slam.slam) == (320, "picky_backends:Dizzy")
    assert run.setup.busy_processes == 0
    assert run.stretch_m == pytest.approx((0.0, 6.0))
    assert len(run.house_sha256) == 12
    told = json.loads((dizzy_run / "episode.json").read_text())["losses"]
    assert [loss.start_s for loss in run.losses] == [loss["start_s"] for loss in told]
    assert [loss.number for loss in run.losses] == list(range(1, len(told) + 1))
    # At its top speed of 1 m/s, 0.07 m a frame.
    assert all(0.0 < loss.progress_m <= loss.start_s for loss in run.losses)


def test_a_run_over_a_part_of_a_path_counts_from_the_paths_start(hall, tmp_path):
    class Part(LookAround):
        reset_options = {"tour": "one_way", "stretch_m": (1.0, 3.0)}  # noqa: RUF012

    folder = drive("picky_backends:Dizzy", 0, tmp_path / "run", Part())
    config = yaml.safe_load((folder / "config.yaml").read_text())
    config["run"]["agent"] = "slamgym.agents.look_around:LookAround"
    (folder / "config.yaml").write_text(yaml.safe_dump(config))
    run = read_run(folder)
    assert (run.agent, run.reset_options) == (LookAround, {"tour": "one_way"})
    assert run.stretch_m == pytest.approx((1.0, 3.0))


def changed_copy(folder, target, **run):
    shutil.copytree(folder, target)
    config = yaml.safe_load((target / "config.yaml").read_text())
    config["run"] |= run
    (target / "config.yaml").write_text(yaml.safe_dump(config))
    return target


@pytest.mark.parametrize(
    ("run", "message"),
    [
        ({"sequence": "fr1_xyz"}, "over a recorded sequence, where nothing can be changed"),
        ({"agent": f"{Cautious.__module__}:Cautious"}, "agent of follower, .*patrol, .* got .*Cautious"),
        ({"reset_options": 3}, "expected the folder of a run, got a damaged one, whose config.yaml"),
        ({"seed": None}, "expected the folder of a run, got a damaged one, whose config.yaml"),
    ],
)
def test_runs_that_cannot_be_driven_again(run, message, dizzy_run, tmp_path):
    with pytest.raises(ConfigError, match=message) as refused:
        read_run(changed_copy(dizzy_run, tmp_path / "run", **run))
    assert len(str(refused.value).splitlines()) == 1


@pytest.mark.parametrize("name", ["reset_options", "seed", "agent", "versions"])
def test_a_run_folder_that_lacks_something(name, dizzy_run, tmp_path):
    folder = changed_copy(dizzy_run, tmp_path / "run")
    config = yaml.safe_load((folder / "config.yaml").read_text())
    del config["run"][name]
    (folder / "config.yaml").write_text(yaml.safe_dump(config))
    with pytest.raises(ConfigError) as refused:
        read_run(folder)
    expected = f"{folder}: expected the folder of a run, got a damaged one, without '{name}'; name one of `slamgym run`"
    assert str(refused.value) == expected


def test_losses_of_a_part_are_at_the_metres_of_the_whole_path(dizzy_run, tmp_path):
    whole = read_run(dizzy_run)
    part = read_run(changed_copy(dizzy_run, tmp_path / "run", reset_options={"stretch_m": [2.5, 8.5]}))
    assert part.stretch_m == pytest.approx((2.5, 8.5))
    assert len(part.losses) == len(whole.losses) > 0
    for there, here in zip(whole.losses, part.losses, strict=True):
        assert here.progress_m == pytest.approx(there.progress_m + 2.5)


def test_what_is_no_run_is_refused(tmp_path):
    with pytest.raises(ConfigError, match="expected the folder of a run or of a study, got neither"):
        runs_in(tmp_path)
    with pytest.raises(ConfigError, match=r"expected the folder of a run, got one whose config.yaml cannot be read"):
        read_run(tmp_path)


def test_a_run_is_itself(dizzy_run):
    assert runs_in(dizzy_run) == [dizzy_run]


def test_of_a_study_the_runs_with_a_loss_that_can_be_driven_again(hall, tmp_path):
    study = StudyFolder(tmp_path)
    driven = PlannedDrive("hall-0", "hall", "hall #0", {**HALL, "path_length_m": 6.0})
    recorded = PlannedDrive("seq", "seq", "seq", {}, sequence=str(study.frames("hall-0") / FRAMES))
    runs = [
        PlannedRun("hall-0/dizzy", driven, {"slam": "picky_backends:Dizzy"}, 1, {}, busy_processes=1),
        PlannedRun("hall-0/groundtruth", driven, {"slam": "groundtruth"}, 1, {}),
        PlannedRun("seq/dizzy", recorded, {"slam": "picky_backends:Dizzy"}, 1, {}),
    ]
    write_plan(study, Plan("study", "", (), tuple(run.run_id for run in runs)))
    assert runs_in(tmp_path) == []
    for one in (driven, recorded):
        record_planned_drive(one, study.frames(one.drive_id))
    results = [run_planned(run, study.frames(run.drive.drive_id), study.run(run.run_id)) for run in runs]
    assert [result["loss_count"] > 0 for result in results] == [True, False, True]
    on_sequence = results[2]["loss_count"]
    with pytest.warns(TrajectoryWarning, match=f"{on_sequence} losses are over recorded sequences.*: left out"):
        assert runs_in(tmp_path) == [study.run("hall-0/dizzy")]
    shutil.rmtree(study.run("hall-0/dizzy"))
    with pytest.raises(ConfigError, match=f"all {on_sequence} losses are over recorded sequences, where nothing"):
        runs_in(tmp_path)
    run_planned(runs[0], study.frames("hall-0"), study.run("hall-0/dizzy"))
    run = read_run(study.run("hall-0/dizzy"))
    assert (run.setup.busy_processes, run.agent, len(run.losses)) == (1, PathFollower, results[0]["loss_count"])
    with pytest.raises(ConfigError, match="over a recorded sequence"):
        read_run(study.run("seq/dizzy"))
