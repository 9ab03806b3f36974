"""The option `--rerun`: a drive shown while it goes on."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import tyro

from slamgym.errors import ConfigError
from slamgym.rollout import RobotEnv

Show = Callable[[RobotEnv], RobotEnv]

RerunOption = Annotated[
    tuple[str, ...] | None,
    tyro.conf.arg(
        metavar="[FILE.rrd]",
        help="show the drive in the viewer Rerun while it goes on, or write it to a file for it; needs "
        "pip install 'slamgym[rerun]'",
        help_behavior_hint="(default: not shown)",
    ),
]


@contextmanager
def shown(rerun: tuple[str, ...] | None) -> Iterator[Show]:
    """What has the next episode of an environment shown as the option says, None: not at all. Raises ConfigError."""
    if rerun is None:
        yield lambda env: env
        return
    if len(rerun) > 1:
        raise ConfigError(f"--rerun: expected one file, or none for the viewer, got {', '.join(rerun)}")
    from slamgym.live import live_view  # an extra: not everybody has what it imports

    with live_view(Path(rerun[0]) if rerun else None) as show:
        yield show
