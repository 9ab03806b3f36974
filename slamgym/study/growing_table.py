"""The table of a study's runs while it runs: in memory, and a little later on the disk."""

import time

import pandas as pd

from slamgym.study.folder import Plan, StudyFolder
from slamgym.study.table import NOT_RUN, Row, current_table, joined, succeeded, write_table

SAVE_S, SAVE_SHARE = 3.0, 0.02
"""The table is written at most so often, and takes at most this share of the time."""


class GrowingTable:
    """done: ids of the runs with a result. failed: how many of them are no success. not_run: of those tried now.

    Only for who holds the study's lock: what is damaged is set aside, its runs are not done. Raises OutputError when
    something cannot be written.
    """

    def __init__(self, folder: StudyFolder, plan: Plan) -> None:
        self.folder, self.plan = folder, plan
        folder.set_damaged_aside()
        table = current_table(folder, plan, lambda run_id, _: folder.set_aside(folder.run(run_id)))
        # Those that could not be begun, and those whose folder somebody removed, are to be run again.
        self._saved: pd.DataFrame = table[table["run_id"].isin(folder.finished_runs())]
        self._new: list[Row] = []
        self.done: set[str] = set(self._saved["run_id"])
        self.failed = int((~succeeded(self._saved)).sum())
        self.not_run = 0
        self._next_save = 0.0

    def add(self, row: Row) -> None:
        self._new.append(row)
        if row["status"] == NOT_RUN:
            self.not_run += 1
        else:
            self.done.add(row["run_id"])
            self.failed += row["success"] is not True

    def save(self) -> None:
        begin = time.monotonic()
        self._saved, self._new = joined(self._saved, self._new, self.plan), []
        write_table(self.folder.table, self._saved)
        end = time.monotonic()
        self._next_save = end + max(SAVE_S, (end - begin) / SAVE_SHARE)

    def save_now_and_then(self) -> None:
        if self._new and time.monotonic() > self._next_save:
            self.save()
