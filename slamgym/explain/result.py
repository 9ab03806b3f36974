"""What the experiments came to, in words and as data."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from slamgym.eval.statistics import clustered_share
from slamgym.explain.cases import Case, Metres
from slamgym.explain.verdict import Confirmation, Count, Finding, Judgement

VERDICTS = ("explained", "helped", "none of these", "undecided", "controls differ", "not reproduced")
"""What may be said of a loss: a single change makes it vanish; one makes it rarer; none does; it came too rarely to
tell, or what a change did came from where the frames fell; it hangs on chance; it did not come again."""
UNCONFIRMED = "not confirmed"
"""The verdict on a change that is credited over one set of frames, and not over others."""


@dataclass(frozen=True, slots=True)
class CaseResult:
    """first_looks: in how many repeats the loss came again, by the stretch. judgement: None where it did not.
    confirmation: of the changes that it credits, None where there are none. left_out: change -> why it was not tried.
    """

    case: Case
    first_looks: tuple[tuple[Metres, Count], ...]
    judgement: Judgement | None = None
    confirmation: Confirmation | None = None
    left_out: Mapping[str, str] = field(default_factory=dict)

    @property
    def verdict(self) -> str:
        """One of VERDICTS."""
        if self.judgement is None:
            return "not reproduced"
        if not self.judgement.controls_agree:
            return "controls differ"
        found = {self.verdict_on(finding) for finding in self.judgement.changes}
        if "vanishes" in found:
            return "explained"
        if "helps" in found:
            return "helped"
        if UNCONFIRMED in found:
            return "undecided"
        return "none of these" if self.judgement.is_decisive else "undecided"

    @property
    def cures(self) -> tuple[Finding, ...]:
        """The changes that each make the loss vanish."""
        return self._with_verdict("vanishes")

    def confirmed(self, change: str) -> Finding | None:
        """What the change did over frames drawn anew; None where it was not tried."""
        found = () if self.confirmation is None else self.confirmation.changes
        return next((finding for finding in found if finding.name == change), None)

    def verdict_on(self, finding: Finding) -> str:
        """On a change of the judgement, after both tests: "vanishes", "helps", UNCONFIRMED or "unchanged"."""
        if finding.verdict == "unchanged":
            return "unchanged"
        again = self.confirmed(finding.name)
        if again is None or again.verdict == "unchanged":
            return UNCONFIRMED
        return "vanishes" if finding.verdict == again.verdict == "vanishes" else "helps"

    @property
    def name(self) -> str:
        return f"the loss at {self.case.loss.start_s:.1f} s"

    def sentence(self) -> str:
        """What it comes to, in one sentence."""
        if self.judgement is None:
            looks = " and ".join(f"{count} from {m[0]:.1f} m on" for m, count in self.first_looks)
            return f"{self.name} did not come again: {looks}"
        control = self.judgement.control_count
        if not self.judgement.controls_agree:
            counts = ", ".join(f"{one.name} {one.count}" for one in self.judgement.controls)
            return f"{self.name} hangs on chance, so no change can be said to matter: {counts}"
        if cures := self.cures:
            return f"{self.name} vanishes with {self._listed(cures)}; {self._unchanged()}"
        if helps := self._with_verdict("helps"):
            rarer = self._listed(helps)
            return f"{self.name} vanishes with none of these, it is rarer with {rarer}; {self._unchanged()}"
        if unconfirmed := self._with_verdict(UNCONFIRMED):
            return f"{self.name} is undecided: {self._why()}: {self._listed(unconfirmed)}; {self._unchanged()}"
        if not self.judgement.is_decisive:
            return f"{self.name} comes too rarely to tell, unchanged {control}: take more repeats"
        return f"{self.name} vanishes with none of these {len(self.judgement.changes)} changes; unchanged {control}"

    def data(self) -> dict[str, Any]:
        """For `explain.json`."""
        case, judgement = self.case, self.judgement
        return {
            "run": str(case.run.folder),
            "losses": [asdict(loss) for loss in case.losses],
            "stretch_m": self.first_looks[-1][0],
            "window_m": case.window_m,
            "verdict": self.verdict,
            "sentence": self.sentence(),
            "first_looks": [{"stretch_m": metres, **count._asdict()} for metres, count in self.first_looks],
            "strictest_p": None if judgement is None else judgement.strictest_p,
            "controls": [] if judgement is None else [_flat(finding) for finding in judgement.controls],
            "changes": [] if judgement is None else [self._told(finding) for finding in judgement.changes],
            "unchanged_over_other_frames": None if self.confirmation is None else self.confirmation.unchanged._asdict(),
            "left_out": dict(self.left_out),
        }

    def _told(self, finding: Finding) -> dict[str, Any]:
        again = self.confirmed(finding.name)
        other = None if again is None else {**again.count._asdict(), "p": again.p}
        return {**_flat(finding), "verdict": self.verdict_on(finding), "over_other_frames": other}

    def _with_verdict(self, verdict: str) -> tuple[Finding, ...]:
        changes = () if self.judgement is None else self.judgement.changes
        return tuple(finding for finding in changes if self.verdict_on(finding) == verdict)

    def _listed(self, findings: Iterable[Finding]) -> str:
        """Changes in words, each with its counts."""
        return " or with ".join(f"{one.name} ({_counts(one.count, self.confirmed(one.name))})" for one in findings)

    def _why(self) -> str:
        """Why the changes that were credited are not confirmed."""
        assert self.confirmation is not None
        if self.confirmation.changes or not self.confirmation.unchanged.lost:
            return "it hangs on where the frames fall"
        return "over other frames it comes too rarely to tell, take more repeats"

    def _unchanged(self) -> str:
        assert self.judgement is not None
        assert self.confirmation is not None
        return f"unchanged {self.judgement.control_count}, over other frames {self.confirmation.unchanged}"


def _counts(count: Count, again: Finding | None) -> str:
    return str(count) if again is None else f"{count}, over other frames {again.count}"


def _flat(finding: Finding) -> dict[str, Any]:
    return {"name": finding.name, **finding.count._asdict(), "p": finding.p, "verdict": finding.verdict}


def summary_sentences(results: Sequence[CaseResult]) -> list[str]:
    """What several experiments come to together; nothing for fewer than two."""
    if len(results) < 2:
        return []
    judged = [result for result in results if result.judgement is not None]
    agree = sum(result.judgement.controls_agree for result in judged if result.judgement is not None)
    explained = sum(result.verdict == "explained" for result in judged)
    return [
        f"came again: {len(judged)} of {len(results)} losses",
        f"vanish with a single change: {explained} of {len(judged)}" + _interval(judged),
        f"controls agree: {agree} of {len(judged)}",
    ]


def _interval(judged: Sequence[CaseResult]) -> str:
    """In words, how large the share of the explained may be; losses of one path say less than those of many."""
    if not judged:
        return ""
    share = clustered_share([result.verdict == "explained" for result in judged], [_path(one) for one in judged])
    if not np.isfinite(share.low):
        return f" ({100 * share.estimate:.0f} %, all of one path, which tells nothing of others)"
    return f" ({100 * share.estimate:.0f} %, 95 % interval {100 * share.low:.0f} to {100 * share.high:.0f} %)"


def _path(result: CaseResult) -> str:
    """The same for all runs of one path."""
    return f"{result.case.run.setup.drive.scene} #{result.case.run.seed}"


def by_change(results: Iterable[CaseResult]) -> dict[str, Count]:
    """Change -> of how many losses that it was tried on it made vanish."""
    tried: dict[str, list[bool]] = {}
    for result in results:
        for finding in result.judgement.changes if result.judgement else ():
            tried.setdefault(finding.name, []).append(result.verdict_on(finding) == "vanishes")
    return {name: Count(sum(vanished), len(vanished)) for name, vanished in tried.items()}
