import json
import shutil

import pandas as pd
import pytest

from slamgym.cli import main


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    folder = tmp_path_factory.mktemp("recorded") / "drive"
    main(f"record --out {folder} --seed 7 --camera small --speed 1.0 --path-length-m 1.5".split())
    return folder


def refused(arguments, capsys):
    """The one line that a command ends with on bad input."""
    with pytest.raises(SystemExit) as ended:
        main([str(word) for word in arguments])
    assert ended.value.code == 2
    (line,) = [line for line in capsys.readouterr().err.splitlines() if line.strip()]
    return line


def test_recorded_folder_is_a_tum_sequence(recorded):
    assert {"rgb", "depth", "rgb.txt", "depth.txt", "associations.txt", "groundtruth.txt", "camera.yaml"} <= {
        path.name for path in recorded.iterdir()
    }


def test_replay_writes_a_folder_for_each_run_and_a_table_of_all(recorded, tmp_path, capsys):
    out = tmp_path / "out"
    main(["replay", str(recorded), "--slam", "groundtruth", "--stride", "1", "--repeats", "2", "--out", str(out)])
    printed = capsys.readouterr().out
    assert "2 of 2 runs without a failure" in printed
    assert "100.0%" in printed  # completion stands beside the ATE, always
    table = pd.read_csv(out / "runs.csv")
    assert table[["sequence", "run", "status"]].to_numpy().tolist() == [["drive", 1, "ok"], ["drive", 2, "ok"]]
    for run in (1, 2):
        assert json.loads((out / "drive" / str(run) / "episode.json").read_text())["completion"] == 1.0


def test_published_figure_stands_beside_ours(recorded, tmp_path, capsys):
    folder = tmp_path / "rgbd_dataset_freiburg1_desk"
    shutil.copytree(recorded, folder)
    main(["replay", str(folder), "--slam", "groundtruth", "--out", str(tmp_path / "out")])
    printed = capsys.readouterr().out
    assert "0.016" in printed
    assert "ORB-SLAM2 over the whole fr1/desk" in " ".join(printed.split())


def test_losses_are_told_with_their_reasons(recorded, tmp_path, capsys, faulty):
    main(["replay", str(recorded), "--slam", faulty("Segfaults"), "--out", str(tmp_path / "out")])
    printed = " ".join(capsys.readouterr().out.split())
    why = "its process was ended by signal 11 (Segmentation fault) at frame 2"
    assert "drive, run 1: lost at 0.07 s" in printed
    assert f"to the end: {why}" in printed


def test_runs_that_were_done_before_an_error_are_kept_and_shown(recorded, tmp_path, capsys):
    damaged = tmp_path / "damaged"
    shutil.copytree(recorded, damaged)
    sorted((damaged / "rgb").iterdir())[20].write_bytes(b"no image")
    out = tmp_path / "out"
    with pytest.raises(SystemExit):
        main(["replay", str(recorded), str(damaged), "--slam", "groundtruth", "--out", str(out)])
    printed = capsys.readouterr()
    assert "100.0%" in printed.out
    assert "damaged/rgb" in printed.err.replace("\n", "")
    assert pd.read_csv(out / "runs.csv")["sequence"].tolist() == ["drive"]


def test_real_sequence(shared_data, tmp_path, capsys):
    sequence, out = shared_data / "tum_fr1_xyz_100", tmp_path / "out"
    main(["replay", str(sequence), "--out", str(out)])
    assert "0.010" in capsys.readouterr().out
    (run,) = pd.read_csv(out / "runs.csv").to_dict("records")
    assert (run["status"], run["completion"], run["loss_count"]) == ("ok", 1.0, 0)
    assert 0.010 < run["ate_rmse_m"] < 0.014


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--out", "OUT"], "expected at least one sequence"),
        (["NOWHERE", "--out", "OUT"], "NOWHERE"),
        (["DRIVE", "DRIVE", "--out", "OUT"], "different names"),
        (["DRIVE", "--repeats", "0", "--out", "OUT"], "at least 1 repeat"),
        (["DRIVE", "--camera", "tum_fr4", "--out", "OUT"], "tum_fr4"),
        (["DRIVE", "--slam", "orbslam", "--out", "OUT"], "did you mean 'orbslam"),
        (["DRIVE", "--slam-sync", "real", "--out", "OUT"], "did you mean 'realtime'"),
        (["DRIVE", "--map-policy", "last", "--out", "OUT"], "map_policy"),
        (["DRIVE", "--out", "DRIVE"], "new or empty"),
        (["DRIVE", "--slam-options", "a", "1", "--slam-options", "b", "2", "--out", "OUT"], "expected it once"),
        (["DRIVE", "--slam-options", "baseline", "inf", "--out", "OUT"], "finite"),
    ],
)
def test_bad_input_is_told_in_one_line(recorded, tmp_path, capsys, arguments, message):
    words = {"DRIVE": str(recorded), "OUT": str(tmp_path / "out"), "NOWHERE": str(tmp_path / "NOWHERE")}
    assert message in refused(["replay", *(words.get(word, word) for word in arguments)], capsys)
    assert not (tmp_path / "out").exists()
