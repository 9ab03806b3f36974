"""What one types to repeat a run that no environment drove."""

import shlex
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from slamgym.errors import ConfigError
from slamgym.study.slam_work import read_planned


def replay_line(run_folder: Path) -> str | None:
    """`slamgym replay` of a study's run over a recorded sequence, with all that the study set; None for any other run,
    and where it cannot be read.
    """
    try:
        planned = read_planned(run_folder)
    except ConfigError:
        return None
    if planned is None or planned.drive.sequence is None:
        return None
    return shlex.join(["slamgym", "replay", planned.drive.sequence, "--out", "again", *_options(planned.slam)])


def _options(slam: Mapping[str, Any]) -> Iterator[str]:
    for name, value in slam.items():
        given = [word for pair in value.items() for word in pair] if isinstance(value, Mapping) else [value]
        if given:
            yield f"--{name.replace('_', '-')}"
            yield from map(str, given)
