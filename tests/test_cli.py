import json
import os
import pty
import select
import signal
import subprocess
import sys
import time

import pandas as pd
import pytest
import yaml

from slamgym.cli import main

FAST = ["--camera", "small", "--path-length-m", "1.5", "--speed", "0.5"]
FILES = {
    "config.yaml", "episode.json", "groundtruth.txt", "estimate.txt", "fed_frames.txt", "frames.csv", "poses.csv",
    "map.png", "slam.log",
}  # fmt: skip


def test_run_writes_a_complete_folder(tmp_path, capsys):
    folder = tmp_path / "deep" / "run"
    main(["run", "--seed", "7", "--stride", "1", "--out", str(folder), *FAST])
    printed = capsys.readouterr().out
    assert str(folder) in printed.replace("\n", "")
    assert {file.name for file in folder.iterdir()} == FILES
    result = json.loads((folder / "episode.json").read_text())
    assert result["status"] == "ok"
    assert result["completion"] == 1.0
    assert result["ate_rmse_m"] < 0.05
    config = yaml.safe_load((folder / "config.yaml").read_text())
    assert (config["speed"], config["stride"], config["slam"], config["camera"]["width"]) == (0.5, 1, "orbslam3", 320)
    frames = pd.read_csv(folder / "frames.csv")
    truth = pd.read_csv(folder / "groundtruth.txt", sep=" ", comment="#", header=None)
    estimate = pd.read_csv(folder / "estimate.txt", sep=" ", comment="#", header=None)
    assert len(frames) == len(truth)
    assert frames["slam_state"].notna().sum() == result["frames_fed"] == len(estimate)
    assert set(estimate[0]) <= set(truth[0])
    assert (folder / "map.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--scene", "procedurl"], "did you mean 'procedural'"),
        (["--slam", "orbslam"], "did you mean 'orbslam3'"),
        (["--slam-sync", "lock"], "did you mean 'lockstep'"),
        (["--agent", "patroll"], "did you mean 'patrol'"),
        (["--speed", "-1"], "speed: the value should be greater than 0, got '-1'"),
        (["--speed", "nan"], "finite"),
        (["--speed", "fast"], "speed: the value should be a valid number"),
        (["--loop-closure", "maybe"], "loop_closure"),
        (["--stride", "-1"], "got '-1'"),
        (["--seed", "-1"], "seed of at least 0"),
        (["--slam-options", "vocabulary", "/nonexistent/voc.txt"], "/nonexistent/voc.txt"),
        (["--slam-options", "features", "many"], "features"),
        (["--path-length-m", "0"], "path_length_m"),
    ],
)
def test_bad_input_is_one_line_and_leaves_nothing(arguments, message, tmp_path, capsys):
    with pytest.raises(SystemExit) as stopped:
        main(["run", "--out", str(tmp_path / "run"), *FAST, *arguments])
    assert stopped.value.code == 2
    error = capsys.readouterr().err.strip()
    assert message in error
    assert len(error.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


def test_a_filled_or_unwritable_folder_is_refused_before_the_drive(tmp_path, capsys):
    (tmp_path / "kept.txt").write_text("mine")
    for out, message in [
        (tmp_path, "new or empty"),
        (".", "new or empty"),
        (tmp_path / "kept.txt" / "run", "cannot write"),
    ]:
        with pytest.raises(SystemExit) as stopped:
            main(["run", "--out", str(out), *FAST])
        assert stopped.value.code == 2
        assert message in capsys.readouterr().err
    assert (tmp_path / "kept.txt").read_text() == "mine"


def test_missing_egl_is_one_line(tmp_path):
    result = subprocess.run(
        [sys.executable, "-m", "slamgym.cli", "run", "--out", str(tmp_path / "run"), *FAST],
        env={**os.environ, "__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent"},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert result.returncode == 2
    assert "libegl1" in result.stderr
    assert "Traceback" not in result.stderr
    assert list(tmp_path.iterdir()) == []


def wait_for(terminal, word, limit_s=120):
    shown = ""
    deadline = time.monotonic() + limit_s
    while word not in shown and time.monotonic() < deadline:
        if select.select([terminal], [], [], 1.0)[0]:
            shown += os.read(terminal, 4096).decode(errors="ignore")
    assert word in shown


def test_interrupt_keeps_what_is_done_and_leaves_no_process(tmp_path, children):
    before = children()
    out = tmp_path / "run"
    terminal, stderr = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "slamgym.cli", "run", "--out", str(out), "--camera", "small", "--speed", "0.1"],
        env={**os.environ, "TERM": "xterm"},
        stdout=subprocess.DEVNULL,
        stderr=stderr,
        start_new_session=True,
    )
    os.close(stderr)
    try:
        wait_for(terminal, "driving")
        time.sleep(1.0)
        os.killpg(process.pid, signal.SIGINT)
        process.wait(timeout=60)
    finally:
        process.kill()
        os.close(terminal)
    assert process.returncode == 130
    assert not out.exists()
    kept = tmp_path / "run.interrupted"
    assert {file.name for file in kept.iterdir()} == FILES
    result = json.loads((kept / "episode.json").read_text())
    assert (result["end"], result["status"], result["completion"]) == ("interrupted", "ok", 1.0)
    assert result["frames_fed"] == len(pd.read_csv(kept / "estimate.txt", comment="#", header=None))
    assert children() == before
