import os
import random
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pandas as pd
import pytest
import yaml

from slamgym.errors import ConfigError, OutputError
from slamgym.study.run import run_study
from slamgym.study.spec import read_study
from slamgym.study.table import open_study

HERE = Path(__file__).parent

DRIVES = """
name: drives
paths: [{scene: procedural:1, seeds: [1, 2]}]
fixed: {camera: small, path_length_m: 0.6, speed: 1.0, lighting: flat, scene_options: {size: small}}
factors: [{slam: [groundtruth, wheel_odometry]}]
"""


def lines(sequences, repeats=2, slams="groundtruth, wheel_odometry", more=""):
    """A study over recorded sequences."""
    return f"""
name: lines
description: Straight lines.
paths: [{{sequence: [{", ".join(map(str, sequences))}]}}]
factors: [{{slam: [{slams}]}}]
repeats: {repeats}
{more}
"""


@pytest.fixture(scope="module")
def whole(sequences, tmp_path_factory):
    """Two lines, each run twice through two SLAMs, without any interruption."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "study.yaml").write_text(lines(sequences[:2]))
    return run_study(read_study(folder / "study.yaml"), folder / "out", 2)


def same_but_for_times(one, other):
    """Whether two studies came to the same table; times are what else a repeated run may differ in."""
    without = (table.loc[:, ~table.columns.str.startswith("timing.")] for table in (one.runs, other.runs))
    pd.testing.assert_frame_equal(*without)


def files(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def run_folders(folder):
    """Every finished run, and when it was put in its place."""
    return {path: path.stat().st_ctime_ns for path in (folder / "runs").glob("*/[!.]*")}


@pytest.fixture
def deadly(faulty, monkeypatch):
    monkeypatch.syspath_prepend(str(HERE))
    faulty("Healthy")


def test_a_study_renders_each_drive_once_and_runs_every_slam_over_it(study, tmp_path):
    told, out = [], tmp_path / "out"
    done = run_study(study(DRIVES), out, 2, on_progress=told.append)
    runs = done.runs
    assert (done.name, done.factors, done.planned, len(runs)) == ("drives", ("slam",), 4, 4)
    assert runs[["status", "seed", "slam"]].to_numpy().tolist() == [
        ["ok", 1, "groundtruth"],
        ["ok", 1, "wheel_odometry"],
        ["ok", 2, "groundtruth"],
        ["ok", 2, "wheel_odometry"],
    ]
    assert (runs["frames_fed"] > 10).all()
    assert len(list((out / "drives").iterdir())) == 2
    assert {path.name for path in out.iterdir()} == {
        *("study.yaml", "plan.json", "runs", "drives", "runs.parquet", "study.lock")
    }
    assert (told[0].done, told[-1].done, told[-1].planned, told[-1].failed) == (0, 4, 4, 0)
    assert told[0].seconds_left > 0
    assert told[-1].seconds_left == pytest.approx(0, abs=1e-6)
    same_but_for_times(open_study(out), done)


def test_what_is_done_is_not_done_again_and_a_study_may_grow(study, sequences, whole, tmp_path):
    out = tmp_path / "out"
    first = run_study(study(lines(sequences[:1], repeats=1)), out, 2)
    before = run_folders(out)
    assert len(before) == first.planned == 2
    same_but_for_times(run_study(study(lines(sequences[:1], repeats=1)), out, 2), first)
    assert run_folders(out) == before
    grown = run_study(study(lines(sequences[:2], repeats=2)), out, 2)
    after = run_folders(out)
    assert {path: after[path] for path in before} == before
    assert len(after) == 8
    same_but_for_times(grown, whole)
    assert files(out) == files(whole.folder)
    removed = next(iter(after))
    shutil.rmtree(removed)
    assert len(run_study(study(lines(sequences[:2], repeats=2)), out, 2).runs) == 8
    again = run_folders(out)
    assert [path for path in again if again[path] != after[path]] == [removed]
    with pytest.raises(OutputError, match="6 of its 8 are not in this one"):
        run_study(study(lines(sequences[:1], repeats=1)), out)


@pytest.mark.parametrize("kills", [2, pytest.param(20, marks=pytest.mark.slow)])
def test_a_study_that_is_killed_at_any_moment_loses_and_repeats_nothing(
    study, sequences, started, tmp_path, kills, wait_until
):
    text = DRIVES.replace("paths: [", f"paths: [{{sequence: {sequences[0]}}}, ")
    spec = study(f"{text}repeats: {1 if kills < 20 else 10}")
    begin = time.monotonic()
    whole = run_study(spec, tmp_path / "whole", 2)
    took_s = time.monotonic() - begin
    out, rng = tmp_path / "out", random.Random(kills)
    finished: dict[Path, int] = {}
    for _ in range(kills):
        one = started(tmp_path / "study.yaml", out)
        wait_until(lambda one=one: one.process.poll() is not None, rng.uniform(1.0, 1.5 * took_s / kills + 4.0))
        one.kill()
        assert one.orphans() == []
        now = run_folders(out)
        assert finished.items() <= now.items()
        finished = now
    last = started(tmp_path / "study.yaml", out)
    output, _ = last.process.communicate(timeout=300)
    assert (last.process.returncode, last.pids()) == (0, set()), output
    assert finished.items() <= run_folders(out).items()
    same_but_for_times(open_study(out), whole)
    assert files(out) == files(tmp_path / "whole")


def test_two_studies_in_one_folder_at_once_are_refused(study, sequences, started, tmp_path, wait_until):
    spec, out = study(lines(sequences, repeats=100)), tmp_path / "out"
    first = started(tmp_path / "study.yaml", out)
    assert wait_until((out / "runs").exists, 60)
    with pytest.raises(OutputError, match=rf"a study runs there already \(process {first.process.pid} on"):
        run_study(spec, out)
    while_it_runs = open_study(out)
    assert while_it_runs.planned == 600
    assert len(while_it_runs.runs) < 600
    assert first.process.poll() is None


def test_interrupt_stops_soon_and_keeps_what_is_done(study, sequences, started, tmp_path, wait_until):
    study(lines(sequences, repeats=50))
    one, out = started(tmp_path / "study.yaml", tmp_path / "out"), tmp_path / "out"
    assert wait_until(lambda: len(run_folders(out)) > 3, 60)
    os.killpg(one.process.pid, signal.SIGINT)  # as the terminal does: to all processes
    output, _ = one.process.communicate(timeout=30)
    assert one.process.returncode == -signal.SIGINT
    assert output.strip().endswith("KeyboardInterrupt")
    assert output.count("Traceback") == 1  # none of the workers'
    assert one.orphans() == []
    done = set(pd.read_parquet(out / "runs.parquet")["run_id"])
    assert done == {f"{path.parent.name}/{path.name}" for path in run_folders(out)}
    assert not [name for name in files(out) if "/." in name]


def test_a_run_that_kills_its_worker_twice_is_crashed_and_no_other_is(study, sequences, deadly, tmp_path):
    spec = study(lines(sequences[:2], 1, "groundtruth, 'deadly_backends:KillsItsWorker'"))
    done = run_study(spec, tmp_path / "out", 2)
    runs = done.runs
    dead = runs["slam"] == "deadly_backends:KillsItsWorker"
    assert runs["status"].tolist() == ["ok", "crashed"] * 2
    assert runs["success"].astype(bool).tolist() == (~dead).tolist() == [True, False] * 2
    assert runs["failure"][dead].str.contains("its worker process ended whenever it was tried").all()
    assert (runs["completion"][dead] == 0).all()
    run_folder = tmp_path / "out" / "runs" / runs["run_id"][dead].iloc[0]
    assert {path.name for path in run_folder.iterdir()} == {"config.yaml", "episode.json", "planned.json"}
    assert yaml.safe_load((run_folder / "config.yaml").read_text())["slam"] == "deadly_backends:KillsItsWorker"
    same_but_for_times(run_study(spec, tmp_path / "out", 2), done)


def test_runs_of_a_drive_that_kills_its_worker_cannot_be_run(study, sequences, deadly, tmp_path, monkeypatch):
    package = tmp_path / "site" / "deadly-1.0.dist-info"
    package.mkdir(parents=True)
    (package / "METADATA").write_text("Metadata-Version: 2.1\nName: deadly\nVersion: 1.0\n")
    (package / "entry_points.txt").write_text("[slamgym.scenes]\ndeadly = deadly_scene:Deadly\n")
    monkeypatch.syspath_prepend(str(package.parent))
    text = lines(sequences[:1], 1).replace("paths: [", "paths: [{scene: deadly:1, seeds: 1}, ")
    runs = run_study(study(text), tmp_path / "out", 2).runs
    assert runs["status"].tolist() == ["not_run"] * 2 + ["ok"] * 2
    assert runs["failure"][:2].str.startswith("the drive could not be rendered: its worker process ended").all()


def test_a_worker_that_dies_once_costs_nothing(study, sequences, deadly, tmp_path):
    marker = tmp_path / "marker"
    more = f"fixed: {{slam_options: {{marker: '{marker}'}}}}"
    runs = run_study(
        study(lines(sequences[:1], 2, "'deadly_backends:KillsItsWorkerOnce'", more)), tmp_path / "out"
    ).runs
    assert marker.exists()
    assert runs["status"].tolist() == ["ok"] * 2


def test_runs_that_cannot_be_begun_are_told_and_tried_again(study, sequences, tmp_path):
    spec = study(lines(sequences[:2], repeats=1))
    broken = next((sequences[1] / "rgb").iterdir())
    content = broken.read_bytes()
    broken.write_bytes(b"no image")
    try:
        runs = run_study(spec, tmp_path / "out", 2).runs
    finally:
        broken.write_bytes(content)
    assert runs["status"].tolist() == ["ok"] * 2 + ["not_run"] * 2
    assert runs["failure"][2:].str.contains("line1/rgb").all()
    assert runs["success"][2:].isna().all()
    assert run_study(spec, tmp_path / "out", 2).runs["status"].tolist() == ["ok"] * 4


@pytest.fixture
def small_disk(tmp_path):
    """A function that mounts a file system of its own; needs root."""
    mounted = []

    def mount(options):
        place = tmp_path / "disk"
        place.mkdir(exist_ok=True)
        command = ["mount", *(["-t", "tmpfs"] if not mounted else []), "-o", options, "tmpfs", str(place)]
        if subprocess.run(command, capture_output=True).returncode:
            pytest.skip("expected to be allowed to mount a file system")
        mounted.append(place)
        return place

    yield mount
    if mounted:
        subprocess.run(["umount", str(mounted[0])], check=True)


def test_a_full_disk_stops_the_study_and_loses_nothing(study, sequences, small_disk, whole):
    spec, place = study(lines(sequences[:2])), small_disk("size=1000k")
    with pytest.raises(OutputError, match=r"No space left on device.+of 8 runs are done and stay") as stopped:
        run_study(spec, place, 2)
    assert "\n" not in str(stopped.value)
    finished = run_folders(place)
    assert 0 < len(finished) < 8
    assert not [name for name in files(place) if "/." in name]
    small_disk("remount,size=100m")
    done = run_study(spec, place, 2)
    assert finished.items() <= run_folders(place).items()
    same_but_for_times(done, whole)


def test_a_folder_that_cannot_be_written_is_refused_before_anything_runs(study, sequences, small_disk):
    place = small_disk("ro")
    with pytest.raises(OutputError, match="cannot write in"):
        run_study(study(lines(sequences)), place)
    with pytest.raises(OutputError, match="cannot write in"):
        run_study(study(lines(sequences)), place / "new")


@pytest.mark.parametrize(
    ("options", "message"), [({"workers": 0}, "at least 1"), ({"workers": 1, "dask": "a"}, "none")]
)
def test_bad_numbers_of_workers(study, sequences, tmp_path, options, message):
    with pytest.raises(ConfigError, match=message):
        run_study(study(lines(sequences)), tmp_path / "out", **options)
    assert not (tmp_path / "out").exists()
