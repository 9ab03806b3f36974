import shlex
from dataclasses import replace
from pathlib import Path

import pytest
import tyro

from slamgym.cli.replay import ReplayCommand
from slamgym.report.page.repeat import replay_line
from slamgym.study.planned import PlannedDrive, PlannedRun
from slamgym.study.slam_work import write_planned

SEQUENCE = PlannedDrive("d", "tum", "fr1", params={}, seed=0, sequence="my data/fr1")
SLAM = {"slam": "orbslam3", "stride": 2, "loop_closure": False, "slam_options": {"features": 500}}
RUN = PlannedRun("d/1", SEQUENCE, SLAM, 1, {})


def test_a_run_over_a_sequence_is_repeated_with_all_that_its_study_set(tmp_path):
    write_planned(tmp_path, RUN)
    line = replay_line(tmp_path)
    assert line == (
        "slamgym replay 'my data/fr1' --out again --slam orbslam3 --stride 2 --loop-closure False "
        "--slam-options features 500"
    )
    command = tyro.cli(ReplayCommand, args=shlex.split(line)[2:])
    assert (command.sequences, command.out) == ((Path("my data/fr1"),), Path("again"))
    assert vars(command.slam)["stride"] == "2"


@pytest.mark.parametrize("planned", [replace(RUN, drive=replace(SEQUENCE, sequence=None)), None])
def test_any_other_run_has_no_such_line(planned, tmp_path):
    if planned:
        write_planned(tmp_path, planned)
    assert replay_line(tmp_path) is None
    (tmp_path / "planned.json").write_text("{")
    assert replay_line(tmp_path) is None
