import json

import numpy as np
import pandas as pd
import pytest
import yaml

from slamgym.cli import COMMANDS, main
from slamgym.errors import ConfigError
from slamgym.explain.cases import cases_of
from slamgym.explain.experiment import run_case
from slamgym.explain.explanation import ExplainParams, explain
from slamgym.explain.source import read_run
from slamgym.explain.stretch import Stretches, Variant, is_lost, quickest_turn, run_slam, why_not_comparable
from slamgym.explain.verdict import Count
from tests.explain.conftest import drive

CONTROLS = {"unchanged", "unchanged_again", "another_start"}


@pytest.fixture(scope="session")
def dizzy_result(dizzy_run, tmp_path_factory):
    """The first loss of the dizzy SLAM, explained with two repeats."""
    folder = tmp_path_factory.mktemp("why") / "loss_1"
    case = next(cases_of(read_run(dizzy_run), 1.0, 0.4))
    return folder, run_case(case, folder, repeats=2, workers=2, on_step=lambda _: None)


def test_the_right_change_is_found_and_the_controls_are_unchanged(dizzy_result):
    _, result = dizzy_result
    judgement = result.judgement
    assert [(one.count, one.verdict) for one in judgement.controls] == [(Count(2, 2), "unchanged")] * 3
    counts = {one.name: one.count.lost for one in judgement.changes}
    # At half the speed the same bend asks for half the turn rate.
    assert counts == {"half the turn rate": 0, "half the speed": 0, "more light": 2, "richer texture": 2}
    assert [one.name for one in result.cures] == ["half the turn rate", "half the speed"]
    assert result.verdict == "explained"
    assert (
        "vanishes with half the turn rate (0 of 2, over other frames 0 of 4) or with half the speed "
        "(0 of 2, over other frames 0 of 4); unchanged 6 of 6, over other frames 4 of 4" in result.sentence()
    )


def test_each_repeat_leaves_a_run_folder_and_no_frames_stay(dizzy_result):
    folder, result = dizzy_result
    changes = {one.name.replace(" ", "_") for one in result.judgement.changes}
    assert {place.name for place in folder.iterdir()} == {*CONTROLS, *changes, "first_look", "other_frames"}
    for name in (*CONTROLS, *changes, "first_look"):
        assert {repeat.name for repeat in (folder / name).iterdir()} == {"1", "2"}
    config = yaml.safe_load((folder / "half_the_turn_rate" / "2" / "config.yaml").read_text())
    # Half of what its bend asked for, below its top rate of 2 rad/s.
    assert 0.6 < config["turn_rate"] < 0.85
    assert config["run"]["agent"] == "slamgym.agents.follower:PathFollower"
    assert config["run"]["reset_options"]["stretch_m"] == list(result.case.stretch_m)
    moved = yaml.safe_load((folder / "another_start" / "1" / "config.yaml").read_text())
    begin_m, end_m = result.case.stretch_m
    assert moved["run"]["reset_options"]["stretch_m"] == pytest.approx([begin_m - 0.1, end_m])


def test_what_is_credited_is_confirmed_from_starts_of_its_own(dizzy_result):
    folder, result = dizzy_result
    begin_m, end_m = result.case.stretch_m
    other = folder / "other_frames"
    assert {place.name for place in other.iterdir()} == {"unchanged", "half_the_turn_rate", "half_the_speed"}
    stretches = [
        yaml.safe_load((run / "config.yaml").read_text())["run"]["reset_options"]["stretch_m"]
        for run in other.glob("*/*")
    ]
    assert len({start_m for start_m, _ in stretches}) == 12
    assert all(begin_m - 0.3 <= start_m < begin_m and last_m == end_m for start_m, last_m in stretches)
    assert [(one.name, one.count) for one in result.confirmation.changes] == [
        ("half the turn rate", Count(0, 4)),
        ("half the speed", Count(0, 4)),
    ]


def test_a_repeat_can_be_explained_itself(dizzy_result):
    folder, result = dizzy_result
    run = read_run(folder / "unchanged" / "1")
    assert run.stretch_m == pytest.approx(result.case.stretch_m, abs=1e-6)
    assert run.losses[0].progress_m == pytest.approx(result.case.loss.progress_m, abs=0.5)


def test_data_holds_what_was_found(dizzy_result):
    _, result = dizzy_result
    told = json.loads(json.dumps(result.data()))
    assert told["verdict"] == "explained"
    assert told["losses"][0]["number"] == 1
    assert told["first_looks"] == [{"stretch_m": list(result.case.stretch_m), "lost": 2, "repeats": 2}]
    (slower,) = [one for one in told["changes"] if one["name"] == "half the turn rate"]
    assert (slower["verdict"], slower["over_other_frames"]["lost"]) == ("vanishes", 0)
    assert told["unchanged_over_other_frames"] == {"lost": 4, "repeats": 4}
    assert [one["p"] for one in told["controls"]] == [1.0] * 3


@pytest.mark.slow
def test_light_is_found_where_it_was_dark(dark_run, tmp_path):
    case = next(cases_of(read_run(dark_run), 1.0, 0.5))
    result = run_case(case, tmp_path / "loss", repeats=2, workers=2, on_step=lambda _: None)
    assert [one.name for one in result.cures] == ["more light"]
    assert result.judgement.control_count == Count(6, 6)


def test_a_loss_that_does_not_come_again_is_looked_for_in_the_whole_drive_and_left(dizzy_run, tmp_path):
    folder = tmp_path / "run"
    folder.mkdir()
    for name in ("config.yaml", "episode.json"):
        text = (dizzy_run / name).read_text()
        (folder / name).write_text(text.replace("picky_backends:Dizzy", "groundtruth"))
    (folder / "frames.csv").write_bytes((dizzy_run / "frames.csv").read_bytes())
    case = next(cases_of(read_run(folder), 1.0, 0.4))
    result = run_case(case, tmp_path / "loss", repeats=2, workers=1, on_step=lambda _: None)
    assert result.first_looks == ((case.stretch_m, Count(0, 2)), (case.whole_m, Count(0, 2)))
    assert result.verdict == "not reproduced"
    assert "did not come again: 0 of 2 from" in result.sentence()
    assert {place.name for place in (tmp_path / "loss").iterdir()} == {"first_look", "first_look_at_the_whole_drive"}


def test_what_cannot_be_compared_is_told(dizzy_run, tmp_path):
    run = read_run(dizzy_run)
    stretches = Stretches(run, tmp_path, lambda _: None)
    unchanged = stretches.drive(Variant(run.setup, (1.0, 2.0)))
    assert why_not_comparable(unchanged, stretches.drive(Variant(run.setup, (1.0, 2.0)))) == ""
    assert len(list(tmp_path.iterdir())) == 1  # driven once
    other = stretches.drive(Variant(run.setup, (1.2, 2.2)))
    assert why_not_comparable(unchanged, other) == "it changes the path"


def test_the_quickest_turn_is_that_of_the_window(dizzy_run, tmp_path):
    run = read_run(dizzy_run)
    stretch = Stretches(run, tmp_path, lambda _: None).drive(Variant(run.setup, (1.0, 1.7)))
    motion = pd.DataFrame(stretch.episode.motion())
    assert quickest_turn(stretch, 1.0, (1.0, 1.7)) == motion["yaw_rate_radps"].abs().max() > 0.1
    late = motion[motion["progress_m"] >= 0.5]
    assert quickest_turn(stretch, 1.0, (1.5, 1.7)) == late["yaw_rate_radps"].abs().max()
    assert quickest_turn(stretch, 1.0, (5.0, 6.0)) == 0.0


def test_what_counts_as_lost(dizzy_run, tmp_path):
    run = read_run(dizzy_run)
    stretch = Stretches(run, tmp_path, lambda _: None).drive(Variant(run.setup, (1.0, 1.7)))

    def of(slam):
        return run_slam(stretch, run.setup.with_slam(slam=slam))

    died = of("picky_backends:Dies")
    fifth_m = 1.0 + died.motion()["progress_m"][4]
    assert died.summary["status"] == "crashed"
    assert not is_lost(died, 1.0, (1.0, fifth_m - 1e-6))
    assert is_lost(died, 1.0, (1.0, fifth_m + 1e-6))
    assert is_lost(died, 1.0, (1.5, 1.7))
    began_late = of("picky_backends:Late")
    assert not is_lost(began_late, 1.0, (1.0, 1.7))
    assert is_lost(began_late, 1.0, (0.9, 1.0))  # only its first frame, and never tracked there
    assert is_lost(began_late, 1.0, (2.0, 3.0))  # where it never came


def test_an_interruption_leaves_whole_run_folders_and_no_frames(dizzy_run, tmp_path):
    def interrupt(done):
        if done == "first look, repeat 2":
            raise KeyboardInterrupt

    case = next(cases_of(read_run(dizzy_run), 0.5, 0.2))
    with pytest.raises(KeyboardInterrupt):
        run_case(case, tmp_path, repeats=2, workers=1, on_step=interrupt)
    assert [folder.name for folder in tmp_path.iterdir()] == ["first_look"]
    (kept,) = (tmp_path / "first_look").iterdir()
    assert (kept.name, len(read_run(kept).losses)) == ("1", 1)


def test_another_house_is_refused(dizzy_run, tmp_path):
    folder = tmp_path / "run"
    folder.mkdir()
    for file in dizzy_run.iterdir():
        (folder / file.name).write_bytes(file.read_bytes())
    config = yaml.safe_load((folder / "config.yaml").read_text())
    config["run"]["versions"]["house_sha256"] = "0123456789ab"
    (folder / "config.yaml").write_text(yaml.safe_dump(config))
    with pytest.raises(ConfigError, match=r"expected the house that it was driven in \(0123456789ab\), got another"):
        explain([folder], tmp_path / "out", ExplainParams())


def test_a_run_without_a_loss_has_nothing_to_explain(hall, tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(COMMANDS, "explain", "slamgym.cli.explain:Explain")
    folder = drive("groundtruth", 0, tmp_path / "run", path_length_m=0.5)
    main(["explain", str(folder), "--out", str(tmp_path / "why")])
    assert "nothing was lost" in capsys.readouterr().out
    assert not (tmp_path / "why").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "expected at least one run"),
        (["{run}", "--repeats", "2"], "repeats: the value should be greater than or equal to 3"),
        (["{run}", "--workers", "0"], "workers"),
        (["{run}/nothing"], "expected the folder of a run or of a study"),
    ],
)
def test_bad_input_is_one_line_and_leaves_nothing(arguments, message, dizzy_run, tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(COMMANDS, "explain", "slamgym.cli.explain:Explain")
    with pytest.raises(SystemExit) as stopped:
        main(["explain", *(word.format(run=dizzy_run) for word in arguments), "--out", str(tmp_path / "why")])
    assert stopped.value.code == 2
    error = capsys.readouterr().err.strip()
    assert message in error
    assert len(error.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_the_command_on_several_runs(dizzy_run, dark_run, tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(COMMANDS, "explain", "slamgym.cli.explain:Explain")
    out = tmp_path / "why"
    around = ["--before-m", "1", "--after-m", "0.4", "--losses", "2", "--workers", "2"]
    main(["explain", str(dizzy_run), str(dark_run), "--out", str(out), *around])
    printed = capsys.readouterr().out
    assert "came again: 2 of 2 losses" in printed
    assert "vanish with a single change: 2 of 2 (100 %" in printed
    assert "controls agree: 2 of 2" in printed
    told = json.loads((out / "explain.json").read_text())
    assert [loss["verdict"] for loss in told["losses"]] == ["explained", "explained"]
    assert {path.name for path in out.iterdir()} >= {"explain.json", "explain.svg", "explain.png"}
    assert len(list(out.glob("*/run/loss_1/unchanged/*/episode.json"))) == 6


def test_frames_of_a_stretch_are_those_of_the_drive(dizzy_run, tmp_path):
    """Where both drive at full speed the robot takes the same line, to some centimetres."""
    run = read_run(dizzy_run)
    stretch = Stretches(run, tmp_path, lambda _: None).drive(Variant(run.setup, (1.0, 4.0)))
    whole = pd.read_csv(dizzy_run / "frames.csv")
    part = pd.DataFrame(stretch.episode.motion())
    both = part[(part["progress_m"] > 1.0) & (part["progress_m"] < 1.8)]
    there = [np.interp(1.0 + both["progress_m"], whole["progress_m"], whole[name]) for name in ("x_m", "y_m")]
    assert len(both) > 5
    assert np.hypot(both["x_m"] - there[0], both["y_m"] - there[1]).max() < 0.05
