"""What a study costs besides its work, what a second worker brings, and how long a large study takes to open.

The same drives and SLAM runs, with ORB-SLAM3: by hand in one process and as a study with one worker, both on one core,
in turn, the quicker of two each; and as a study with two workers on two cores. Both times hold the imports of the
process that does the work. Run by `make bench`.
"""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pandas as pd
import yaml
from rich.console import Console
from rich.table import Table

from slamgym.report.page import write_report
from slamgym.report.study import study_content
from slamgym.study.folder import Plan, StudyFolder, write_plan
from slamgym.study.run import run_study
from slamgym.study.spec import read_study
from slamgym.study.table import open_study, write_table

SEEDS, STRIDES, REPEATS = (1, 2), (0, 1), 2
DRIVE = {"speed": 0.4, "path_length_m": 4.0, "lighting": "flat"}
STUDY = {
    "name": "bench",
    "paths": [{"scene": "procedural:1", "seeds": list(SEEDS)}],
    "fixed": {**DRIVE, "slam": "orbslam3"},
    "factors": [{"stride": list(STRIDES)}],
    "repeats": REPEATS,
}
MANY, DRIVES = 100_000, 1_000
TURNS = 2

BY_HAND = f"""
import os, sys
os.environ["LP_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"
from pathlib import Path
import gymnasium as gym
import slamgym
from slamgym.agents import PathFollower
from slamgym.eval.datasets import read_sequence
from slamgym.params import SlamParams
from slamgym.recording import record_drive
from slamgym.replay import replay
for seed in {SEEDS}:
    folder = Path(sys.argv[1]) / str(seed)
    env = gym.make("HomeRobot-v0", scene="procedural:1", **{DRIVE})
    record_drive(env, PathFollower(), seed, folder)
    env.close()
    for stride in {STRIDES}:
        for _ in range({REPEATS}):
            replay(read_sequence(folder), SlamParams(slam="orbslam3", stride=stride))
"""


def main() -> None:
    table = Table("what", "value", title="studies")
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        two_s = study_s(folder / "two", 2)
        with on_one_core():
            times = [(study_s(folder / f"one{k}", 1), by_hand_s(folder / f"hand{k}")) for k in range(TURNS)]
        one_s, hand_s = map(min, zip(*times, strict=True))
        table.add_row("record and replay by hand, one core", f"{hand_s:.1f} s")
        table.add_row("as a study, one worker on one core", f"{one_s:.1f} s")
        table.add_row("overhead", f"{one_s / hand_s - 1:.1%}  (aim: below 5%)")
        table.add_row("as a study, two workers on two cores", f"{two_s:.1f} s")
        table.add_row("2 workers against 1", f"{one_s / two_s:.2f}  (aim: at least 1.7)")
        open_s, report_s = large_study_s(folder / "two", folder / "large")
        table.add_row(f"table of {MANY:,} runs", f"{open_s:.1f} s  (aim: below 5 s)")
        table.add_row(f"report of {MANY:,} runs", f"{report_s:.1f} s  (aim: below 60 s)")
    Console().print(table)


def study_s(folder: Path, workers: int) -> float:
    file = folder.with_suffix(".yaml")
    file.write_text(yaml.safe_dump(STUDY))
    begin = time.perf_counter()
    runs = run_study(read_study(file), folder, workers).runs
    assert len(runs) == len(SEEDS) * len(STRIDES) * REPEATS
    return time.perf_counter() - begin


def by_hand_s(folder: Path) -> float:
    begin = time.perf_counter()
    subprocess.run([sys.executable, "-c", BY_HAND, str(folder)], check=True, capture_output=True)
    return time.perf_counter() - begin


@contextmanager
def on_one_core() -> Iterator[None]:
    """What is started within the block stays there as well."""
    cores = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(cores)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, cores)


def large_study_s(real: Path, folder: Path) -> tuple[float, float]:
    """Seconds to open a made-up study with the columns of a real one, and to write its report."""
    make_large(open_study(real).runs, StudyFolder(folder))
    begin = time.perf_counter()
    study = open_study(folder)
    open_s = time.perf_counter() - begin
    assert len(study.runs) == MANY
    write_report(study_content(study), study, folder)
    return open_s, time.perf_counter() - begin - open_s


def make_large(runs: pd.DataFrame, folder: StudyFolder) -> None:
    rng = np.random.default_rng(0)
    table = runs.iloc[rng.integers(len(runs), size=MANY)].reset_index(drop=True)
    for name in table.select_dtypes(float):  # no two alike, as in a real study
        table[name] *= rng.uniform(0.5, 1.5, MANY)
    drive_ids = [f"drive-{k % DRIVES}" for k in range(MANY)]
    table["drive_id"] = drive_ids
    table["path"] = [f"procedural:{k % DRIVES} #1" for k in range(MANY)]
    table["run_id"] = [f"{drive_id}/stride-{k // DRIVES}_r1" for k, drive_id in enumerate(drive_ids)]
    table["stride"] = [k // DRIVES % 4 for k in range(MANY)]
    write_plan(folder, Plan("large", "", ("stride",), tuple(table["run_id"])))
    for run_id in table["run_id"]:
        folder.run(run_id).mkdir(parents=True)
    write_table(folder.table, table)


if __name__ == "__main__":
    main()
