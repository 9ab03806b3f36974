import os
import subprocess
import sys

import pytest

from slamgym.errors import ConfigError, OutputError
from slamgym.study.folder import Plan, StudyFolder, check_grown, locked, read_plan, write_plan

HOLDER = """
import sys
from pathlib import Path
from slamgym.study.folder import StudyFolder, locked
with locked(StudyFolder(Path(sys.argv[1]))):
    print("locked", flush=True)
    sys.stdin.read()
"""


def plan(*run_ids):
    return Plan("speed", "How fast?", ("speed", "stride"), run_ids)


def test_a_folder_is_for_one_process_at_a_time(tmp_path):
    folder = StudyFolder(tmp_path / "new" / "study")
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, folder.path], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as holder:
        assert holder.stdout.readline() == b"locked\n"
        told = rf"runs there already \(process {holder.pid} on .+ since 20"
        with pytest.raises(OutputError, match=told) as refused, locked(folder):
            pass
        assert "\n" not in str(refused.value)
        holder.kill()
    with locked(folder):  # the kernel has freed it
        assert str(os.getpid()) in folder.lock.read_text()


def test_a_folder_of_something_else_is_refused(tmp_path):
    (tmp_path / "mine.txt").write_text("")
    with pytest.raises(OutputError, match="new or empty folder"), locked(StudyFolder(tmp_path)):
        pass
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]
    with pytest.raises(OutputError, match="expected a folder"), locked(StudyFolder(tmp_path / "mine.txt")):
        pass


def test_a_plan_may_grow_but_not_lose_runs(tmp_path):
    folder = StudyFolder(tmp_path)
    check_grown(folder, plan("a/1"))
    write_plan(folder, plan("a/1", "b/1"))
    assert read_plan(folder) == plan("a/1", "b/1")
    check_grown(folder, plan("b/1", "c/1", "a/1"))
    with pytest.raises(OutputError, match=r"1 of its 2 are not in this one, such as b/1"):
        check_grown(folder, plan("a/1", "c/1"))


@pytest.mark.parametrize("content", [None, "", "[]", "{}", '{"name": 1}'])
def test_a_folder_without_a_plan_is_no_study(tmp_path, content):
    folder = StudyFolder(tmp_path)
    if content is not None:
        folder.plan.write_text(content)
    with pytest.raises(ConfigError, match="expected the folder of a study"):
        read_plan(folder)


def test_tidying_removes_what_was_half_written_and_nothing_else(tmp_path):
    folder = StudyFolder(tmp_path)
    stay = [folder.run("d-1/r-1"), folder.drive("d-1"), folder.frames("d-1")]
    go = [
        folder.run("d-1/.r-2-x1y2z3"),
        folder.run(".d-2-x1y2z3"),
        folder.drive(".d-2-x1y2z3"),
        folder.frames(".d-2-x1y2z3") / "d-2" / "frames",
        tmp_path / ".runs.parquet-x1y2z3",
    ]
    for path in stay + go:
        path.mkdir(parents=True)
    (folder.run("d-1/r-1") / "episode.json").write_text("{}")
    folder.tidy()
    assert all(path.exists() for path in stay)
    assert not any(path.exists() for path in go)
    assert folder.finished_runs() == {"d-1/r-1"}
    assert folder.rendered_drives() == {"d-1"}
    folder.drop_frames("d-1")
    folder.end_frames()
    assert not (tmp_path / "frames").exists()
    assert folder.rendered_drives() == set()
