"""The command line: parses, prints, exits. Nothing else in slamgym prints or exits."""

import sys
from collections import Counter
from collections.abc import Callable
from importlib import import_module
from itertools import takewhile
from typing import Any

import tyro

from slamgym.cli.terminal import forget_output, notes, say
from slamgym.errors import ConfigError, SlamgymError

EXIT_BAD_INPUT = 2
EXIT_INTERRUPTED = 130
EXIT_CLOSED_PIPE = 141

PAIRS_FLAGS = ("--slam-options", "--scene-options")
BESIDE_LIKE = {"--like", "--out", "--rerun", "--help"}
"""What `slamgym run --like` takes: a run is repeated as it was."""

COMMANDS = {
    "run": "slamgym.cli.run:Run",
    "record": "slamgym.cli.record:Record",
    "replay": "slamgym.cli.replay:ReplayCommand",
    "study": "slamgym.cli.study:Study",
    "report": "slamgym.cli.report:Report",
    "explain": "slamgym.cli.explain:Explain",
    "eval": "slamgym.cli.eval:Eval",
    "scene": "slamgym.cli.scene:Scene",
    "vocab": "slamgym.cli.vocab:Vocab",
}
"""Name -> the options of a command, a class whose `__call__` carries it out."""


def main(arguments: list[str] | None = None) -> None:
    """Entry point of the command `slamgym`. Exits with 0, 2 on bad input, 130 after Ctrl-C, 141 on a closed pipe."""
    arguments = sys.argv[1:] if arguments is None else arguments
    try:
        _refuse_repeated(arguments)
        _refuse_beside_like(arguments)
        _parsed(arguments)()
    except SlamgymError as error:
        say(notes, f"slamgym: {error}", style="red")
        sys.exit(EXIT_BAD_INPUT)
    except BrokenPipeError:
        forget_output()
        sys.exit(EXIT_CLOSED_PIPE)
    except KeyboardInterrupt:
        sys.exit(EXIT_INTERRUPTED)


def _refuse_repeated(arguments: list[str]) -> None:
    """Of two lists of options the parser would take the last one and forget the other."""
    flags = [word.partition("=")[0].replace("_", "-") for word in arguments]
    for flag in PAIRS_FLAGS:
        if (times := flags.count(flag)) > 1:
            raise ConfigError(f"{flag}: expected it once, got it {times} times; give all pairs after one")
        if times:
            after = arguments[flags.index(flag) + 1 :]
            names = list(takewhile(lambda word: not word.startswith("--"), after))[::2]
            if twice := [name for name, count in Counter(names).items() if count > 1]:
                raise ConfigError(f"{flag}: expected each name once, got {twice[0]} twice; give one value")


def _refuse_beside_like(arguments: list[str]) -> None:
    """By the words that were typed: once parsed, a default that somebody asked for is as one that nobody did."""
    flags = {word.partition("=")[0].replace("_", "-") for word in arguments if word.startswith("--")}
    if arguments[:1] == ["run"] and "--like" in flags and (given := sorted(flags - BESIDE_LIKE)):
        raise ConfigError(
            f"--like: the run is repeated as it was, so expected no other parameters, got {', '.join(given)}"
        )


def _parsed(arguments: list[str]) -> Callable[[], None]:
    """The command that the arguments name; only its own module is loaded, since `eval` needs no simulator."""
    wanted = [name for name in COMMANDS if arguments[:1] == [name]] or list(COMMANDS)
    parsers: dict[str, Callable[..., Any]] = {name: _options(COMMANDS[name]) for name in wanted}
    command: Callable[[], None] = tyro.extras.subcommand_cli_from_dict(parsers, prog="slamgym", args=arguments)
    return command


def _options(target: str) -> type[Any]:
    module, _, name = target.partition(":")
    options: type[Any] = getattr(import_module(module), name)
    return options
