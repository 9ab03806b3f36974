"""What the frames of a study are made of, which must stay the same from its beginning to its end."""

import json
from pathlib import Path

from slamgym.errors import OutputError


class Sources:
    """The scenes, maps and recorded sequences of a study, as they were when their first drives were recorded.

    drives: the folder of what is kept of each drive, see `slamgym.study.drive_work`.
    """

    def __init__(self, drives: Path) -> None:
        self._then: dict[str, str] = {}
        for folder in sorted(drives.glob("[!.]*")):
            self._then |= _made_of(folder)

    def check(self, drive_folder: Path) -> None:
        """Raise OutputError when a newly recorded drive is made of something that has changed since."""
        for what, now in _made_of(drive_folder).items():
            if (then := self._then.setdefault(what, now)) != now:
                raise OutputError(
                    f"{what}: it changed since runs were made in it ({then} then, {now} now); put it back, or begin "
                    "in another folder"
                )


def _made_of(drive_folder: Path) -> dict[str, str]:
    """Name -> hash; nothing where that cannot be read, as of a damaged drive."""
    try:
        return dict(json.loads((drive_folder / "drive.json").read_text())["made_of"])
    except (OSError, ValueError, KeyError, TypeError):
        return {}
