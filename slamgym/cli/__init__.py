"""The command line: parses, prints, exits. Nothing else in slamgym prints or exits."""

import sys
from collections.abc import Callable
from typing import Any

import tyro

from slamgym.cli.eval import Eval, evaluate_files
from slamgym.cli.run import Run, run
from slamgym.cli.terminal import notes, say
from slamgym.errors import SlamgymError

EXIT_BAD_INPUT = 2
EXIT_INTERRUPTED = 130

COMMANDS: dict[str, tuple[type[Any], Callable[[Any], None]]] = {"run": (Run, run), "eval": (Eval, evaluate_files)}
"""Name -> the options of a command, and what it does with them."""


def main(arguments: list[str] | None = None) -> None:
    """Entry point of the command `slamgym`. Exits with 0, 2 on bad input, or 130 after Ctrl-C."""
    actions = dict(COMMANDS.values())
    parsers: dict[str, Callable[..., Any]] = {name: options for name, (options, _) in COMMANDS.items()}
    try:
        options = tyro.extras.subcommand_cli_from_dict(parsers, prog="slamgym", args=arguments)
        actions[type(options)](options)
    except SlamgymError as error:
        say(notes, f"slamgym: {error}", style="red")
        sys.exit(EXIT_BAD_INPUT)
    except KeyboardInterrupt:
        sys.exit(EXIT_INTERRUPTED)
