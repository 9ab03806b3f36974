"""All runs of a study, checked before the first of them begins."""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import product
from math import prod
from pathlib import Path
from typing import Any, NamedTuple

from slamgym.camera import PinholeCamera
from slamgym.params import DriveParams
from slamgym.scenes.registry import SceneSource
from slamgym.study.canonical import canonical, name_for_folder, slug_of
from slamgym.study.names import is_of_drive
from slamgym.study.planned import PlannedDrive, PlannedRun
from slamgym.study.settings import DriveSetting, checked, drive_setting, keywords, slam_setting
from slamgym.study.spec import PathGroup, StudySpec, factor_names
from slamgym.study.yaml_file import Place

Levels = Mapping[str, Any]

MAX_RUNS = 1_000_000
"""Of a study: their ids and rows fit into memory, and they take a cluster months."""


class _Combinations(NamedTuple):
    """Levels of the drive's factors, and the combinations of the SLAM's that go with them."""

    drive: Levels
    slam: list[Levels]


class _SlamRun(NamedTuple):
    """How a SLAM runs over a drive, and the last part of its runs' ids, but for the repeat."""

    name: str
    slam: dict[str, Any]
    levels: Levels
    busy_processes: int


class _Drive(NamedTuple):
    """A drive, the levels of its factors, what its frames are like, and the SLAM runs over them."""

    planned: PlannedDrive
    levels: Levels
    camera: PinholeCamera
    fps: float
    slam: list[Levels]


def plan_study(spec: StudySpec) -> tuple[PlannedRun, ...]:
    """The runs, path after path and drive after drive, so that the frames of one are not needed for long.

    Every combination of parameters is checked, every scene looked up and every sequence's folder. Raises ConfigError,
    with the line of the study file that is to blame.
    """
    _check_size(spec)
    known: dict[Any, _SlamRun] = {}
    paths: dict[str, str] = {}
    runs: list[PlannedRun] = []
    for k, group in enumerate(spec.paths):
        for drive in _drives(spec, group, ("paths", k)):
            _check_path(spec, drive.planned, paths, ("paths", k))
            for levels in drive.slam:
                runs += _runs(spec, drive, levels, known)
    _check_different(spec, runs)
    return tuple(runs)


def run_count(spec: StudySpec) -> int:
    """How many runs the study has, without a look at scenes and sequences."""
    paths = sum(len(group.scene) * len(group.seeds) + len(group.sequence) for group in spec.paths)
    return paths * spec.repeats * prod(len(next(iter(entry.values()))) for entry in spec.factors)


def _combinations(spec: StudySpec) -> list[_Combinations]:
    """All combinations of levels, those of one drive together."""
    entries = [
        [dict(zip(entry, row, strict=True)) for row in zip(*entry.values(), strict=True)] for entry in spec.factors
    ]
    combined: dict[str, _Combinations] = {}
    for chosen in product(*entries):
        levels = {name: level for entry in chosen for name, level in entry.items()}
        drive = {name: level for name, level in levels.items() if is_of_drive(name)}
        slam = {name: level for name, level in levels.items() if name not in drive}
        combined.setdefault(canonical(drive), _Combinations(drive, [])).slam.append(slam)
    return list(combined.values())


def _drives(spec: StudySpec, group: PathGroup, place: Place) -> Iterator[_Drive]:
    combinations = _combinations(spec)
    for sequence in group.sequence:
        yield _recorded(spec, group, sequence, combinations[0].slam, place)
    fixed = {name: value for name, value in spec.fixed.items() if is_of_drive(name)}
    for scene in group.scene:
        check = partial(drive_setting, scene)
        settings = [checked(spec, {**combined.drive, **fixed}, check, place) for combined in combinations]
        for seed in group.seeds:
            for setting, combined in zip(settings, combinations, strict=True):
                yield _rendered(group, seed, setting, combined)


def _rendered(group: PathGroup, seed: int, setting: DriveSetting, combined: _Combinations) -> _Drive:
    levels = {name: setting.values[name] for name in combined.drive}
    path = f"{_scene_name(setting.source)} #{seed}"
    planned = PlannedDrive(
        drive_id=name_for_folder(slug_of(path, levels), {**setting.depends_on, "seed": seed}),
        dataset=group.dataset or _dataset(setting.source),
        path=path,
        params={"scene": setting.params.scene, **keywords(setting)},
        seed=seed,
        agent=setting.conditions.agent,
        max_episode_steps=setting.conditions.max_episode_steps,
    )
    return _Drive(planned, levels, setting.params.camera, setting.params.fps, combined.slam)


def _recorded(spec: StudySpec, group: PathGroup, sequence: str, slam: list[Levels], place: Place) -> _Drive:
    folder = Path(sequence)
    if not folder.is_dir():
        raise spec.error(f"sequence: expected a folder, got {sequence!r}, which is none; check the path", *place)
    planned = PlannedDrive(
        drive_id=name_for_folder(slug_of(folder.name, {}), {"sequence": sequence}),
        dataset=group.dataset or folder.parent.name or folder.name,
        path=folder.name,
        params={},
        sequence=sequence,
    )
    as_usual = DriveParams()  # the frames' own are known when they are read
    return _Drive(planned, {}, as_usual.camera, as_usual.fps, slam)


def _scene_name(source: SceneSource) -> str:
    """A file's with the folder above, for of SUNCG every one is called house.json."""
    return "/".join(source.source.parts[-2:]) if isinstance(source.source, Path) else source.name


def _dataset(source: SceneSource) -> str:
    is_file = isinstance(source.source, Path) and source.name == str(source.source)
    return Path(source.name).stem if is_file else source.name.partition(":")[0]


def _runs(spec: StudySpec, drive: _Drive, levels: Levels, known: dict[Any, _SlamRun]) -> Iterator[PlannedRun]:
    """The repeats of one SLAM run over a drive. known: the SLAM runs that are checked already."""
    key = canonical(levels), drive.camera, drive.fps
    if key not in known:
        known[key] = _slam_run(spec, drive, levels)
    run = known[key]
    either = {**drive.levels, **run.levels}
    in_order = {name: either[name] for name in factor_names(spec)}
    for repeat in range(1, spec.repeats + 1):
        run_id = f"{drive.planned.drive_id}/{run.name}_r{repeat}"
        yield PlannedRun(run_id, drive.planned, run.slam, repeat, in_order, run.busy_processes)


def _slam_run(spec: StudySpec, drive: _Drive, levels: Levels) -> _SlamRun:
    fixed = {name: value for name, value in spec.fixed.items() if not is_of_drive(name)}
    check = partial(slam_setting, camera=drive.camera, fps=drive.fps)
    setting = checked(spec, {**levels, **fixed}, check, ("fixed",))
    understood = {name: setting.values[name] for name in levels}
    slug = slug_of(setting.params.slam, {name: level for name, level in understood.items() if name != "slam"})
    name = name_for_folder(slug, setting.depends_on)
    return _SlamRun(name, keywords(setting), understood, setting.conditions.busy_processes)


def _check_size(spec: StudySpec) -> None:
    if (count := run_count(spec)) > MAX_RUNS:
        place = "repeats" if spec.repeats > 1 else "factors"
        raise spec.error(f"expected at most {MAX_RUNS:,} runs, got {count:,}; make several studies of it", place)


def _check_path(spec: StudySpec, drive: PlannedDrive, paths: dict[str, str], place: Place) -> None:
    """Runs are paired by the names of their paths: two paths of one name would be taken for one."""
    what = drive.sequence or f"{drive.params['scene']} with seed {drive.seed}"
    if paths.setdefault(drive.path, what) != what:
        raise spec.error(
            f"expected paths of different names, got {drive.path!r} for {paths[drive.path]} and {what}; rename one",
            *place,
        )


def _check_different(spec: StudySpec, runs: Sequence[PlannedRun]) -> None:
    seen: set[str] = set()
    for run in runs:
        if run.run_id in seen:
            raise spec.error(
                f"expected runs that differ, got the same again for {run.drive.path} with {run.levels}: are two levels "
                "the same by other names?",
                "factors",
            )
        seen.add(run.run_id)
