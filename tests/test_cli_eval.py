import csv
import io
import json
import os
import subprocess
import sys

import numpy as np
import pytest

from slamgym.cli import main
from slamgym.eval.trajectories import Trajectory, write_tum
from slamgym.geometry import mast_camera_pose


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A drive of 10 s at 10 Hz: its truth, a good estimate, one that is lost for 3 s, one that never initialised."""
    yaw = 0.05 * np.arange(100)
    xy = np.cumsum(0.1 * np.column_stack([np.cos(yaw), np.sin(yaw)]), axis=0)
    T = np.array([mast_camera_pose(*xy[i], yaw[i], 1.0) for i in range(100)])
    stamps_ns = np.arange(100, dtype=np.int64) * 100_000_000 + 1_700_000_000_000_000_000
    lost = np.r_[0:40, 70:100]
    write_tum(tmp_path / "truth.txt", Trajectory(stamps_ns, T))
    write_tum(tmp_path / "good.txt", Trajectory(stamps_ns, T))
    write_tum(tmp_path / "lost.txt", Trajectory(stamps_ns[lost], T[lost]))
    (tmp_path / "never.txt").write_text("# timestamp tx ty tz qx qy qz qw\n")
    (tmp_path / "rgb.txt").write_text("".join(f"{stamp / 1e9:.6f} rgb/{stamp}.png\n" for stamp in stamps_ns))
    (tmp_path / "poses.kitti").write_text("".join(" ".join(map(repr, t[:3].ravel().tolist())) + "\n" for t in T))
    (tmp_path / "times.txt").write_text("".join(f"{stamp / 1e9:.6f}\n" for stamp in stamps_ns))
    (tmp_path / "nan.txt").write_text((tmp_path / "good.txt").read_text().replace(" 0.100000000 ", " nan ", 1))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def rows_of(printed):
    """First word of each line of the table -> the others."""
    return {line.split()[0]: line.split()[1:] for line in printed.splitlines() if ".txt " in line[:24]}


def test_table_shows_completion_beside_every_ate(folder, capsys):
    main(["eval", "truth.txt", "good.txt", "lost.txt", "never.txt", "--frames", "rgb.txt"])
    captured = capsys.readouterr()
    rows = rows_of(captured.out)
    assert rows["good.txt"][:7] == ["ok", "100.0%", "0", "100.0%", "100", "0.0000", "0.0000"]
    # 69 of the 99 steps begin with a pose. Held at x = 1.9 m or so for 3 s: that is no small error.
    assert rows["lost.txt"][:6] == ["ok", "70.0%", "1", "69.6%", "70", "0.0000"]
    assert 0.5 < float(rows["lost.txt"][6]) < 1.5
    assert rows["never.txt"][:6] == ["init_failed", "0.0%", "-", "0.0%", "0", "-"]
    assert "of the 100 frames of rgb.txt" in captured.out
    assert "se3 alignment" in captured.out
    assert max(map(len, captured.out.splitlines())) <= 100
    assert captured.err == ""


def test_without_frames_the_caption_says_which_gaps_count_as_tracked(folder, capsys):
    main(["eval", "truth.txt", "lost.txt", "--alignment", "sim3"])
    printed = capsys.readouterr().out
    assert rows_of(printed)["lost.txt"][:5] == ["ok", "70.0%", "1", "78.7%", "70"]
    assert "in a gap of up to 0.5 s" in printed
    assert rows_of(printed)["lost.txt"][-1] == "1"  # the scale
    assert "give the frames" in printed


def test_a_narrow_terminal_cuts_no_figure(folder, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    main(["eval", "truth.txt", "lost.txt", "--frames", "rgb.txt"])
    assert rows_of(capsys.readouterr().out)["lost.txt"][:2] == ["ok", "70.0%"]


def test_names_are_shown_as_they_are_and_steer_nothing(folder, capsys):
    good = (folder / "good.txt").read_text()
    for name in ("a[red]b.txt", "esc\x1b[31m.txt", "two\nlines.txt", "a_very_long_name_of_a_file.txt"):
        (folder / name).write_text(good.replace(" 0.100000000 ", " nan ", 1))
    (folder / "other").mkdir()
    (folder / "other" / "good.txt").write_text(good)
    names = ["a[red]b.txt", "esc\x1b[31m.txt", "two\nlines.txt", "a_very_long_name_of_a_file.txt"]
    main(["eval", "truth.txt", *names])
    captured = capsys.readouterr()
    assert "a[red]b.txt" in captured.out
    assert "two lines.txt" in captured.out
    assert "a_very_l…_file.txt" in captured.out
    assert "\x1b[31m" not in captured.out + captured.err
    assert len(captured.err.splitlines()) == len(names)
    main(["eval", "truth.txt", "good.txt", "other/good.txt", "--csv"])
    main(["eval", "truth.txt", "good.txt", "other/good.txt"])
    assert "other/good.txt" in rows_of(capsys.readouterr().out)


def test_json_is_a_list_with_one_object_an_estimate(folder, capsys):
    main(["eval", "truth.txt", "lost.txt", "never.txt", "--json", "--alignment", "first_pose"])
    lost, never = json.loads(capsys.readouterr().out)
    assert (lost["estimate"], lost["groundtruth"], lost["alignment"]) == ("lost.txt", "truth.txt", "first_pose")
    assert (lost["frames_file"], lost["max_gap_s"]) == (None, 0.5)
    assert (lost["status"], lost["completion"], lost["loss_count"]) == ("ok", 0.7, 1)
    assert lost["losses"][0]["duration_s"] == pytest.approx(3.0)
    assert (never["status"], never["ate_rmse_m"]) == ("init_failed", None)


def test_csv_has_a_line_an_estimate(folder, capsys):
    main(["eval", "truth.txt", "good.txt", "lost.txt", "--csv"])
    good, lost = csv.DictReader(io.StringIO(capsys.readouterr().out))
    assert (good["estimate"], good["completion"], lost["completion"]) == ("good.txt", "1.0", "0.7")
    assert float(lost["ate_rmse_m"]) < 1e-6
    assert "losses" not in lost
    assert lost["loss_count"] == "1"


def test_formats_are_told_by_their_content(folder, capsys):
    main(["eval", "poses.kitti", "poses.kitti", "--times", "times.txt", "--json"])
    (row,) = json.loads(capsys.readouterr().out)
    assert (row["completion"], row["matched"]) == (1.0, 100)
    # One KITTI file beside one with stamps of its own: the times are for the first only.
    main(["eval", "truth.txt", "poses.kitti", "--times", "times.txt", "--json"])
    (row,) = json.loads(capsys.readouterr().out)
    assert row["ate_rmse_m"] < 1e-6


def test_bad_lines_are_repaired_with_a_warning_or_refused(folder, capsys):
    main(["eval", "truth.txt", "nan.txt", "--frames", "rgb.txt", "--json"])
    captured = capsys.readouterr()
    assert json.loads(captured.out)[0]["completion"] == 0.99
    assert captured.err.startswith("slamgym: warning: nan.txt:2: ")
    assert len(captured.err.splitlines()) == 1
    with pytest.raises(SystemExit) as stopped:
        main(["eval", "truth.txt", "nan.txt", "--strict"])
    assert stopped.value.code == 2
    assert "nan.txt:2: " in capsys.readouterr().err


def test_plots(folder, capsys):
    main(["eval", "truth.txt", "good.txt", "lost.txt", "never.txt", "--plots", "out/plots"])
    written = {file.name for file in (folder / "out/plots").iterdir()}
    assert written == {f"{name}.{kind}" for name in ("top", "time", "errors", "ate") for kind in ("svg", "png")}
    assert "0 %" in (folder / "out/plots/top.svg").read_text()  # the one that never initialised


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["truth.txt", "missing.txt"], "missing.txt"),
        (["truth.txt", "good.txt", "--json", "--csv"], "one of --json and --csv"),
        (["truth.txt", "good.txt", "good.txt"], "every estimate once"),
        (["never.txt", "good.txt"], "never.txt: expected"),
        (["truth.txt", "good.txt", "--alignment", "sim"], "did you mean 'sim3'"),
        (["truth.txt", "good.txt", "--max-gap-s", "nan"], "max_gap_s"),
        (["truth.txt", "poses.kitti"], "times"),
        (["truth.txt", "rgb.txt"], "rgb.txt"),
        (["truth.txt", "good.txt", "--frames", "truth_.txt"], "truth_.txt"),
        (["truth.txt", "good.txt", "--plots", "truth.txt/plots"], "truth.txt/plots"),
        (["truth.txt", "good.txt", "--frames", "rgb.txt", "--max-gap-s", "0.5"], "no max_gap_s with frames"),
        (["truth.txt", "good.txt", "--times", "times.txt"], "--times only with KITTI files"),
        (["truth.txt"], "estimate"),
    ],
)
def test_bad_input_is_one_line(folder, arguments, message, capsys):
    with pytest.raises(SystemExit) as stopped:
        main(["eval", *arguments])
    assert stopped.value.code == 2
    captured = capsys.readouterr()
    assert message in captured.err
    assert captured.out == ""
    assert len(captured.err.strip().splitlines()) == 1 or "usage" in captured.err.lower()


def test_a_failed_command_leaves_no_folder_for_pictures(folder):
    with pytest.raises(SystemExit):
        main(["eval", "truth.txt", "missing.txt", "--plots", "pictures"])
    assert not (folder / "pictures").exists()


def run_in_shell(command, folder, **environment):
    return subprocess.run(
        ["bash", "-c", f"set -o pipefail; {sys.executable} -m slamgym.cli {command}"],
        cwd=folder,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=60,
    )


def test_a_closed_pipe_and_a_full_disk_are_no_traceback(folder):
    closed = run_in_shell("eval truth.txt good.txt --json | true", folder)
    assert (closed.returncode, closed.stderr) == (141, "")
    full = run_in_shell("eval truth.txt good.txt --json > /dev/full", folder)
    assert full.returncode == 2
    assert full.stderr.strip().splitlines() == ["slamgym: cannot print the results: No space left on device"]
    ascii_only = run_in_shell("eval truth.txt good.txt", folder, PYTHONIOENCODING="ascii")
    assert ascii_only.returncode == 2
    assert ascii_only.stderr.startswith("slamgym: cannot print the results: 'ascii' codec")


def test_the_commands_are_listed(folder):
    printed = run_in_shell("--help", folder).stdout
    assert "run" in printed
    assert "eval" in printed
    assert run_in_shell("evall truth.txt", folder).returncode == 2


def test_the_command_loads_no_simulator(folder):
    command = "main(['eval', 'truth.txt', 'good.txt', '--plots', 'p'])"
    probe = f"import sys; from slamgym.cli import main; {command}; print(*sys.modules)"
    result = subprocess.run([sys.executable, "-c", probe], cwd=folder, capture_output=True, text=True, timeout=60)
    loaded = {name.split(".")[0] for name in result.stdout.split()} | set(result.stdout.split())
    assert "slamgym.eval.evaluation" in loaded
    simulator = {"pybullet", "OpenGL", "pyrender", "pyorbslam3", "trimesh", "embreex", "cv2", "evo", "slamgym.env"}
    assert not loaded & simulator
