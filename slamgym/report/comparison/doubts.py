"""What keeps the comparison of two studies from being judged."""

from collections.abc import Iterator

from slamgym.report.comparison.compared import Compared
from slamgym.report.comparison.differences import paths_needed


def reasons_not_to_judge(compared: Compared) -> Iterator[str]:
    """Why the absence of a regression says nothing, the most fundamental first: expected, got, what to do."""
    new, begun = compared.new, compared.pairing.not_begun
    if (done := len(new.runs)) < new.planned:
        yield f"expected all {new.planned:,} runs of the new study, got {done:,}; wait until it is finished"
    if begun["new"] > begun["baseline"]:
        yield (
            f"expected no more runs that were not begun than the baseline's {begun['baseline']:,}, got "
            f"{begun['new']:,}; see why in the new study's report"
        )
    if (paths := compared.pairing.paths) < (needed := paths_needed(compared.changes)):
        yield f"expected at least {needed} paths in common, got {paths}; run both studies on more"
