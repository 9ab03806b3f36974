"""Does a change make a loss rarer? A test that is honest with a handful of repeats.

The counts of losses with a change and without are compared by Fisher's exact test, one-sided (R. A. Fisher, "The logic
of inductive inference", 1935). Several changes are compared with the same controls, so one of them may look like a cure
by chance: `strictest_p` therefore bounds the chance that any of them does, when none has any effect. That chance is
computed exactly for the worst probability of the loss, in the manner of G. A. Barnard, "Significance tests for 2x2
tables", 1947: a Bonferroni correction of such coarse p-values would need twice as many repeats.

What is claimed, and of what. `judge` compares repeats over one set of frames: they differ in the SLAM's own randomness
alone, so it says nothing of a loss that comes or not by where the frames fall, which every rendering draws anew. What
it credits is therefore looked for again over frames that are drawn anew for each run (`confirm`), by the same test
beside unchanged runs over frames that are drawn anew too. These runs are independent, and the first ones have no part
in their outcome: so in at most FALSE_ALARM of the cases is any change told to matter that does nothing, whether the
loss hangs on the SLAM's randomness, on where the frames fall, or on both.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import count
from typing import NamedTuple

import numpy as np
from scipy import stats

from slamgym.types import FloatArray

FALSE_ALARM = 0.05
"""Largest chance of any claim in a case where no change has an effect, for independent draws of the frames."""
_ROUNDING = 1e-12
_PROBABILITIES = np.linspace(0.01, 0.99, 99)


class Count(NamedTuple):
    """In how many of the repeats the loss occurred."""

    lost: int
    repeats: int

    def __str__(self) -> str:
        return f"{self.lost} of {self.repeats}"


@dataclass(frozen=True, slots=True)
class Finding:
    """What one change, or one control, did. p: chance of so few losses, or fewer, when it does nothing. verdict:
    "vanishes", "helps" (rarer, but not gone) or "unchanged" (not shown to be rarer).
    """

    name: str
    count: Count
    p: float
    verdict: str


@dataclass(frozen=True, slots=True)
class Confirmation:
    """Runs that each have frames of their own. unchanged: without a change. changes: those tried, beside it; none where
    it was not lost often enough for their outcome to tell anything.
    """

    unchanged: Count
    changes: tuple[Finding, ...] = ()


@dataclass(frozen=True, slots=True)
class Judgement:
    """controls: each beside the other ones. changes: each beside all controls. strictest_p: see there."""

    controls: tuple[Finding, ...]
    changes: tuple[Finding, ...]
    strictest_p: float

    @property
    def controls_agree(self) -> bool:
        return all(finding.verdict == "unchanged" for finding in self.controls)

    @property
    def control_count(self) -> Count:
        return pooled(finding.count for finding in self.controls)

    @property
    def is_decisive(self) -> bool:
        """Whether the loss came often enough without a change for its absence with one to tell something."""
        gone = Count(0, self.controls[0].count.repeats)
        return fisher_p(self.control_count, gone) <= self.strictest_p + _ROUNDING

    @property
    def credited(self) -> tuple[str, ...]:
        """The changes that are to be confirmed."""
        return tuple(finding.name for finding in self.changes if finding.verdict != "unchanged")


def judge(controls: Mapping[str, Count], changes: Mapping[str, Count]) -> Judgement:
    """What the changes did, by name, beside controls of two or more; each has the same number of repeats.

    A control for which the loss is rarer than for the others shows that it hangs on chance; no change is then said to
    do anything.
    """
    everything = pooled(controls.values())
    repeats = max(lost.repeats for lost in controls.values())
    limit = strictest_p(everything.repeats, repeats, max(len(changes), 1))
    judged = tuple(
        _finding(name, pooled(other for key, other in controls.items() if key != name), lost, limit)
        for name, lost in controls.items()
    )
    agree = all(finding.verdict == "unchanged" for finding in judged)
    found = (_finding(name, everything, lost, limit if agree else 0.0) for name, lost in changes.items())
    return Judgement(judged, tuple(found), limit)


def draws_needed(changes: int) -> int:
    """The fewest runs without a change, and with each, after which a change that was credited may be confirmed."""
    return next(draws for draws in count(1) if strictest_p(draws, draws, changes))


def can_confirm(unchanged: Count, changes: int) -> bool:
    """Whether it was lost often enough for as many runs without a loss to confirm one of so many changes."""
    gone = Count(0, unchanged.repeats)
    return fisher_p(unchanged, gone) <= strictest_p(unchanged.repeats, unchanged.repeats, changes) + _ROUNDING


def confirm(unchanged: Count, changed: Mapping[str, Count]) -> Confirmation:
    """What the credited changes did over frames drawn anew, by name; each has as many runs as there are unchanged."""
    limit = strictest_p(unchanged.repeats, unchanged.repeats, len(changed))
    return Confirmation(unchanged, tuple(_finding(name, unchanged, lost, limit) for name, lost in changed.items()))


def pooled(counts: Iterable[Count]) -> Count:
    lost, repeats = zip(*counts, strict=True)
    return Count(sum(lost), sum(repeats))


def fisher_p(control: Count, changed: Count) -> float:
    """Chance of `changed.lost` losses or fewer with the change, given how many there were with and without it."""
    everything = pooled((control, changed))
    return float(stats.hypergeom.cdf(changed.lost, everything.repeats, everything.lost, changed.repeats))


@cache
def strictest_p(control_repeats: int, repeats: int, changes: int) -> float:
    """The largest p up to 0.05 that a claim may rest on, so that the chance of any false claim among the changes is at
    most FALSE_ALARM, however probable the loss is; 0.0 where so few repeats allow none.
    """
    p = _p_table(control_repeats, repeats)
    candidates = np.unique(p[p <= FALSE_ALARM + _ROUNDING])[::-1]
    allowed = (
        limit for limit in candidates.tolist() if false_alarm(limit, control_repeats, repeats, changes) <= FALSE_ALARM
    )
    return next(allowed, 0.0)


def false_alarm(limit: float, control_repeats: int, repeats: int, changes: int) -> float:
    """Chance that at least one of the changes has a p up to `limit` though none does anything, at the worst probability
    of the loss. The repeats are independent.
    """
    claimed = _p_table(control_repeats, repeats) <= limit + _ROUNDING
    q = _PROBABILITIES[:, None]
    control = stats.binom.pmf(np.arange(control_repeats + 1), control_repeats, q)
    changed = stats.binom.pmf(np.arange(repeats + 1), repeats, q)
    each = changed @ claimed.T  # (probability, losses of the controls)
    return float((control * (1 - (1 - each) ** changes)).sum(axis=1).max())


def _p_table(control_repeats: int, repeats: int) -> FloatArray:
    """Fisher's p (control_repeats + 1, repeats + 1), by the losses without the change and with it."""
    control, changed = np.ogrid[: control_repeats + 1, : repeats + 1]
    return np.asarray(stats.hypergeom.cdf(changed, control_repeats + repeats, control + changed, repeats))


def _finding(name: str, control: Count, changed: Count, limit: float) -> Finding:
    p = fisher_p(control, changed)
    if p > limit + _ROUNDING:
        return Finding(name, changed, p, "unchanged")
    return Finding(name, changed, p, "helps" if changed.lost else "vanishes")
