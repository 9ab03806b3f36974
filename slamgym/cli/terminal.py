"""What every command says on the terminal, and how."""

import os
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.status import Status
from rich.table import Table
from rich.text import Text

from slamgym.errors import OutputError, SceneWarning, TrajectoryWarning
from slamgym.eval.plots.names import printable

results = Console()
notes = Console(stderr=True)

TOLD = (TrajectoryWarning, SceneWarning)

WIDTH = 100
"""Columns that a table may take; a narrower terminal breaks its lines, but no figure is cut."""


def show_table(table: Table) -> None:
    """Print a table of results."""
    Console(width=max(results.width, WIDTH)).print(table)


def say(console: Console, text: str, style: str | None = None) -> None:
    """Print one line as it is: a path may hold what would be markup, or would steer the terminal."""
    console.print(printable(text), style=style, markup=False, highlight=False, emoji=False, soft_wrap=True)


@contextmanager
def printing() -> Iterator[None]:
    """Around what prints the results, to the last byte: raises OutputError when they cannot be printed."""
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except (OSError, UnicodeEncodeError) as error:
        forget_output()
        reason = error.strerror if isinstance(error, OSError) else error
        raise OutputError(f"cannot print the results: {reason}") from None


def forget_output() -> None:
    """What is left to be printed would fail again when Python exits."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def working(text: str) -> Status:
    """A spinner beside the text while something takes its time."""
    return notes.status(Text(printable(text)))


@contextmanager
def told_warnings(about: Path | None = None) -> Iterator[None]:
    """Say warnings about trajectories and scenes in one line each; others stay as they are."""
    with warnings.catch_warnings():
        for told in TOLD:
            warnings.simplefilter("always", told)
        show = warnings.showwarning

        def say_or_show(message: Warning | str, category: type[Warning], *where: Any, **more: Any) -> None:
            if issubclass(category, TOLD):
                say(notes, f"slamgym: warning: {f'{about}: ' if about else ''}{message}", style="yellow")
            else:
                show(message, category, *where, **more)

        warnings.showwarning = say_or_show
        yield


def progress_bar(done: str) -> Progress:
    """A bar; `done` formats what is done, as "{task.completed:.1f} m"."""
    return Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn(done),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        console=notes,
        transient=True,
        disable=not notes.is_terminal,  # else it leaves an empty line in a pipe
    )


def light_progress(progress: Progress, task: TaskID) -> Callable[[float], None]:
    """What shows, on the task's bar, the share of a house's light that is baked."""

    def show(share: float) -> None:
        progress.update(task, description="baking light, %", completed=100 * share, total=100)

    return show
