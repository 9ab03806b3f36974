"""`slamgym replay`: recorded sequences through a SLAM."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Annotated, Any

import pandas as pd
import tyro

from slamgym.cli.options import option_group
from slamgym.cli.terminal import printing, progress_bar, results, say, show_table, told_warnings
from slamgym.errors import ConfigError
from slamgym.eval.datasets import Sequence as RecordedSequence
from slamgym.eval.datasets import published, read_sequence
from slamgym.files import check_free, write_atomically
from slamgym.params import SlamParams
from slamgym.replay import Replay, replay
from slamgym.report_table import remarks, replay_table, spread_line
from slamgym.run_folder import write_run

SlamOptions = option_group(SlamParams)

RUNS_FILE = "runs.csv"


@dataclass(kw_only=True)
class ReplayCommand:
    """Feed recorded RGB-D sequences (of TUM RGB-D, or by `slamgym record`) to a SLAM and write run folders.

    Example: slamgym replay rgbd_dataset_freiburg1_xyz --repeats 5 --out out/fr1_xyz
    """

    sequences: Annotated[
        tyro.conf.Positional[tuple[Path, ...]], tyro.conf.arg(metavar="SEQUENCE...", help="folders of sequences")
    ]
    out: Path
    """Folder to make, with a run folder SEQUENCE/N for each run, and runs.csv; it must not exist yet, or be empty."""
    slam: tyro.conf.OmitArgPrefixes[SlamOptions]
    camera: Annotated[
        str | None,
        tyro.conf.arg(metavar="tum_fr1|tum_fr2|tum_fr3|FILE", help="camera of the sequences; None: as they tell"),
    ] = None
    repeats: Annotated[int, tyro.conf.arg(help="runs of each sequence")] = 1

    def __call__(self) -> None:
        params = SlamParams.checked(vars(self.slam))
        self._check()
        with told_warnings():
            sequences = [read_sequence(path, self.camera) for path in self.sequences]
        check_free(self.out, "folder")
        rows: list[dict[str, Any]] = []
        try:
            for sequence, run in product(sequences, range(1, self.repeats + 1)):
                with told_warnings(Path(sequence.name)):
                    done = _replayed(sequence, params, f"{sequence.name}, run {run} of {self.repeats}")
                write_run(done, self.out / sequence.name / str(run))
                rows.append(_row(done, run))
                write_atomically(self.out / RUNS_FILE, _runs_csv(rows))
        finally:  # what was done before an error or Ctrl-C is there, and shown
            if rows:
                with printing():
                    self._print(rows)

    def _check(self) -> None:
        if not self.sequences:
            raise ConfigError("expected at least one sequence, got none: slamgym replay SEQUENCE... --out DIR")
        names = [path.resolve().name for path in self.sequences]
        if len(set(names)) < len(names):
            raise ConfigError(f"expected folders of different names, got {', '.join(names)}: replay them one by one")
        if RUNS_FILE in names:
            raise ConfigError(f"expected a sequence of another name than {RUNS_FILE}: rename the folder")
        if self.repeats < 1:
            raise ConfigError(f"expected at least 1 repeat, got {self.repeats}")

    def _print(self, rows: Sequence[Mapping[str, Any]]) -> None:
        show_table(replay_table(rows))
        for row in rows:
            for line in remarks(row):
                say(results, f"{row['sequence']}, run {row['run']}: {line}")
        for name in dict.fromkeys(row["sequence"] for row in rows):
            runs = [row for row in rows if row["sequence"] == name]
            if len(runs) > 1:
                say(results, spread_line(name, runs))
            if (known := published(name)) is not None and runs[0]["stride"] == 0:
                say(results, f"published: {known.system} over the whole {known.sequence}, {known.source}", style="dim")
        say(results, f"run folders: {self.out}")


def _replayed(sequence: RecordedSequence, params: SlamParams, what: str) -> Replay:
    with progress_bar("{task.completed:.0f} frames") as progress:
        task = progress.add_task(what, total=len(sequence.rows(params.stride)))
        return replay(sequence, params, lambda number: progress.update(task, completed=number))


def _row(done: Replay, run: int) -> dict[str, Any]:
    known = published(done.sequence.name) if done.config["stride"] == 0 else None
    return {
        "run": run,
        "stride": done.config["stride"],
        "published_ate_rmse_m": float("nan") if known is None else known.ate_rmse_m,
        "track_ms": done.summary["timing"]["track_ms_median"],
        **done.summary,
    }


def _runs_csv(rows: Sequence[Mapping[str, Any]]) -> str:
    """All figures of all runs; what is a list or a mapping is only in the run folders."""
    flat = [{key: value for key, value in row.items() if not isinstance(value, list | dict)} for row in rows]
    return str(pd.DataFrame(flat).to_csv(index=False))
