"""Accuracy that was published for sequences of the TUM RGB-D benchmark, to compare one's own figures with."""

import csv
import re
from functools import cache
from pathlib import Path
from typing import NamedTuple

_TABLE = Path(__file__).with_name("published.csv")
_NAME = re.compile(r"(?:.*[_/-])?(?:freiburg|fr)([123])[_/-](.+?)(?:[_-]\d{2,})?")
_SHORT = {
    "long_office_household": "office",
    "nostructure_texture_near_withloop": "nst",
}


class Published(NamedTuple):
    """A published figure. sequence: such as "fr1/desk". sensor: what the system was given. ate_rmse_m: RMSE of the
    absolute trajectory error, metres. source: the publication and its table.
    """

    sequence: str
    system: str
    sensor: str
    ate_rmse_m: float
    source: str


def published(name: str) -> Published | None:
    """What was published of ORB-SLAM2 for the sequence in a folder of this name, None where nothing is known.

    name: `rgbd_dataset_freiburg1_xyz`, `fr1_xyz`, `tum_fr1_xyz_100`, ...; a number of two digits or more at its end may
    count frames. Figures of a cut sequence differ from those of the whole one, which was published.
    """
    sequence = _sequence_of(name)
    return next((row for row in _rows() if row.sequence == sequence), None)


def _sequence_of(name: str) -> str | None:
    if (parts := _NAME.fullmatch(name.lower())) is None:
        return None
    return f"fr{parts[1]}/{_SHORT.get(parts[2], parts[2])}"


@cache
def _rows() -> tuple[Published, ...]:
    with _TABLE.open(encoding="utf-8", newline="") as file:
        _header, *rows = csv.reader(file)
    return tuple(
        Published(sequence, system, sensor, float(ate_rmse_m), source)
        for sequence, system, sensor, ate_rmse_m, source in rows
    )
