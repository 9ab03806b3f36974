"""Which metres of the path are driven again for which loss."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from slamgym.explain.source import DrivenRun, Loss

Metres = tuple[float, float]
"""From and to, along the planned path."""

EARLIER_M = 1.0
"""In a repeat the loss may come so much earlier and still be the same."""


@dataclass(frozen=True, slots=True)
class Case:
    """A loss, and those after it in the same stretch. stretch_m: what is driven. window_m: where it must be lost."""

    run: DrivenRun
    losses: tuple[Loss, ...]
    stretch_m: Metres
    window_m: Metres

    @property
    def loss(self) -> Loss:
        return self.losses[0]

    @property
    def whole_m(self) -> Metres:
        """All that was driven up to the end of the stretch."""
        return self.run.stretch_m[0], self.stretch_m[1]


def cases_of(run: DrivenRun, before_m: float, after_m: float) -> Iterator[Case]:
    """The cases of a run: each stretch reaches from `before_m` before a loss to `after_m` after its start, as far as
    the run was driven there; losses that begin in it afterwards belong to the same case.
    """
    left = run.losses
    first_m, last_m = run.stretch_m
    while left:
        at_m = left[0].progress_m
        stretch_m = max(first_m, at_m - before_m), min(last_m, at_m + after_m)
        within = tuple(loss for loss in left if loss.progress_m <= stretch_m[1])
        yield Case(run, within, stretch_m, (max(stretch_m[0], at_m - EARLIER_M), stretch_m[1]))
        left = left[len(within) :]


def picked(cases: Sequence[Sequence[Case]], most: int | None) -> list[Case]:
    """At most so many of the cases of several runs: the first of each run, then the second of each, and so on."""
    in_turn = sorted((rank, number) for number, of_run in enumerate(cases) for rank in range(len(of_run)))[:most]
    return [cases[number][rank] for number, rank in sorted((number, rank) for rank, number in in_turn)]
