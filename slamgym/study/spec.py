"""What a study file says."""

import re
from collections.abc import Iterable, Mapping
from itertools import chain
from pathlib import Path
from typing import Annotated, Any, ClassVar, Self

from pydantic import (
    BeforeValidator,
    Field,
    PrivateAttr,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)
from pydantic_core import ErrorDetails, PydanticCustomError

from slamgym.checked_params import Params
from slamgym.errors import ConfigError, unknown_word
from slamgym.files import write_atomically
from slamgym.params import SlamParams
from slamgym.study.located import located_file, located_scene
from slamgym.study.names import flat, takes_file
from slamgym.study.shipped import find_study
from slamgym.study.spec_checks import factor_problems, fixed_problems, path_problems
from slamgym.study.yaml_file import Place, YamlFile, dump_yaml, read_yaml

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")
_PROBLEM = "problem"


def _listed(values: Any) -> Any:
    """One value stands for a list of it."""
    return values if isinstance(values, list | tuple) else [values]


Texts = Annotated[tuple[Annotated[str, Field(min_length=1)], ...], Field(min_length=1), BeforeValidator(_listed)]
Seeds = Annotated[tuple[Annotated[int, Field(ge=0, strict=True)], ...], Field(min_length=1), BeforeValidator(_listed)]
Count = Annotated[int, Field(ge=1, strict=True)]
MAX_REPEATS = 10_000


class PathGroup(Params):
    """Paths: all seeds in all scenes, or recorded sequences; and what they are counted under, None: each scene's name,
    or the folder that a sequence is in.
    """

    kind: ClassVar[str] = "key of a group of paths"

    scene: Texts = ()
    seeds: Seeds = ()
    sequence: Texts = ()
    dataset: str | None = Field(None, min_length=1)


class StudySpec(Params):
    """A study: names of `fixed` and `factors` are those of `slamgym.study.names`, options of scenes and SLAMs dotted.

    paths: every level of every factor runs on each of them. factors: entries are crossed; what is inside of one goes
    together. repeats: runs of each SLAM over each drive. max_workers: most runs at a time, None: as many as there are
    workers.
    """

    kind: ClassVar[str] = "key of a study"

    name: str
    description: str = ""
    paths: tuple[PathGroup, ...] = ()
    fixed: dict[str, Any] = Field(default_factory=dict)
    factors: tuple[dict[str, tuple[Any, ...]], ...] = ()
    repeats: Annotated[Count, Field(le=MAX_REPEATS)] = 1
    max_workers: Count | None = None

    _file: YamlFile | None = PrivateAttr(None)

    @field_validator("name")
    @classmethod
    def _fit_for_folders(cls, name: str) -> str:
        if not _NAME.fullmatch(name):
            raise ConfigError(f"name: expected at most 64 letters, digits, '.', '_' and '-', got {name!r}")
        return name

    @field_validator("paths", "factors", mode="before")
    @classmethod
    def _is_list(cls, entries: Any, info: ValidationInfo) -> Any:
        if not isinstance(entries, list | tuple):
            raise ConfigError(f"{info.field_name}: expected a list, each entry after a dash, got {entries!r}")
        return entries

    @field_validator("fixed", mode="before")
    @classmethod
    def _dotted(cls, fixed: Any) -> Any:
        return flat(fixed) if isinstance(fixed, Mapping) else fixed

    @model_validator(mode="after")
    def _without_problems(self) -> Self:
        problems = chain(
            path_problems(self.paths),
            fixed_problems(self.fixed, self.paths),
            factor_problems(self.factors, self.fixed, self.paths),
        )
        for message, place in problems:
            raise PydanticCustomError(_PROBLEM, "{message}", {"message": message, "place": place})
        return self

    @classmethod
    def _explain(cls, details: ErrorDetails) -> str:
        if details["type"] == _PROBLEM:
            return details["msg"]
        if details["type"] == "tuple_type" and details["loc"][0] == "factors":
            return f"{details['loc'][-1]}: expected a list of levels, got {details['input']!r}"
        if details["loc"][:1] == ("paths",) and len(details["loc"]) > 2:
            return PathGroup._explain({**details, "loc": details["loc"][2:]})
        return super()._explain(details)

    @classmethod
    def of_file(cls, file: YamlFile, values: Mapping[str, Any]) -> Self:
        """The study of the keys `values`, whose lines are those of the file; raises ConfigError with the line."""
        try:
            spec = cls.model_validate(dict(values))
        except ValidationError as error:
            details = error.errors()[0]
            raise file.error(cls._explain(details), *_place(details)) from None
        spec._file = file
        return spec

    def error(self, message: str, *place: str | int) -> ConfigError:
        """An error about what stands at a place of the study, with its file and line where it has one."""
        return ConfigError(message) if self._file is None else self._file.error(message, *place)

    def place_of(self, name: str) -> Place:
        """Where a parameter is varied, or fixed."""
        varied = (("factors", k, name) for k, entry in enumerate(self.factors) if name in entry)
        return next(varied, ("fixed", name))


def read_study(path_or_name: Path | str, size: str | None = None, sequences: Iterable[Path | str] = ()) -> StudySpec:
    """The study of a file, or of a shipped one's name, with all paths of files absolute.

    size: one of the file's `sizes`, None for the first. sequences: folders of recorded sequences, added to its paths,
    relative to where the program runs. All sizes are checked. Raises ConfigError, as FILE:LINE: what is wrong, in one
    line.
    """
    file = read_yaml(find_study(path_or_name))
    specs = {name: _resolved(_with(sequences, one)) for name, one in _sizes(file).items()}
    if size is not None and size not in specs:
        if "sizes" not in file.data:
            raise file.error(f"expected a study with sizes to choose {size!r} of, got one without; leave it out")
        raise file.error(unknown_word("size", size, specs), "sizes")
    return specs[size] if size is not None else next(iter(specs.values()))


def write_study(spec: StudySpec, path: Path) -> Path:
    """Write the study so that `read_study` reads it back, from anywhere; raises OutputError."""
    return write_atomically(path, dump_yaml(spec.model_dump(mode="json", exclude_defaults=True)))


def factor_names(spec: StudySpec) -> tuple[str, ...]:
    """What is varied, in the file's order."""
    return tuple(name for entry in spec.factors for name in entry)


def _place(details: ErrorDetails) -> Place:
    return details["ctx"]["place"] if details["type"] == _PROBLEM else details["loc"]


def _sizes(file: YamlFile) -> dict[str, YamlFile]:
    """The study in each of its sizes, the first one first; without sizes itself."""
    if "sizes" not in file.data:
        return {"": file}
    sizes = file.data["sizes"]
    if not isinstance(sizes, dict) or not sizes:
        raise file.error(f"sizes: expected names, each with the keys that it replaces, got {sizes!r}", "sizes")
    return {name: _sized(file, name) for name in sizes}


def _sized(file: YamlFile, name: str) -> YamlFile:
    keys = file.data["sizes"][name]
    if not isinstance(keys, dict):
        raise file.error(f"size {name!r}: expected the keys that it replaces, got {keys!r}", "sizes", name)
    for key in keys:
        if key not in (valid := StudySpec.model_fields.keys() - {"name"}):
            raise file.error(unknown_word("key of a size", key, valid), "sizes", name, key)
    return file.overlaid("sizes", name)


def _with(sequences: Iterable[Path | str], file: YamlFile) -> YamlFile:
    """The file with a group of paths more, where there are sequences, relative to the current folder."""
    folders = [located_file(str(sequence), Path()) for sequence in sequences]
    paths = file.data.get("paths", [])
    return file.changed(paths=[*paths, {"sequence": folders}]) if folders and isinstance(paths, list) else file


def _resolved(file: YamlFile) -> StudySpec:
    """The study with absolute paths."""
    file = _with_dotted_lines(file)
    as_written = StudySpec.of_file(file, {key: value for key, value in file.data.items() if key != "sizes"})
    # Once more: two names may turn out to be of one scene.
    return StudySpec.of_file(file, {**as_written.model_dump(), **_located(as_written, file.path.parent)})


def _with_dotted_lines(file: YamlFile) -> YamlFile:
    """The file with lines for the dotted names of what it fixes by mappings of options."""
    fixed = file.data.get("fixed")
    names = fixed.keys() if isinstance(fixed, dict) else set[str]()
    for name in names:
        if name.partition(".")[0] in names - {name}:
            raise file.error(f"expected every name once, got {name!r} twice in fixed", "fixed", name)
    dotted: dict[Place, int] = {
        ("fixed", ".".join(map(str, place[1:]))): line for place, line in file.lines.items() if place[0] == "fixed"
    }
    return YamlFile(file.path, file.data, {**dotted, **file.lines})


def _located(spec: StudySpec, base: Path) -> dict[str, Any]:
    """The keys of a study that name files, with absolute paths."""
    slams = [level for entry in spec.factors for level in entry.get("slam", ())]
    backends = [str(slam) for slam in slams or [spec.fixed.get("slam", SlamParams().slam)]]

    def located(name: str, value: Any) -> Any:
        return located_file(value, base) if isinstance(value, str) and takes_file(name, backends) else value

    return {
        "paths": [_located_group(group, base) for group in spec.paths],
        "fixed": {name: located(name, value) for name, value in spec.fixed.items()},
        "factors": [
            {name: [located(name, level) for level in levels] for name, levels in entry.items()}
            for entry in spec.factors
        ],
    }


def _located_group(group: PathGroup, base: Path) -> dict[str, Any]:
    scenes = [located_scene(scene, base) for scene in group.scene]
    sequences = [located_file(sequence, base) for sequence in group.sequence]
    named = {key: names for key, names in {"scene": scenes, "sequence": sequences}.items() if names}
    return {**group.model_dump(exclude_defaults=True), **named}
