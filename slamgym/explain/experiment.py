"""The experiment on one loss: controls, changes one at a time, repeats, in turn.

First it is seen whether the loss comes again at all: most of some repeats of the unchanged stretch must lose it, else
of the whole drive up to it. These repeats count no more afterwards, since they were picked for their outcome; but where
some of them did not lose it, twice as many follow as were asked for.

Then come three controls and all changes, a repeat of each in turn, so that what else the computer does meets all alike.
Two controls are the same frames again. The third starts 0.1 m elsewhere, and so its frames are taken elsewhere: a loss
that hangs on just where they are taken is a matter of chance, and no change can be given the credit for its absence.

A change that is credited may still owe it to where its own frames fell, which all its repeats share. So it is driven
again, and the unchanged stretch too, from starts that are drawn at random, each driven and run once.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from slamgym.explain.cases import Case, Metres
from slamgym.explain.changes import Setup, changes_of
from slamgym.explain.result import CaseResult
from slamgym.explain.stretch import (
    Stretches,
    Variant,
    check_house,
    is_lost,
    quickest_turn,
    run_slam,
    why_not_comparable,
)
from slamgym.explain.verdict import Confirmation, Count, can_confirm, confirm, draws_needed, judge
from slamgym.run_folder import write_run

UNCHANGED, AGAIN, ELSEWHERE = "unchanged", "unchanged again", "another start"
START_MOVED_M = 0.1
STARTS_WITHIN_M = 0.3
"""Further than most drives get between two frames that a SLAM is fed, so that these fall anywhere."""
DRAWS_PER_REPEAT = 2
"""Runs over other frames for each repeat: of a loss that comes in 8 of 10 of them, 3 runs would confirm a cure in half
of the cases, 6 do in 9 of 10.
"""
OTHER_FRAMES = "other_frames"

OnStep = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Bench:
    """How the repeats of one case are carried out. folder: gets a run folder CHANGE/N for each of them. on_step: called
    with what is done, for each drive and each SLAM run.
    """

    case: Case
    stretches: Stretches
    folder: Path
    repeats: int
    workers: int
    on_step: OnStep

    def count(self, variants: Mapping[str, Variant]) -> dict[str, Count]:
        """In how many repeats of each variant it was lost."""
        return self.count_runs({name: [variant] * self.repeats for name, variant in variants.items()})

    def count_runs(self, runs: Mapping[str, Sequence[Variant]]) -> dict[str, Count]:
        """In how many of the runs below each name it was lost: all drives first, then the SLAM runs in turn."""
        for variants in runs.values():
            for variant in variants:
                self.stretches.drive(variant)
        lost = dict.fromkeys(runs, 0)
        for name, occurred in self._outcomes(runs):
            lost[name] += occurred
        return {name: Count(count, len(runs[name])) for name, count in lost.items()}

    def _outcomes(self, runs: Mapping[str, Sequence[Variant]]) -> Iterator[tuple[str, bool]]:
        in_turn = sorted((number, name) for name, variants in runs.items() for number in range(len(variants)))
        with ThreadPoolExecutor(self.workers) as pool:
            running = {
                pool.submit(run_slam, self.stretches.drive(variant), variant.setup): (name, number, variant)
                for number, name in in_turn
                for variant in [runs[name][number]]
            }
            try:
                for run in as_completed(running):
                    name, number, variant = running[run]
                    self.on_step(f"{name}, repeat {number + 1}")
                    write_run(run.result(), self.folder / folder_name(name) / str(number + 1))
                    yield name, is_lost(run.result(), variant.stretch_m[0], self.case.window_m)
            finally:
                pool.shutdown(wait=False, cancel_futures=True)


def folder_name(variant: str) -> str:
    return variant.replace(" ", "_")


def run_case(case: Case, folder: Path, repeats: int, workers: int, on_step: OnStep) -> CaseResult:
    """Carry the experiment out. folder: gets the run folders, and the frames as long as it lasts.

    Raises ConfigError, SceneError, RenderError and SlamError where the drive or the SLAM cannot be repeated here,
    OutputError where nothing can be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(prefix=".frames-", dir=folder) as frames:
        bench = Bench(case, Stretches(case.run, Path(frames), on_step), folder, repeats, workers, on_step)
        seen: dict[Metres, Count] = {}
        for stretch_m in dict.fromkeys((case.stretch_m, case.whole_m)):
            seen[stretch_m] = _first_look(bench, stretch_m)
            if 2 * seen[stretch_m].lost > repeats:
                always = seen[stretch_m].lost == repeats
                return _compared(replace(bench, repeats=repeats if always else 2 * repeats), stretch_m, seen)
    return CaseResult(case, tuple(seen.items()))


def _first_look(bench: Bench, stretch_m: Metres) -> Count:
    unchanged = Variant(bench.case.run.setup, stretch_m)
    check_house(bench.case.run, bench.stretches.drive(unchanged))
    name = "first look" if stretch_m == bench.case.stretch_m else "first look at the whole drive"
    return bench.count({name: unchanged})[name]


def _compared(bench: Bench, stretch_m: Metres, seen: Mapping[Metres, Count]) -> CaseResult:
    setup = bench.case.run.setup
    unchanged = bench.stretches.drive(Variant(setup, stretch_m))
    setup = replace(setup, turned_radps=quickest_turn(unchanged, stretch_m[0], bench.case.window_m))
    controls = {name: Variant(setup, begin) for name, begin in _starts(stretch_m).items()}
    variants = {name: Variant(changed, stretch_m) for name, changed in changes_of(setup).items()}
    left_out = {name: why_not_comparable(unchanged, bench.stretches.drive(one)) for name, one in variants.items()}
    changes = {name: variant for name, variant in variants.items() if not left_out[name]}
    counts = bench.count({**controls, **changes})
    judgement = judge({name: counts[name] for name in controls}, {name: counts[name] for name in changes})
    credited = {name: changes[name].setup for name in judgement.credited}
    return CaseResult(
        bench.case,
        tuple(seen.items()),
        judgement,
        _confirmed(bench, stretch_m, credited) if credited else None,
        {name: why for name, why in left_out.items() if why},
    )


def _confirmed(bench: Bench, stretch_m: Metres, credited: Mapping[str, Setup]) -> Confirmation:
    bench = replace(bench, folder=bench.folder / OTHER_FRAMES)
    setups = {UNCHANGED: bench.case.run.setup, **credited}
    draws = max(draws_needed(len(credited)), DRAWS_PER_REPEAT * bench.repeats)
    # Of its own for each run, so that no two outcomes depend on each other; the same whenever the case is explained.
    rng = np.random.default_rng((bench.case.run.seed, bench.case.loss.number))
    moves_m = rng.uniform(0.0, STARTS_WITHIN_M, (len(setups), draws)).tolist()
    runs = {
        name: [Variant(setup, _moved(stretch_m, by_m)) for by_m in row]
        for (name, setup), row in zip(setups.items(), moves_m, strict=True)
    }
    unchanged = bench.count_runs({UNCHANGED: runs.pop(UNCHANGED)})[UNCHANGED]
    return confirm(unchanged, bench.count_runs(runs)) if can_confirm(unchanged, len(runs)) else Confirmation(unchanged)


def _starts(stretch_m: Metres) -> dict[str, Metres]:
    """The stretches of the controls."""
    return {UNCHANGED: stretch_m, AGAIN: stretch_m, ELSEWHERE: _moved(stretch_m, START_MOVED_M)}


def _moved(stretch_m: Metres, by_m: float) -> Metres:
    """The stretch with an earlier start, or a later one where there is nothing before."""
    begin_m, end_m = stretch_m
    return begin_m - by_m if begin_m >= by_m else begin_m + by_m, end_m
