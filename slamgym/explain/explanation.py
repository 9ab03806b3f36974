"""All losses of some runs, one after the other, and what is written of them.

loss_N/CHANGE/K       the run folder of each repeat, for several runs below the name of each
explain.json          the results, also after each loss
explain.svg, .png     in how many repeats each loss occurred, by change
"""

import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from pydantic import Field

from slamgym.checked_params import Params
from slamgym.eval.plots import save_figure
from slamgym.eval.plots.occurrences import plot_occurrences
from slamgym.eval.summary import without_nan
from slamgym.explain.cases import Case, cases_of, picked
from slamgym.explain.experiment import run_case
from slamgym.explain.result import CaseResult, summary_sentences
from slamgym.explain.source import read_run
from slamgym.explain.verdict import FALSE_ALARM, Count
from slamgym.files import check_free, write_atomically

RESULTS, PICTURE = "explain.json", "explain"

OnStep = Callable[[int, int, str], None]


class ExplainParams(Params):
    """How the losses are explained."""

    repeats: int = Field(
        3,
        ge=3,
        le=100,
        description="SLAM runs of each change; twice as many over other frames, and of a rare loss",
    )
    before_m: float = Field(3.0, ge=0.5, description="metres of the path driven before a loss")
    after_m: float = Field(1.5, ge=0.1, description="metres of the path driven after its start")
    losses: int | None = Field(None, ge=1, description="most losses to explain, of several runs in turn; None: all")
    workers: int = Field(1, ge=1, description="SLAM runs at the same time; one where the computer matters")


def explain(
    folders: Sequence[Path], out: Path, params: ExplainParams, on_step: OnStep = lambda *_: None
) -> list[CaseResult]:
    """Explain the losses of the runs in these folders and write the folder `out`; none is written where nothing was
    lost. on_step: called with the number of losses done, of all, and what is done next.

    Ctrl-C leaves what is finished. Raises ConfigError for a folder that is no run that can be driven again, OutputError
    for `out`, and what `run_case` raises.
    """
    check_free(out, "folder")
    folders = list(dict.fromkeys(folder.resolve() for folder in folders))
    runs = {folder: list(cases_of(read_run(folder), params.before_m, params.after_m)) for folder in folders}
    cases = picked(list(runs.values()), params.losses)
    results: list[CaseResult] = []
    for case in cases:
        place = out / _name(case.run.folder, folders) / f"loss_{case.loss.number}"
        results.append(
            run_case(
                case,
                place,
                params.repeats,
                _workers(case, params),
                lambda text: on_step(len(results), len(cases), text),
            )
        )
        _write(out, results, params)
    return results


def _name(folder: Path, folders: Sequence[Path]) -> Path:
    """Nothing for a single run, else what tells it from the others."""
    return Path() if len(folders) == 1 else folder.relative_to(os.path.commonpath(folders))


def _workers(case: Case, params: ExplainParams) -> int:
    setup = case.run.setup
    undisturbed = setup.slam.slam_sync == "lockstep" and not setup.busy_processes
    return params.workers if undisturbed else 1


def _write(out: Path, results: Sequence[CaseResult], params: ExplainParams) -> None:
    told: dict[str, Any] = {
        "settings": params.model_dump(),
        "largest_chance_of_a_false_claim_a_loss": FALSE_ALARM,
        "summary": summary_sentences(results),
        "losses": [result.data() for result in results],
    }
    write_atomically(out / RESULTS, json.dumps(without_nan(told), indent=2, allow_nan=False) + "\n")
    if columns := _columns(results):
        save_figure(plot_occurrences(columns), out / PICTURE)


def _columns(results: Sequence[CaseResult]) -> dict[str, dict[str, Count]]:
    """Loss -> change or control -> count."""
    return {
        f"{number}. {result.case.loss.cause}\n{result.case.loss.start_s:.1f} s": {
            finding.name: finding.count for finding in (*result.judgement.controls, *result.judgement.changes)
        }
        for number, result in enumerate(results, start=1)
        if result.judgement is not None
    }
