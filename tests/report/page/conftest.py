from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from slamgym.errors import SlamError
from slamgym.eval.plots.style import new_figure
from slamgym.report.content import DataTable, Picture, ReportContent, Section
from slamgym.study.drive_work import keep_facts, record_planned_drive
from slamgym.study.folder import Plan, StudyFolder, write_plan
from slamgym.study.planned import PlannedDrive, PlannedRun
from slamgym.study.slam_work import run_planned
from slamgym.study.table import joined, not_run_row, open_study, read_table, write_table

DRIVE = PlannedDrive(
    drive_id="home-7",
    dataset="procedural",
    path="procedural #7",
    params={"camera": "small", "lighting": "flat", "path_length_m": 2.0, "speed": 0.8},
    seed=7,
)
BACKENDS = ("groundtruth", "page_backends:LosesTwice", "page_backends:Crashes", "page_backends:Missing")


def _planned(number, slam):
    return PlannedRun(f"{DRIVE.drive_id}/{number}", DRIVE, {"slam": slam}, 1, {"slam": slam})


@pytest.fixture(scope="session")
def study_folder(tmp_path_factory):
    """One drive: a run without a loss, one with two, one that crashed, one that could not be started."""
    folder = StudyFolder(tmp_path_factory.mktemp("studies") / "small study")
    runs = [_planned(number, slam) for number, slam in enumerate(BACKENDS, start=1)]
    plan = Plan("small", "Four backends on one path.", ("slam",), tuple(run.run_id for run in runs))
    write_plan(folder, plan)
    frames = folder.frames(DRIVE.drive_id)
    record_planned_drive(DRIVE, frames)
    keep_facts(frames, folder.drive(DRIVE.drive_id))
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(Path(__file__).parent))
        for run in runs[:-1]:
            run_planned(run, frames, folder.run(run.run_id))
        with pytest.raises(SlamError) as missing:
            run_planned(runs[-1], frames, folder.run(runs[-1].run_id))
    write_table(folder.table, joined(read_table(folder.table), [not_run_row(runs[-1], str(missing.value))], plan))
    return folder.path


@pytest.fixture(scope="session")
def results(study_folder):
    return open_study(study_folder)


def wave():
    figure = new_figure(7, 3)
    axes = figure.add_subplot()
    axes.plot(np.sin(np.linspace(0, 6, 50)))
    axes.set_xlabel("speed (m/s)")
    return figure


@pytest.fixture
def content():
    table = DataTable(
        "by_backend",
        "Runs by backend",
        "One row a backend.",
        pd.DataFrame({"backend": ["a & b", "50%_x"], "ATE (m)": [0.12345, np.nan], "failed": [1, 0]}),
        {"ATE (m)": "{:.3f}"},
    )
    picture = Picture("wave", "A wave", "How the sine goes.", wave)
    sections = (Section("overview", "Overview", ("One sentence.",), (table,), (picture,)), Section("more", "More"))
    facts = {"paths": 1, "backends": "groundtruth, opencv"}
    headlines = (
        "Half of the drives fail above 0.9 m/s (95 % interval 0.8 to 1.1).",
        "Blur is the most frequent cause.",
    )
    return ReportContent("small", "Four backends on one path.", facts, headlines, sections)
