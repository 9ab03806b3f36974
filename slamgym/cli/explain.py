"""`slamgym explain`: what a loss was due to, by experiment."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro
from rich.box import SIMPLE_HEAD
from rich.table import Table

from slamgym.cli.options import option_group
from slamgym.cli.terminal import printing, progress_bar, results, say, show_table, told_warnings
from slamgym.errors import ConfigError
from slamgym.explain.explanation import ExplainParams, explain
from slamgym.explain.result import CaseResult, by_change, summary_sentences
from slamgym.explain.source import runs_in
from slamgym.explain.verdict import FALSE_ALARM

ExplainOptions = option_group(ExplainParams)


@dataclass(kw_only=True)
class Explain:
    """Repeat the drive around each loss of a run with one thing changed at a time, and tell which makes it vanish.

    Example: slamgym explain out/run7 --out out/why7
    """

    runs: Annotated[
        tyro.conf.Positional[tuple[Path, ...]],
        tyro.conf.arg(metavar="RUN...", help="folders of runs, or of studies: all their runs with a loss"),
    ]
    out: Path
    """Folder to make; it must not exist yet, or be empty."""
    experiment: tyro.conf.OmitArgPrefixes[ExplainOptions]

    def __call__(self) -> None:
        params = ExplainParams.checked(vars(self.experiment))
        if not self.runs:
            raise ConfigError("expected at least one run, got none: slamgym explain RUN... --out DIR")
        with told_warnings():
            folders = [folder for path in self.runs for folder in runs_in(path)]
        with told_warnings(), progress_bar("{task.completed:.0f} losses") as progress:
            task = progress.add_task("reading", total=None)
            found = explain(
                folders,
                self.out,
                params,
                lambda done, total, text: progress.update(task, description=text, completed=done, total=total),
            )
        with printing():
            self._print(found)

    def _print(self, found: Sequence[CaseResult]) -> None:
        if not found:
            say(results, "nothing was lost: there is nothing to explain")
            return
        for result in found:
            if result.judgement is not None:
                show_table(case_table(result))
            for name, why in result.left_out.items():
                say(results, f"{name} was not tried: {why}")
        for result in found:
            say(results, f"{result.case.run.folder.name}: {result.sentence()} (by the rules: {result.case.loss.cause})")
        if len(found) > 1:
            show_table(changes_table(found))
        for sentence in summary_sentences(found):
            say(results, sentence)
        share = f"at most {FALSE_ALARM:.0%} of the losses"
        say(results, f"a change that does nothing is given credit in {share}, if the frames are drawn independently")
        say(results, f"details, a picture and all run folders: {self.out}")


def case_table(result: CaseResult) -> Table:
    """The controls and the changes of one loss."""
    judgement, confirmation = result.judgement, result.confirmation
    assert judgement is not None
    headings = ("change", "lost", "p", "over other frames", "p", "verdict")
    table = Table(*headings, box=SIMPLE_HEAD, padding=(0, 1), title=result.name)
    for one in judgement.controls:
        table.add_row(f"control: {one.name}", str(one.count), f"{one.p:.3f}", "", "", one.verdict)
    if confirmation is not None:
        table.add_row("control: unchanged", "", "", str(confirmation.unchanged), "", "")
    table.add_section()
    for one in judgement.changes:
        again = result.confirmed(one.name)
        other = ("", "") if again is None else (str(again.count), f"{again.p:.3f}")
        table.add_row(one.name, str(one.count), f"{one.p:.3f}", *other, result.verdict_on(one))
    return table


def changes_table(found: Sequence[CaseResult]) -> Table:
    """In how many of the losses each change made it vanish."""
    table = Table("change", "vanishes in", box=SIMPLE_HEAD, padding=(0, 1))
    for name, count in by_change(found).items():
        table.add_row(name, str(count))
    return table
