"""What was compared, and what came of it, in sentences."""

from collections.abc import Iterator
from typing import Any

from slamgym.report.comparison.compared import Compared, pair_names
from slamgym.report.comparison.differences import MetricChange, outcome_counts, paths_needed
from slamgym.report.comparison.metrics import ATE, SUCCESS
from slamgym.report.comparison.pairing import SIDES, Pairing, some_of
from slamgym.report.levels import title_and_unit
from slamgym.report.wording import count, listed


def comparison_facts(compared: Compared) -> dict[str, Any]:
    """Label -> what was compared, what differs between both first."""
    pairing = compared.pairing
    studies = {"new": compared.new, "baseline": compared.baseline}
    return {
        **{f"Changed: {change.name}": f"{change.baseline} → {change.new}" for change in compared.settings},
        **{side.capitalize(): f"{study.name} ({study.folder})" for side, study in studies.items()},
        "Paths in common": pairing.paths,
        "Pairs": f"{len(pairing.pairs):,}, one for each path{_and_levels(pairing)}",
        **{f"Runs compared, {side}": len(pairing.runs[side]) for side in SIDES},
        **{f"Runs without a partner, {side}": n for side, n in pairing.alone.items() if n},
        **{f"Runs that were not begun, {side}": n for side, n in pairing.not_begun.items() if n},
        **{
            f"Runs still to come, {side}": study.planned - len(study.runs)
            for side, study in studies.items()
            if study.planned > len(study.runs)
        },
    }


def _and_levels(pairing: Pairing) -> str:
    names = [title_and_unit(name)[0] for name in pairing.factors]
    return f" at each level of {listed(names)}" if names else ""


def headlines(compared: Compared) -> Iterator[str]:
    """What the data say, the most important first, each without a full stop."""
    regressions = [change for change in compared.changes if change.is_regression]
    yield from (f"regression: {_told(change)}" for change in regressions)
    if len(compared.regressed):
        yield (
            f"regression: the repeats of {count(len(compared.regressed), 'pair')} fail more often, by more than chance "
            f"explains: {some_of(pair_names(compared.regressed, compared.pairing.factors))}"
        )
    if not regressions and compared.regressed.empty:
        yield _no_regression(compared.pairing.paths, paths_needed(compared.changes))
    yield from _missing(compared)
    if any(change.of_drive for change in compared.settings):
        names = [change.name for change in compared.settings if change.of_drive]
        yield f"the drives are not the same in both ({some_of(names)}), and part of what differs may come from that"
    others = [change for change in compared.changes if change.metric in (SUCCESS, ATE) and change not in regressions]
    yield from (_told(change) for change in others if change.paths)
    counts = outcome_counts(compared.pairing.pairs)
    yield f"of {count(sum(counts.values()), 'pair')} {counts['wins']:,} are better, {counts['losses']:,} worse and " + (
        f"{counts['ties']:,} equal, by the ATE, where a failure is worse than any success"
    )
    if len(compared.broken):
        yield (
            f"all repeats succeeded before and most fail now in {count(len(compared.broken), 'pair')}: "
            f"{some_of(pair_names(compared.broken, compared.pairing.factors))}"
        )


def _missing(compared: Compared) -> Iterator[str]:
    """Runs without a result: those to come, and those the SLAM was never started for."""
    for side, study in (("new study", compared.new), ("baseline", compared.baseline)):
        if (done := len(study.runs)) < study.planned:
            yield f"the {side} is not finished: {done:,} of {count(study.planned, 'run')} have a result"
    not_begun = compared.pairing.not_begun
    if any(not_begun.values()):
        yield (
            f"{count(not_begun['new'], 'run')} of the new study and {not_begun['baseline']:,} of the baseline were not "
            "begun, and are left out"
        )


def _no_regression(paths: int, needed: int) -> str:
    if paths < needed:
        return (
            f"too few paths to tell a regression from chance: {paths}, and {needed} are the least at which even the "
            "clearest one can be told"
        )
    return "no regression: nothing is worse by more than its tolerance and by more than chance explains"


def _told(change: MetricChange) -> str:
    metric = change.metric
    now, before = map(metric.value_text, (change.new, change.baseline))
    over = f"over {count(change.paths, 'path')}{' where both succeeded' if metric is ATE else ''}"
    return f"{metric.name_text} {now}, before {before}: {change.change_text}, {over}"
