"""Studies that are started again where files are damaged, moved, or not what they were."""

import json
import shutil

import pytest
import yaml

from slamgym.errors import OutputError, SequenceError
from slamgym.study.drive_work import read_facts
from slamgym.study.folder import StudyFolder
from slamgym.study.run import run_study
from slamgym.study.table import open_study

LINES = """
name: lines
paths: [{{sequence: [{}]}}]
factors: [{{slam: [groundtruth, wheel_odometry]}}]
"""

HOUSE = """
name: house
paths: [{{scene: {}, seeds: [{}]}}]
fixed: {{camera: small, path_length_m: 0.6, speed: 1.0, lighting: flat, slam: groundtruth}}
"""


@pytest.fixture
def lines(study, sequences):
    """A study of two runs over a recorded line."""
    return study(LINES.format(sequences[0]))


def shorten(file):
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])


def empty(folder):
    shutil.rmtree(folder)
    folder.mkdir()


def test_what_a_power_cut_damaged_is_set_aside_and_run_again(lines, tmp_path):
    out = tmp_path / "out"
    done = run_study(lines, out, 1)
    first, second = (out / "runs" / run_id for run_id in done.runs["run_id"])
    for damage in (
        lambda: (empty(first), empty(second)),
        lambda: ((first / "episode.json").write_text(""), shorten(second / "episode.json")),
        lambda: ((first / "episode.json").write_text("[]"), (second / "config.yaml").write_text("")),
    ):
        damage()
        (out / "plan.json").write_text("")
        (out / "runs.parquet").write_bytes(b"PAR1")
        again = run_study(lines, out, 1)
        assert again.runs["status"].tolist() == ["ok", "ok"]
        assert json.loads((first / "episode.json").read_text())["status"] == "ok"
        assert yaml.safe_load((second / "config.yaml").read_text())["slam"] == "wheel_odometry"
    assert len(list((out / "damaged").glob("runs/*/*"))) == 6
    (out / "runs.parquet").unlink()
    (out / "runs.parquet").mkdir()
    assert len(run_study(lines, out, 1).runs) == 2
    assert (out / "runs.parquet").is_file()


def test_damaged_facts_of_a_drive_are_made_anew(study, tmp_path):
    out = tmp_path / "out"
    done = run_study(study(HOUSE.format("procedural:1", 1)), out, 1)
    (drive,) = (out / "drives").iterdir()
    for content in (b"", b"PK\x03\x04", (drive / "drive.npz").read_bytes()[:500]):
        (drive / "drive.npz").write_bytes(content)
        with pytest.raises(SequenceError, match="expected a drive that a study recorded"):
            read_facts(drive)
    shutil.rmtree(done.folder / "runs")
    run_study(study(HOUSE.format("procedural:1", 1)), out, 1)
    assert read_facts(drive).episode is not None


def test_a_scene_that_changed_meanwhile_stops_the_study(study, tmp_path):
    house = tmp_path / "house.glb"
    _write_room(house, 4.0)
    out = tmp_path / "out"
    before = run_study(study(HOUSE.format(house, "1")), out, 1)
    assert before.runs["status"].tolist() == ["ok"]
    _write_room(house, 5.0)
    with pytest.raises(OutputError, match=r"house\.glb: it changed since runs .+ \(\w{12} then, \w{12} now"):
        run_study(study(HOUSE.format(house, "1, 2")), out, 1)
    assert len(list((out / "drives").iterdir())) == len(open_study(out).runs) == 1
    assert not list((out / "frames").iterdir())
    _write_room(house, 4.0)
    assert run_study(study(HOUSE.format(house, "1, 2")), out, 1).runs["status"].tolist() == ["ok", "ok"]


def test_a_recorded_sequence_that_changed_meanwhile_stops_the_study(study, sequences, tmp_path):
    line = tmp_path / "line"
    shutil.copytree(sequences[0], line)
    run_study(study(LINES.format(line)), tmp_path / "out", 1)
    shutil.rmtree(line)
    shutil.copytree(sequences[1], line)
    with pytest.raises(OutputError, match="line: it changed since runs were made in it"):
        run_study(study(LINES.format(line) + "repeats: 2\n"), tmp_path / "out", 1)


def test_a_folder_that_is_moved_while_the_study_runs_stops_it(study, sequences, tmp_path):
    spec, out, moved = study(LINES.format(sequences[0]) + "repeats: 50\n"), tmp_path / "out", tmp_path / "moved"

    def move(progress):
        if progress.done == 2 and not moved.exists():
            out.rename(moved)

    with pytest.raises(OutputError, match=r"out was moved or removed; start the study again where it is now$"):
        run_study(spec, out, 1, on_progress=move)
    assert len(StudyFolder(moved).finished_runs()) >= 2
    assert not (out / "runs.parquet").exists()


def test_the_copy_of_a_study_without_its_lock_goes_on(lines, tmp_path):
    run_study(lines, tmp_path / "out", 1)
    (tmp_path / "out" / "study.lock").unlink()
    assert len(run_study(lines, tmp_path / "out", 1).runs) == 2


def test_without_a_cluster_nothing_is_begun(lines, tmp_path, monkeypatch):
    def none(*_):
        raise OutputError("no cluster")

    monkeypatch.setattr("slamgym.study.run.DaskPool", none)
    with pytest.raises(OutputError, match="no cluster"):
        run_study(lines, tmp_path / "out", dask="tcp://127.0.0.1:9")
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["study.lock"]


def _write_room(path, side_m):
    """An empty square room."""
    import trimesh

    room = trimesh.creation.box((side_m, side_m, 2.5))
    room.apply_translation((0, 0, 1.25))
    room.invert()
    room.export(path)
