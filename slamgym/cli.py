"""The command line: parses, prints, exits. Nothing else in slamgym prints or exits."""

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, make_dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, get_args, get_origin

import gymnasium as gym
import tyro
from pydantic.fields import FieldInfo
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from slamgym import MAX_EPISODE_STEPS
from slamgym.agents import AGENTS
from slamgym.errors import ConfigError, SlamgymError, unknown_word
from slamgym.params import DriveParams, Params, SlamParams
from slamgym.report_table import episode_table
from slamgym.rollout import EpisodeInterrupted, run_episode
from slamgym.run_folder import check_free, write_run

EXIT_BAD_INPUT = 2
EXIT_INTERRUPTED = 130

notes = Console(stderr=True)


def _option(name: str, info: FieldInfo) -> tuple[str, Any, Any]:
    """One option of the command line for one parameter, taken as text: the parameters check it, not the parser.

    So a bad value gets the same message from the command line as from Python.
    """
    default = info.get_default(call_default_factory=True)
    choices = get_args(info.annotation) if get_origin(info.annotation) is Literal else ("VALUE",)
    annotation: Any = str
    shown: Any = str(default)
    if name == "camera":
        shown = "default"
    elif name == "slam_options":
        annotation, shown, choices = dict[str, str], default, ("NAME VALUE",)
    elif default is None:
        annotation, shown = str | None, None
    help_text = tyro.conf.arg(help=info.description, metavar="|".join(choices))
    return name, Annotated[annotation, help_text], field(default_factory=lambda: shown)


def _option_group(params: type[Params]) -> Any:
    options = [_option(name, info) for name, info in params.model_fields.items()]
    return make_dataclass(params.__name__, options, namespace={"__doc__": params.__doc__}, kw_only=True)


DriveOptions = _option_group(DriveParams)
SlamOptions = _option_group(SlamParams)


@dataclass(kw_only=True)
class Run:
    """Drive one episode with a SLAM in the loop and write a run folder.

    Example: slamgym run --seed 7 --speed 0.4 --out out/run7
    """

    out: Path
    """Run folder to make; it must not exist yet, or be empty."""
    drive: tyro.conf.OmitArgPrefixes[DriveOptions]
    slam: tyro.conf.OmitArgPrefixes[SlamOptions]
    seed: Annotated[int, tyro.conf.arg(help="picks the path; the scene picks the house")] = 0
    agent: Annotated[str, tyro.conf.arg(metavar="|".join(AGENTS), help="who drives")] = "follower"
    max_episode_steps: Annotated[int, tyro.conf.arg(help="frames after which the episode is cut off")] = (
        MAX_EPISODE_STEPS
    )


COMMANDS: dict[str, Callable[..., Run]] = {"run": Run}


def main(arguments: list[str] | None = None) -> None:
    """Entry point of the command `slamgym`. Exits with 0, 2 on bad input, or 130 after Ctrl-C."""
    try:
        run(tyro.extras.subcommand_cli_from_dict(COMMANDS, prog="slamgym", args=arguments))
    except SlamgymError as error:
        _say(notes, f"slamgym: {error}", style="red")
        sys.exit(EXIT_BAD_INPUT)
    except KeyboardInterrupt:
        sys.exit(EXIT_INTERRUPTED)


def run(options: Run) -> None:
    """`slamgym run`."""
    if options.agent not in AGENTS:
        raise ConfigError(unknown_word("agent", options.agent, AGENTS))
    if options.seed < 0 or options.max_episode_steps < 1:
        raise ConfigError(
            f"expected a seed of at least 0 and max_episode_steps of at least 1, got {options.seed} and "
            f"{options.max_episode_steps}"
        )
    keywords: Mapping[str, Any] = {**vars(options.drive), **vars(options.slam)}
    env = gym.make("HomeRobotSLAM-v0", max_episode_steps=options.max_episode_steps, **keywords)
    check_free(options.out)
    try:
        with _progress() as progress:
            task = progress.add_task("loading", total=None)
            episode = run_episode(
                env,
                AGENTS[options.agent](),
                options.seed,
                on_step=lambda done_m, path_m: progress.update(
                    task, description="driving", completed=done_m, total=path_m
                ),
            )
    except EpisodeInterrupted as interrupted:
        _say(notes, f"interrupted; what was driven is in {write_run(interrupted.episode, options.out)}")
        raise
    finally:
        env.close()
    folder = write_run(episode, options.out)
    Console().print(episode_table([episode]))
    _say(Console(), f"run folder: {folder}")


def _say(console: Console, text: str, style: str | None = None) -> None:
    """Print as it is: a path may hold what would be markup."""
    console.print(text, style=style, markup=False, highlight=False, soft_wrap=True)


def _progress() -> Progress:
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed:.1f} m"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        console=notes,
        transient=True,
    )


if __name__ == "__main__":
    main()
