import json

import pytest

from slamgym.study.folder import StudyFolder
from slamgym.study.plan import plan_study
from slamgym.study.pool import LocalPool
from slamgym.study.work import Outcome, carry_out


@pytest.fixture
def runs(study, sequences, faulty):
    """Planned runs over one line, of a SLAM that is well and one that hangs at its third frame."""
    return plan_study(
        study(f"""
name: work
paths: [{{sequence: {sequences[0]}}}]
factors: [{{slam: [groundtruth, '{faulty("Sleeps")}']}}]
""")
    )


def test_what_is_there_is_not_done_again(runs, tmp_path):
    drive, run = runs[0].drive, runs[0]
    folder = StudyFolder(tmp_path)
    assert carry_out(drive, tmp_path, 60) == Outcome()
    row = carry_out(run, tmp_path, 60).row
    assert (row["run_id"], row["status"]) == (run.run_id, "ok")
    written = [folder.frames(drive.drive_id), folder.run(run.run_id)]
    before = [path.stat().st_ctime_ns for path in written]
    carry_out(drive, tmp_path, 60)
    assert carry_out(run, tmp_path, 60).row == row
    assert [path.stat().st_ctime_ns for path in written] == before


def test_what_cannot_be_done_comes_back_in_one_line(runs, tmp_path):
    run = runs[0]
    failure = carry_out(run, tmp_path, 60)  # without its drive
    assert (failure.row, failure.cannot_write) == (None, False)
    assert "expected a drive that a study recorded" in failure.failure
    assert "\n" not in failure.failure
    (tmp_path / "frames").write_text("in the way")
    assert carry_out(run.drive, tmp_path, 60).cannot_write


def test_work_that_hangs_ends_its_worker(runs, tmp_path):
    assert carry_out(runs[0].drive, tmp_path, 60) == Outcome()
    pool = LocalPool(1)
    try:
        with pytest.raises(pool.lost):
            pool.submit(carry_out, runs[1], tmp_path, 2.0).result(60)
        assert pool.submit(carry_out, runs[0], tmp_path, 60.0).result(60).row["status"] == "ok"
    finally:
        pool.close()
    assert json.loads((StudyFolder(tmp_path).run(runs[0].run_id) / "episode.json").read_text())["success"]
