"""What the experiments came to, in words and as data."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from slamgym.eval.statistics import proportion_interval
from slamgym.explain.cases import Case, Metres
from slamgym.explain.verdict import Count, Finding, Judgement

VERDICTS = ("explained", "helped", "none of these", "undecided", "controls differ", "not reproduced")
"""What may be said of a loss: a single change makes it vanish; one makes it rarer; none does; it came too rarely to
tell; it hangs on chance; it did not come again."""


@dataclass(frozen=True, slots=True)
class CaseResult:
    """first_looks: in how many repeats the loss came again, by the stretch. judgement: None where it did not. left_out:
    change -> why it was not tried.
    """

    case: Case
    first_looks: tuple[tuple[Metres, Count], ...]
    judgement: Judgement | None = None
    left_out: Mapping[str, str] = field(default_factory=dict)

    @property
    def verdict(self) -> str:
        """One of VERDICTS."""
        if self.judgement is None:
            return "not reproduced"
        if not self.judgement.controls_agree:
            return "controls differ"
        found = {finding.verdict for finding in self.judgement.changes}
        if "vanishes" in found:
            return "explained"
        if "helps" in found:
            return "helped"
        return "none of these" if self.judgement.is_decisive else "undecided"

    @property
    def cures(self) -> tuple[Finding, ...]:
        """The changes that each make the loss vanish."""
        return () if self.judgement is None else _with_verdict("vanishes", self.judgement)

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
            return f"{self.name} vanishes with {_listed(cures)}; unchanged {control}"
        if helps := _with_verdict("helps", self.judgement):
            return f"{self.name} vanishes with none of these, it is rarer with {_listed(helps)}; unchanged {control}"
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
            "changes": [] if judgement is None else [_flat(finding) for finding in judgement.changes],
            "left_out": dict(self.left_out),
        }


def _with_verdict(verdict: str, judgement: Judgement) -> tuple[Finding, ...]:
    return tuple(finding for finding in judgement.changes if finding.verdict == verdict)


def _listed(findings: Iterable[Finding]) -> str:
    """Changes in words, each with its count."""
    return " or with ".join(f"{finding.name} ({finding.count})" for finding in findings)


def _flat(finding: Finding) -> dict[str, Any]:
    return {"name": finding.name, **finding.count._asdict(), "p": finding.p, "verdict": finding.verdict}


def summary_sentences(results: Sequence[CaseResult]) -> list[str]:
    """What several experiments come to together; nothing for fewer than two."""
    if len(results) < 2:
        return []
    judged = [result.judgement for result in results if result.judgement is not None]
    explained = sum(result.verdict == "explained" for result in results)
    share = proportion_interval(explained, len(judged))
    interval = f"{100 * share.estimate:.0f} %, 95 % interval {100 * share.low:.0f} to {100 * share.high:.0f} %"
    return [
        f"came again: {len(judged)} of {len(results)} losses",
        f"vanish with a single change: {explained} of {len(judged)}" + (f" ({interval})" if judged else ""),
        f"controls agree: {sum(judgement.controls_agree for judgement in judged)} of {len(judged)}",
    ]


def by_change(results: Iterable[CaseResult]) -> dict[str, Count]:
    """Change -> of how many losses that it was tried on it made vanish."""
    tried: dict[str, list[bool]] = {}
    for result in results:
        for finding in result.judgement.changes if result.judgement else ():
            tried.setdefault(finding.name, []).append(finding.verdict == "vanishes")
    return {name: Count(sum(vanished), len(vanished)) for name, vanished in tried.items()}
