import os
import re
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from slamgym.camera import PinholeCamera
from slamgym.cli import main
from slamgym.eval.datasets import SequenceWriter
from slamgym.study.table import open_study
from slamgym.types import Frame

CAMERA = PinholeCamera(80, 60, 60.0, 60.0, 39.5, 29.5)


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """A study over one recorded sequence of 20 frames."""
    folder = tmp_path_factory.mktemp("study")
    with SequenceWriter(folder / "data" / "line", CAMERA, 20.0) as writer:
        for k in range(20):
            T_world_cam = np.eye(4)
            T_world_cam[0, 3] = 0.02 * k
            rgb, depth = np.zeros((60, 80, 3), np.uint8), np.full((60, 80), 2.0, np.float32)
            writer.add(Frame(k * 50_000_000, rgb, depth, T_world_cam))
    file = folder / "study.yaml"
    file.write_text(
        "name: small\npaths: [{sequence: data/line}]\nfactors: [{slam: [groundtruth, opencv]}]\n"
        "sizes: {one: {repeats: 1}, many: {repeats: 100}}\n"
    )
    return file


def refused(arguments, capsys):
    """The one line that a command ends with on bad input."""
    with pytest.raises(SystemExit) as ended:
        main([str(word) for word in arguments])
    assert ended.value.code == 2
    (line,) = [line for line in capsys.readouterr().err.splitlines() if line.strip()]
    return line


def test_a_study_ends_with_a_table_and_a_report(file, tmp_path, capsys):
    out = tmp_path / "out"
    main(["study", str(file), "--out", str(out)])
    printed = capsys.readouterr().out
    assert re.search(r"all +2 +50\.0%", printed)
    assert re.search(r"SLAM groundtruth +1 +100\.0% +0\.0000 +100\.0% +1 ok", printed)
    assert re.search(r"SLAM opencv +1 +0\.0% +- +0\.0% +1 init_failed", printed)  # black images; no ATE to speak of
    assert "report.html" in printed.replace("\n", "")
    assert (out / "report.html").exists()
    main(["study", str(file), "--out", str(out)])  # nothing is left to do
    assert "report.html" in capsys.readouterr().out.replace("\n", "")


def test_a_dry_run_tells_and_does_nothing(file, tmp_path, capsys):
    main(["study", str(file), "--size", "many", "--out", str(tmp_path / "out"), "--dry-run", "--workers", "2"])
    told = " ".join(capsys.readouterr().out.split())
    assert "small: 1 drives, about 0 frames to render; 200 runs over about 4,000 frames" in told
    assert re.search(r"about \d+:\d\d:\d\d with 2 workers, about 0\.\d GB of disk", told)
    assert not (tmp_path / "out").exists()


def test_after_an_interrupt_it_says_how_to_go_on(file, tmp_path):
    out = tmp_path / "out"
    words = [sys.executable, "-m", "slamgym.cli", "study", file, "--size", "many", "--out", out]
    with subprocess.Popen(words, stderr=subprocess.PIPE, start_new_session=True, text=True) as process:
        deadline = time.monotonic() + 120
        while len(list(out.glob("runs/*/[!.]*"))) < 2 and time.monotonic() < deadline:
            time.sleep(0.05)
        os.killpg(process.pid, signal.SIGINT)
        told = process.communicate(timeout=60)[1]
    assert process.returncode == 130
    (line,) = told.strip().splitlines()
    done = len(open_study(out).runs)
    assert done >= 2
    assert line == f"interrupted; {done} of 200 runs are done and stay: the same line goes on"


def test_why_nothing_could_be_run_is_told(file, tmp_path, capsys):
    shutil.copytree(file.parent, tmp_path / "copy")
    for image in (tmp_path / "copy" / "data" / "line" / "rgb").iterdir():
        image.write_bytes(b"no image")
    main(["study", str(tmp_path / "copy" / "study.yaml"), "--out", str(tmp_path / "out")])
    printed = capsys.readouterr().out
    assert re.search(r"all +0 +-", printed)
    assert "2 runs could not be run, and are tried again by the same line: the drive could not be" in printed


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["NOWHERE.yaml", "--out", "OUT"], "NOWHERE.yaml"),
        (["quik", "--out", "OUT"], "did you mean 'quick'"),
        (["FILE", "--size", "larg", "--out", "OUT"], "larg"),
        (["FILE", "--workers", "0", "--out", "OUT"], "expected at least 1"),
        (["FILE", "--workers", "-1", "--out", "OUT", "--dry-run"], "expected at least 1, got -1"),
        (["FILE", "--workers", "1", "--dask", "a", "--out", "OUT", "--dry-run"], "where a cluster has its own"),
        (["FILE", "--workers", "1", "--dask", "tcp://127.0.0.1:9", "--out", "OUT"], "where a cluster has its own"),
        (["FILE", "--dask", "nowhere", "--out", "OUT"], "expected the address of a Dask scheduler, got 'nowhere'"),
        (["FILE", "--out", "TAKEN"], "expected a new or empty folder"),
        (["FILE", "--sequences", "NOWHERE", "--out", "OUT"], "NOWHERE"),
    ],
)
def test_bad_input_is_told_in_one_line(file, tmp_path, capsys, arguments, message):
    words = {"FILE": file, "OUT": tmp_path / "out", "TAKEN": file.parent, "NOWHERE": tmp_path / "NOWHERE"}
    assert message in refused(["study", *(words.get(word, word) for word in arguments)], capsys)
    assert not list(tmp_path.glob("out/runs/*"))
