import json

import numpy as np
import pandas as pd
import pytest

from slamgym.cli import main
from slamgym.study.folder import Plan, StudyFolder, write_plan
from slamgym.study.table import write_table

PATHS = 30


def made_up(path, failed=0, planned=None, paths=PATHS):
    """A study of `paths` with 3 repeats, of which the first `failed` paths fail."""
    rng = np.random.default_rng(0)
    k = np.arange(paths * 3)
    success = k // 3 >= failed
    ids = [f"drive-{i // 3}/{i % 3}" for i in k]
    runs = pd.DataFrame(
        {
            "run_id": ids,
            "dataset": "procedural",
            "path": [f"procedural:1 #{i // 3}" for i in k],
            "drive_id": [f"drive-{i // 3}" for i in k],
            "repeat": k % 3 + 1,
            "status": np.where(success, "ok", "lost"),
            "success": success,
            "ate_rmse_m": rng.uniform(0.01, 0.02, len(k)),
            "rpe_trans_rmse_m": 0.01,
            "rpe_rot_mean_deg": 0.1,
            "completion": np.where(success, 1.0, 0.6),
            "loss_count": (~success).astype(int),
            "losses_per_metre": 0.1 * ~success,
            "losses_per_minute": 1.0 * ~success,
            "frames_fed": 240,
            "duration_s": 8.0,
            "distance_m": 6.0,
            "timing.track_ms_median": rng.uniform(10, 11, len(k)),
        }
    )
    folder = StudyFolder(path)
    more = [f"drive-{PATHS}/{i}" for i in range((planned or len(ids)) - len(ids))]
    write_plan(folder, Plan("made-up", "", (), (*ids, *more)))
    write_table(folder.table, runs)
    return path


def test_the_report_of_a_study_is_written_to_its_folder(tmp_path, capsys):
    folder = made_up(tmp_path / "study", failed=10)
    main(["report", str(folder)])
    printed = capsys.readouterr()
    assert f"report: {folder / 'report.html'}" in printed.out
    assert "30 of 90 runs failed" in printed.out
    assert printed.err == ""
    assert "30 of 90 runs failed" in (folder / "report.html").read_text()
    assert list(folder.glob("figures/*.svg"))
    assert list(folder.glob("tables/*.csv"))


def test_a_study_that_still_runs_says_so(tmp_path, capsys):
    folder = made_up(tmp_path / "study", planned=100)
    main(["report", str(folder), "--out", str(tmp_path / "elsewhere")])
    assert "not finished, 90 of 100 runs" in capsys.readouterr().err
    assert (tmp_path / "elsewhere" / "report.html").exists()
    assert not (folder / "report.html").exists()


def test_a_study_against_itself_has_no_regression(tmp_path, capsys):
    folder = made_up(tmp_path / "study", failed=5)
    main(["report", str(folder), str(folder), "--fail-on-regression"])
    assert "\nregression:" not in capsys.readouterr().out
    assert (folder / "compare-study" / "report.html").exists()


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"paths": 5}, "expected at least 8 paths in common, got 5; run both studies on more"),
        ({"planned": 99}, "expected all 99 runs of the new study, got 90; wait until it is finished"),
    ],
)
def test_what_cannot_be_judged_does_not_pass(changes, why, tmp_path, capsys):
    before, now = made_up(tmp_path / "before"), made_up(tmp_path / "now", **changes)
    main(["report", str(now), str(before)])
    capsys.readouterr()
    with pytest.raises(SystemExit) as stopped:
        main(["report", str(now), str(before), "--fail-on-regression"])
    assert stopped.value.code == 2
    printed = capsys.readouterr()
    assert printed.err.strip().endswith(f"--fail-on-regression: cannot judge: {why}")
    assert "report: " in printed.out


@pytest.mark.parametrize("gate", [True, False])
def test_a_regression_is_told_and_fails_where_asked_for(gate, tmp_path, capsys):
    before, now = made_up(tmp_path / "before", failed=1), made_up(tmp_path / "now", failed=15)
    arguments = ["report", str(now), str(before)]
    if gate:
        with pytest.raises(SystemExit) as stopped:
            main([*arguments, "--fail-on-regression"])
        assert stopped.value.code == 1
    else:
        main(arguments)
    printed = capsys.readouterr().out
    assert printed.count("egression: success rate") == 1
    assert f"report: {now / 'compare-before' / 'report.html'}" in printed


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["missing"], "missing: expected the folder of a study, got no folder"),
        (["empty"], "expected the folder of a study"),
        (["waiting"], "expected a study with finished runs, got none of 3"),
        (["study", "missing"], "missing: expected the folder of a study"),
        (["study", "--fail-on-regression"], "expected a baseline"),
        (["study", "--out", "study/plan.json"], "plan.json"),
    ],
)
def test_bad_input_is_one_line(arguments, message, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made_up(tmp_path / "study")
    (tmp_path / "empty").mkdir()
    write_plan(StudyFolder(tmp_path / "waiting"), Plan("waiting", "", (), ("a/1", "a/2", "a/3")))
    with pytest.raises(SystemExit) as stopped:
        main(["report", *arguments])
    assert stopped.value.code == 2
    error = capsys.readouterr().err.strip()
    assert message in error
    assert len(error.splitlines()) == 1
    assert json.loads((tmp_path / "study" / "plan.json").read_text())["name"] == "made-up"
