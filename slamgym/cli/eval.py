"""`slamgym eval`: trajectory files against the truth."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import pandas as pd
import tyro

from slamgym.cli.options import option_group
from slamgym.cli.terminal import notes, results, say, told_warnings
from slamgym.errors import ConfigError, OutputError, TrajectoryError
from slamgym.eval.evaluation import EvalParams, Evaluation, evaluate
from slamgym.eval.plots import evaluation_plots, save_figure
from slamgym.eval.plots.names import shorten
from slamgym.eval.summary import CORRECT_ROT_DEG, CORRECT_TRANS_M, without_nan
from slamgym.eval.trajectories import Trajectory, read_stamps, read_trajectory
from slamgym.eval.trajectories.text import first_data_line, format_of
from slamgym.report_table import PERCENT, figures_table
from slamgym.types import IntArray

COLUMNS: dict[str, tuple[str, str]] = {
    "estimate": ("name", "{}"),
    "status": ("status", "{}"),
    "com-\nplete": ("completion", PERCENT),
    "losses": ("loss_count", "{}"),
    "cor-\nrect": ("correct_rate", PERCENT),
    "poses": ("matched", "{}"),
    "ATE\nm": ("ate_rmse_m", "{:.4f}"),
    "ATE\n°": ("ate_rot_rmse_deg", "{:.2f}"),
    "RPE\n1 s m": ("rpe_second_trans_rmse_m", "{:.4f}"),
}
"""Heading -> key of the row, and its format. ATE never stands without completion."""

LONGEST_NAME = 20

EvalOptions = option_group(EvalParams)


@dataclass(kw_only=True)
class Eval:
    """Compare trajectory files (TUM, KITTI or EuRoC, told by their content) with the truth.

    Example: slamgym eval groundtruth.txt orbslam3.txt other.txt --frames rgb.txt --plots out/plots
    """

    groundtruth: tyro.conf.Positional[Path]
    """True trajectory."""
    estimates: tyro.conf.Positional[tuple[Path, ...]]
    """Estimated trajectories."""
    params: tyro.conf.OmitArgPrefixes[EvalOptions]
    frames: Annotated[
        Path | None, tyro.conf.arg(help="list of the frames the SLAM was given, seconds in its first column (rgb.txt)")
    ] = None
    times: Annotated[Path | None, tyro.conf.arg(help="seconds of each pose, for KITTI files, which have none")] = None
    strict: Annotated[bool, tyro.conf.arg(help="refuse files with bad lines instead of repairing them")] = False
    json: Annotated[bool, tyro.conf.arg(help="print a JSON list instead of the table, one object an estimate")] = False
    csv: Annotated[bool, tyro.conf.arg(help="print comma separated values instead of the table")] = False
    plots: Annotated[Path | None, tyro.conf.arg(help="folder to write pictures to")] = None


def evaluate_files(options: Eval) -> None:
    """`slamgym eval`."""
    params = EvalParams.checked(vars(options.params))
    _check(options)
    if options.times and not any(_has_no_stamps(path) for path in (options.groundtruth, *options.estimates)):
        raise ConfigError("expected --times only with KITTI files, got files that have stamps: leave it out")
    with notes.status("reading the files"), told_warnings():
        truth = _read(options, options.groundtruth)
        frames_ns = None if options.frames is None else read_stamps(options.frames)
        estimates = {path: _read(options, path, allow_empty=True) for path in options.estimates}
    evaluations = {}
    for name, (path, estimate) in zip(_names(options.estimates), estimates.items(), strict=True):
        with notes.status(f"evaluating {name}"), told_warnings(path):
            evaluations[name] = _evaluate(path, truth, estimate, params, frames_ns)
    rows = [
        {"estimate": str(path), "groundtruth": str(options.groundtruth), **params.model_dump(), **evaluation.summary}
        for path, evaluation in zip(estimates, evaluations.values(), strict=True)
    ]
    _print(options, rows, list(evaluations))
    if options.plots is not None:
        _write_plots(options.plots, evaluations)


def _check(options: Eval) -> None:
    if not options.estimates:
        raise ConfigError("expected at least one estimate, got none: slamgym eval GROUNDTRUTH ESTIMATE...")
    if len(set(options.estimates)) < len(options.estimates):
        raise ConfigError("expected every estimate once, got one of them twice: name each file once")
    if options.json and options.csv:
        raise ConfigError("expected one of --json and --csv, got both: run it twice")
    if options.plots is not None:
        try:
            options.plots.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(f"cannot make the folder {options.plots} for pictures: {error.strerror}") from None


def _read(options: Eval, path: Path, *, allow_empty: bool = False) -> Trajectory:
    # A SLAM that never initialised writes a file without a pose: for an estimate that is a result.
    times = options.times if _has_no_stamps(path) else None
    return read_trajectory(path, times=times, repair=not options.strict, allow_empty=allow_empty)


def _has_no_stamps(path: Path) -> bool:
    line = first_data_line(path)
    return line is not None and format_of(line) == "kitti"


def _evaluate(
    path: Path, truth: Trajectory, estimate: Trajectory, params: EvalParams, frames_ns: IntArray | None
) -> Evaluation:
    try:
        return evaluate(truth, estimate, params, frames_ns)
    except TrajectoryError as error:
        raise TrajectoryError(f"{path}: {error}") from None


def _names(paths: Sequence[Path]) -> list[str]:
    """The files' names, or, where two would be the same, their paths."""
    names = [path.name for path in paths]
    return names if len(set(names)) == len(names) else [str(path) for path in paths]


def _print(options: Eval, rows: list[dict[str, Any]], names: Sequence[str]) -> None:
    if options.json:
        print(json.dumps(without_nan(rows), indent=2, allow_nan=False))
    elif options.csv:
        table = pd.DataFrame(rows).drop(columns="losses")
        print(table.to_csv(index=False), end="")
    else:
        short = [{"name": shorten(name, LONGEST_NAME), **row} for name, row in zip(names, rows, strict=True)]
        results.print(figures_table(COLUMNS, short))
        say(results, _caption(options, rows[0]), style="dim")


def _caption(options: Eval, row: Mapping[str, Any]) -> str:
    """What the numbers mean: a number without its policy flatters."""
    if options.frames is not None:
        complete = f"of the {row['frames']} frames of {options.frames.name}, those with a pose"
    else:
        complete = f"of the {row['frames']} true poses, those with a pose or in a gap of up to {row['max_gap_s']:g} s"
    return (
        f"complete: {complete}. correct: share of the time within {CORRECT_TRANS_M:g} m and {CORRECT_ROT_DEG:g}°.\n"
        f"ATE: RMSE over the poses after {row['alignment']} alignment; association as {row['association']} does it, "
        f"within {row['max_difference_s']:g} s."
    )


def _write_plots(folder: Path, evaluations: Mapping[str, Evaluation]) -> None:
    for name, figure in evaluation_plots(evaluations).items():
        svg, png = save_figure(figure, folder / name)
        say(notes, f"picture: {png}, {svg.name}")
