"""What the data say, in sentences, the most important first; nothing that they do not say."""

from collections.abc import Iterator, Sequence

from slamgym.eval.statistics import FailureThreshold, clustered_share
from slamgym.report.causes import causes_text
from slamgym.report.failures import trend_text
from slamgym.report.judged import JudgedRuns, left_out_text, shared_houses
from slamgym.report.levels import Factor, find_factors, with_levels
from slamgym.report.pairs import counts_text, difference_text, furthest, ratio_text
from slamgym.report.shares import FEWEST_PATHS, LevelComparison, Trend
from slamgym.report.wording import confidence, count, number, percent, percent_range, sentence
from slamgym.study.results import StudyResults
from slamgym.study.table import was_run

ALWAYS_TOLD = "loop_closure"
"""A factor of which people ask even where nothing is seen."""


def headlines(
    judged: JudgedRuns,
    seen: Sequence[Trend],
    compared: Sequence[LevelComparison],
    threshold: FailureThreshold | None,
) -> tuple[str, ...]:
    """Sentences from what the other modules computed. threshold: None without a judged run."""
    told: list[str] = []
    if threshold is not None:
        told += [*_of_trends(judged, seen), _overall(judged)]
        with_trend = {trend.factor for trend in seen if trend.is_seen}
        told += [*_of_levels(judged, with_trend, compared), *_of_accuracy(compared)]
        told += [causes_text(judged), *_of_threshold(threshold), *_untold(judged)]
    return tuple(map(sentence, told))


def notices(results: StudyResults, judged: JudgedRuns) -> tuple[str, ...]:
    """What of the study the headlines are silent about: runs still to come, not to be had, or left out."""
    told = [*_unfinished(results), *_not_run(results, judged)]
    if len(judged.table):
        told += [text for text in (*_levels_not_run(results), left_out_text(judged)) if text]
    return tuple(map(sentence, told))


def _unfinished(results: StudyResults) -> Iterator[str]:
    done = len(results.runs)
    if done < results.planned:
        yield f"the study is not finished: {done:,} of {results.planned:,} runs are done, and all below is of these"


def _not_run(results: StudyResults, judged: JudgedRuns) -> Iterator[str]:
    missing = len(results.runs) - len(judged.table)
    if not len(judged.table):
        yield f"there is no run to judge{f': {missing:,} could not be started' if missing else ''}"
    elif missing:
        yield f"{count(missing, 'run')} could not be started and {'is' if missing == 1 else 'are'} left out"


def _levels_not_run(results: StudyResults) -> Iterator[str]:
    """The levels that the rest is silent about, as none of their runs could be started."""
    runs = results.runs.reset_index(drop=True)
    not_run = ~was_run(runs)
    for factor in (factor for name in results.factors for factor in find_factors(runs, [name])):
        levels = with_levels(runs, [factor])[factor.column]
        for level in factor.levels:
            if not_run[levels == level].all():
                yield f"no run {factor.at(level)} could be started"


def _overall(judged: JudgedRuns) -> str:
    table = judged.table
    share = clustered_share(table["failed"].to_numpy(bool), table["place"].to_numpy(str))
    counts = f"{int(table['failed'].sum()):,} of {count(len(table), 'run')} failed"
    if judged.paths < 2:
        return f"{counts}, all on one path, which tells nothing of others"
    if judged.paths < FEWEST_PATHS:
        return f"{counts} ({percent(share.estimate)}) on {judged.paths} paths"
    houses = shared_houses(judged)
    inside = f" in these {houses:,} houses" if houses > 1 else " in this house" if houses else ""
    interval = f"{confidence(share)} {percent_range(share)} for paths like these {judged.paths:,}{inside}"
    return f"{counts} ({percent(share.estimate)}; {interval})"


def _of_trends(judged: JudgedRuns, seen: Sequence[Trend]) -> list[str]:
    """First those of which half of the runs fail at a level that was tried; last what neither rises nor falls."""
    told = [trend for trend in seen if trend.changes]
    ordered = sorted(told, key=lambda trend: (not trend.midpoint_is_known, not trend.is_seen))
    return [trend_text(trend, len(judged.factors) > 1) for trend in ordered]


def _of_levels(judged: JudgedRuns, with_trend: set[Factor], compared: Sequence[LevelComparison]) -> list[str]:
    """Of factors without a trend: first the levels that differ, then factors of which nothing is seen."""
    rest = [one for one in compared if one.factor not in with_trend]
    by_factor = [[one for one in rest if one.factor is factor] for factor in judged.factors]
    differing = [one for one in rest if one.differs and one.paths >= FEWEST_PATHS]
    alike = [levels for levels in by_factor if levels and not any(one in differing for one in levels)]
    return [*map(difference_text, differing), *map(_nothing_seen, alike)]


def _nothing_seen(levels: Sequence[LevelComparison]) -> str:
    """Of several levels of which none differs, the one furthest off says most; on few paths the last is told.

    Of levels equally far off, that of the largest step of the factor.
    """
    enough = [one for one in reversed(levels) if one.paths >= FEWEST_PATHS]
    if enough:
        return difference_text(max(enough, key=lambda one: abs(one.difference.estimate)))
    return f"{counts_text(levels[-1])}, on {count(levels[-1].paths, 'path')}"


def _of_accuracy(compared: Sequence[LevelComparison]) -> Iterator[str]:
    """The furthest level of each factor against the first, where the ATE differs; of loop closing in any case."""
    for one in furthest(compared):
        asked = ALWAYS_TOLD in one.factor.names and one.both_paths >= FEWEST_PATHS
        if one.ratio_differs or asked:
            yield ratio_text(one)


def _of_threshold(threshold: FailureThreshold) -> Iterator[str]:
    if threshold.found:
        limit, (low, high) = number(threshold.threshold.estimate), map(number, threshold.gap)
        yield (
            f"a gap parts good runs from bad ones: none has an ATE between {low} and {high} m, {threshold.above:,} "
            f"have a larger one (threshold {limit} m)"
        )


def _untold(judged: JudgedRuns) -> Iterator[str]:
    if judged.paths < FEWEST_PATHS:
        yield (
            f"with {count(judged.paths, 'path')} the figures tell of these only; {FEWEST_PATHS} or more, better 20, "
            "are needed to tell of others"
        )
