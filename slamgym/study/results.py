"""What a study has come to so far."""

from dataclasses import dataclass
from pathlib import Path

import pandas as pd


@dataclass(frozen=True, slots=True, eq=False)
class StudyResults:
    """The finished runs of a study.

    folder: the study's. name, description: of the study file. factors: names of what was varied, columns of `runs`, in
    the file's order. planned: how many runs there will be. runs: one row a run with a result, see
    `slamgym.study.table`.
    """

    folder: Path
    name: str
    description: str
    factors: tuple[str, ...]
    planned: int
    runs: pd.DataFrame
