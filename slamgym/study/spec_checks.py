"""What is wrong with a study as it is written, before its parameters are looked at."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from slamgym.errors import ConfigError
from slamgym.study.canonical import canonical
from slamgym.study.names import check_name, is_of_drive
from slamgym.study.yaml_file import Place


class Problem(NamedTuple):
    """place: where it stands in the study."""

    message: str
    place: Place


class Paths(Protocol):
    """A group of paths, see `slamgym.study.spec.PathGroup`."""

    @property
    def scene(self) -> tuple[str, ...]: ...
    @property
    def seeds(self) -> tuple[int, ...]: ...
    @property
    def sequence(self) -> tuple[str, ...]: ...


Factors = Sequence[Mapping[str, Sequence[Any]]]


def path_problems(paths: Sequence[Paths]) -> Iterator[Problem]:
    """Of groups of paths: none at all, not clear whether driven or recorded, a path twice."""
    if not paths:
        yield Problem("expected paths to run on, got none; add scenes with seeds, or sequences", ("paths",))
    for k, group in enumerate(paths):
        if bool(group.scene) == bool(group.sequence):
            got = "both" if group.scene else "neither"
            yield Problem(f"expected either scene or sequence in a group of paths, got {got}", ("paths", k))
        elif bool(group.scene) != bool(group.seeds):
            expected = "seeds beside scene, a path each" if group.scene else "no seeds beside sequence"
            yield Problem(f"expected {expected}, got {list(group.seeds) or 'none'}", ("paths", k))
    driven = ((f"{scene} with seed {seed}", k) for k, g in enumerate(paths) for scene in g.scene for seed in g.seeds)
    recorded = ((sequence, k) for k, group in enumerate(paths) for sequence in group.sequence)
    seen = set()
    for path, k in (*driven, *recorded):
        if path in seen:
            yield Problem(f"expected every path once, got {path} again; ask for repeats instead", ("paths", k))
        seen.add(path)


def fixed_problems(fixed: Mapping[str, Any], paths: Sequence[Paths]) -> Iterator[Problem]:
    """Of parameters of all runs: unknown names, such as change no run."""
    for name in fixed:
        place = ("fixed", name)
        yield from _name_problems(name, place)
        if is_of_drive(name) and paths and not any(group.scene for group in paths):
            yield Problem(f"expected only parameters of the SLAM, since all paths are recorded, got {name!r}", place)


def factor_problems(factors: Factors, fixed: Mapping[str, Any], paths: Sequence[Paths]) -> Iterator[Problem]:
    """Of factors: names that are unknown, given twice or without an effect; levels that are none."""
    counted = Counter(fixed.keys())
    for k, entry in enumerate(factors):
        for name, levels in entry.items():
            place = ("factors", k, name)
            yield from _name_problems(name, place)
            yield from _level_problems(name, levels, place)
            counted[name] += 1
            if counted[name] > 1:
                where = "fixed and factors" if name in fixed else "factors"
                yield Problem(f"expected every name once, got {name!r} twice in {where}", place)
            if is_of_drive(name) and any(group.sequence for group in paths):
                yield Problem(
                    f"expected factors of the SLAM, since recorded sequences are as they are, got {name!r}", place
                )
        yield from _entry_problems(entry, ("factors", k))


def _name_problems(name: str, place: Place) -> Iterator[Problem]:
    try:
        check_name(name)
    except ConfigError as error:
        yield Problem(str(error), place)


def _level_problems(name: str, levels: Sequence[Any], place: Place) -> Iterator[Problem]:
    if not levels:
        yield Problem(f"{name}: expected one level or more, got none", place)
    for k, level in enumerate(levels):
        if isinstance(level, Mapping | list | tuple):
            yield Problem(f"{name}: expected a number, a text, on, off or null as level, got {level!r}", (*place, k))


def _entry_problems(entry: Mapping[str, Sequence[Any]], place: Place) -> Iterator[Problem]:
    """Of names that go together."""
    if not entry:
        yield Problem("expected a factor with its levels, got nothing", place)
    if len({len(levels) for levels in entry.values()}) > 1:
        got = ", ".join(f"{len(levels)} of {name}" for name, levels in entry.items())
        yield Problem(
            f"expected as many levels of each name in an entry, since they go together, got {got}; for all "
            "combinations give each its own dash",
            (*place, list(entry)[-1]),
        )
    seen = set()
    for k, row in enumerate(zip(*entry.values(), strict=False)):
        if canonical(row) in seen:
            got = ", ".join(f"{name} {level!r}" for name, level in zip(entry, row, strict=True))
            yield Problem(f"expected every level once, got {got} again", (*place, next(iter(entry)), k))
        seen.add(canonical(row))
