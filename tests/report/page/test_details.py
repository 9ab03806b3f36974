import json
import shutil
from dataclasses import replace

import pandas as pd
import pytest

from slamgym.report.page import details as module
from slamgym.report.page.details import details
from slamgym.report.page.run_files import read_run


@pytest.fixture
def many(results, tmp_path):
    """Ten runs: the first eight without a loss, the last two with two each; one more of which there is nothing."""
    folder = tmp_path / "study"
    shutil.copytree(results.folder / "drives", folder / "drives")
    rows = [0] * 8 + [1] * 2 + [3]
    runs = results.runs.iloc[rows].reset_index(drop=True)
    runs["run_id"] = [f"home-7/copy {k}" for k in range(len(rows))]
    for k, row in enumerate(rows[:-1]):
        shutil.copytree(results.folder / "runs" / results.runs["run_id"][row], folder / "runs" / f"home-7/copy {k}")
    return replace(results, folder=folder, runs=runs)


def test_failed_runs_come_first_and_a_run_without_a_folder_is_left_out(many, tmp_path):
    assert [detail.row for detail in details(many, tmp_path)] == [8, 9, *range(8)]


def test_runs_without_room_are_left_out(many, tmp_path, monkeypatch):
    every = list(details(many, tmp_path))
    room = sum(len(detail.html) for detail in every[:4]) + 10
    monkeypatch.setattr(module, "ROOM", room)
    monkeypatch.setattr(module, "KEPT_ROOM", 0)
    assert [detail.row for detail in details(many, tmp_path)] == [8, 9, 0, 1]
    # The one that could not be run counts.
    monkeypatch.setattr(module, "MOST_RUNS", 4)
    assert [detail.row for detail in details(many, tmp_path)] == [8, 9, 0]


def test_strips_without_room_are_linked(many, tmp_path, monkeypatch):
    first, *_ = details(many, tmp_path)
    assert first.html.count('<img src="data:image/jpeg') == 2
    monkeypatch.setattr(module, "KEPT_ROOM", module.ROOM)
    first, *_ = details(many, tmp_path)
    assert "data:image/jpeg" not in first.html
    assert '<a href="study/runs/home-7/copy%208/losses/1.jpg">' in first.html


def test_a_crashed_run_says_why(results, tmp_path):
    crashed = next(detail for detail in details(results, tmp_path) if detail.row == 2)
    assert json.loads((results.folder / "runs/home-7/3/episode.json").read_text())["failure"]
    assert '<p class="failure">' in crashed.html


def test_a_minimal_run_folder_has_figures_only(results, tmp_path):
    """What is written of a run that ended its worker process."""
    folder = tmp_path / "runs" / "a" / "1"
    folder.mkdir(parents=True)
    (folder / "episode.json").write_text(json.dumps({"status": "crashed", "failure": "gone", "losses": []}))
    runs = pd.DataFrame({"run_id": ["a/1"], "drive_id": ["a"], "status": ["crashed"], "success": [False]})
    (only,) = details(replace(results, folder=tmp_path, runs=runs), tmp_path)
    assert "gone" in only.html
    assert "<svg" not in only.html


@pytest.mark.parametrize(
    ("file", "content"),
    [
        ("episode.json", "{"),
        ("frames.csv", "stamp_ns\nx\n"),
        ("frames.csv", '"'),
        ("poses.csv", "\x00\xff"),
    ],
)
def test_an_unreadable_run_folder_is_left_out(file, content, many):
    folder = many.folder / "runs" / "home-7" / "copy 8"
    assert read_run(folder) is not None
    (folder / file).write_bytes(content.encode("latin-1"))
    assert read_run(folder) is None


def test_what_is_read_is_what_was_run(results):
    """80 frames at 30 a second of a drive at 0.8 m/s: lost from frame 40 to 51, and at frame 60, in two maps."""
    run = read_run(results.folder / "runs" / "home-7" / "2")
    lost = [k for k, state in enumerate(run.states) if state == "lost"]
    assert lost == [*range(40, 52), 60]
    assert set(run.map_ids[:40]) == {0}
    assert set(run.map_ids[52:60]) == {1}
    assert run.fed_s[30] == pytest.approx(1.0)
    assert run.speed_mps.max() == pytest.approx(0.8)
    assert run.flat
