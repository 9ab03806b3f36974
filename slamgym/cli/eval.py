"""`slamgym eval`: trajectory files against the truth."""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import pandas as pd
import tyro

from slamgym.cli.options import option_group
from slamgym.cli.terminal import notes, printing, results, say, show_table, told_warnings, working
from slamgym.errors import ConfigError, OutputError, TrajectoryError
from slamgym.eval.evaluation import Evaluation, evaluate_at
from slamgym.eval.plots import evaluation_plots, save_figure
from slamgym.eval.plots.names import printable, shorten
from slamgym.eval.reference import EvalParams, prepare
from slamgym.eval.summary import CORRECT_ROT_DEG, CORRECT_TRANS_M, without_nan
from slamgym.eval.trajectories import Trajectory, needs_times, read_stamps, read_trajectory
from slamgym.tables import PERCENT, figures_table

COLUMNS: dict[str, tuple[str, str]] = {
    "estimate": ("name", "{}"),
    "status": ("status", "{}"),
    "com-\nplete": ("completion", PERCENT),
    "losses": ("loss_count", "{}"),
    "cor-\nrect": ("correct_rate", PERCENT),
    "poses": ("matched", "{}"),
    "ATE\nm": ("ate_rmse_m", "{:.4f}"),
    "held\nm": ("ate_held_rmse_m", "{:.4f}"),
    "ATE\n°": ("ate_rot_rmse_deg", "{:.2f}"),
    "RPE\n1 s m": ("rpe_second_trans_rmse_m", "{:.4f}"),
}
"""Heading -> key of the row, and its format. ATE never stands without completion."""

SCALE_COLUMN = {"scale": ("scale", "{:.3g}")}
LONGEST_NAME = 18

EvalOptions = option_group(EvalParams)


@dataclass(kw_only=True)
class Eval:
    """Compare trajectory files (TUM, KITTI or EuRoC, told by their content) with the truth.

    Example: slamgym eval groundtruth.txt orbslam3.txt other.txt --frames rgb.txt --plots out/plots
    """

    groundtruth: Annotated[tyro.conf.Positional[Path], tyro.conf.arg(metavar="GROUNDTRUTH", help="true trajectory")]
    estimates: Annotated[
        tyro.conf.Positional[tuple[Path, ...]], tyro.conf.arg(metavar="ESTIMATE...", help="estimated trajectories")
    ]
    comparison: tyro.conf.OmitArgPrefixes[EvalOptions]
    frames: Annotated[
        Path | None, tyro.conf.arg(help="list of the frames the SLAM was given, seconds in its first column (rgb.txt)")
    ] = None
    times: Annotated[Path | None, tyro.conf.arg(help="seconds of each pose, for KITTI files, which have none")] = None
    strict: Annotated[bool, tyro.conf.arg(help="refuse files with bad lines instead of repairing them")] = False
    json: Annotated[bool, tyro.conf.arg(help="print a JSON list instead of the table, one object an estimate")] = False
    csv: Annotated[bool, tyro.conf.arg(help="print comma separated values instead of the table")] = False
    plots: Annotated[Path | None, tyro.conf.arg(help="folder to write pictures to")] = None

    def __call__(self) -> None:
        params = EvalParams.checked(vars(self.comparison))
        self._check()
        evaluations = self._evaluate(params)
        files = {"groundtruth": str(self.groundtruth), "frames_file": None if self.frames is None else str(self.frames)}
        rows = [
            {"estimate": str(path), **files, **params.model_dump(), **evaluation.summary}
            for path, evaluation in zip(self.estimates, evaluations.values(), strict=True)
        ]
        with printing():
            self._print(rows, list(evaluations))
        if self.plots is not None:
            _write_plots(self.plots, evaluations)

    def _evaluate(self, params: EvalParams) -> dict[str, Evaluation]:
        """By the name that an estimate goes by."""
        with working("reading the files"), told_warnings():
            truth = self._read(self.groundtruth)
            frames_ns = None if self.frames is None else read_stamps(self.frames)
            # A SLAM that never initialised writes a file without a pose: for an estimate that is a result.
            estimates = [self._read(path, allow_empty=True) for path in self.estimates]
            reference = prepare(truth, params, frames_ns)
        evaluations = {}
        for name, path, estimate in zip(_names(self.estimates), self.estimates, estimates, strict=True):
            with working(f"evaluating {name}"), told_warnings(path):
                try:
                    evaluations[name] = evaluate_at(reference, estimate, params)
                except TrajectoryError as error:
                    raise TrajectoryError(f"{path}: {error}") from None
        return evaluations

    def _check(self) -> None:
        if not self.estimates:
            raise ConfigError("expected at least one estimate, got none: slamgym eval GROUNDTRUTH ESTIMATE...")
        if len(set(self.estimates)) < len(self.estimates):
            raise ConfigError("expected every estimate once, got one of them twice: name each file once")
        if self.json and self.csv:
            raise ConfigError("expected one of --json and --csv, got both: run it twice")
        if self.plots is not None and not _nearest_existing(self.plots).is_dir():
            raise OutputError(
                f"cannot make the folder {self.plots} for pictures: {_nearest_existing(self.plots)} is a file"
            )
        if self.times and not any(needs_times(path) for path in (self.groundtruth, *self.estimates)):
            raise ConfigError("expected --times only with KITTI files, got files that have stamps: leave it out")

    def _read(self, path: Path, *, allow_empty: bool = False) -> Trajectory:
        times = self.times if needs_times(path) else None
        return read_trajectory(path, times=times, repair=not self.strict, allow_empty=allow_empty)

    def _print(self, rows: list[dict[str, Any]], names: Iterable[str]) -> None:
        if self.json:
            print(json.dumps(without_nan(rows), indent=2, allow_nan=False))
        elif self.csv:
            table = pd.DataFrame(rows).drop(columns="losses")
            print(table.to_csv(index=False), end="")
        else:
            columns = COLUMNS | (SCALE_COLUMN if rows[0]["alignment"] == "sim3" else {})
            shown = [_shown(row, name) for row, name in zip(rows, names, strict=True)]
            show_table(figures_table(columns, shown))
            for line in self._caption(rows):
                say(results, line, style="dim")

    def _caption(self, rows: Sequence[Mapping[str, Any]]) -> list[str]:
        """What the numbers mean: a number without its policy flatters."""
        n = rows[0]["frames"]
        if self.frames is not None:
            complete = f"of the {n} frames of {printable(self.frames.name)}, those with a pose"
            held = ""
        else:
            gaps = sorted({row["max_gap_s"] for row in rows})
            short = (
                f"{gaps[0]:.2g} s" if len(gaps) == 1 else f"{gaps[0]:.2g} to {gaps[-1]:.2g} s, by the estimate's rate"
            )
            complete = f"of the {n} true poses, holes filled, those with an estimated one or in a gap of up to {short}"
            held = " (give the frames)"
        return [
            f"complete: {complete}.",
            f"correct: share of the time with a pose within {CORRECT_TRANS_M:g} m and {CORRECT_ROT_DEG:g}°.",
            f"ATE: RMSE over the poses after {rows[0]['alignment']} alignment, associated as {rows[0]['association']} "
            f"does within {rows[0]['max_difference_s']:g} s.",
            f"held: ATE over all frames, the last pose held where there is none{held}.",
        ]


def _nearest_existing(path: Path) -> Path:
    return next(parent for parent in (path, *path.resolve().parents) if parent.exists())


def _shown(row: Mapping[str, Any], name: str) -> dict[str, Any]:
    """A row of the table; who was never tracked cannot get lost."""
    losses = "-" if row["status"] == "init_failed" else row["loss_count"]
    return {**row, "name": shorten(printable(name), LONGEST_NAME), "loss_count": losses}


def _names(paths: Sequence[Path]) -> list[str]:
    """The files' names, or, where two would be the same, their paths."""
    names = [path.name for path in paths]
    return names if len(set(names)) == len(names) else [str(path) for path in paths]


def _write_plots(folder: Path, evaluations: Mapping[str, Evaluation]) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"cannot make the folder {folder} for pictures: {error.strerror}") from None
    for name, figure in evaluation_plots(evaluations).items():
        svg, png = save_figure(figure, folder / name)
        say(notes, f"picture: {png}, {svg.name}")
