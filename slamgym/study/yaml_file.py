"""YAML files that people write: plain values, each with the line where it stands, so that an error can name it."""

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from slamgym.errors import ConfigError

Place = tuple[str | int, ...]
"""Keys and list indices that lead to a value."""

MAX_BYTES = 10_000_000

_SCALARS: dict[str, tuple[re.Pattern[str], Callable[[str], Any]]] = {
    "null": (re.compile(r"(?:~|null|Null|NULL|)"), lambda _: None),
    "bool": (
        re.compile(r"(?:yes|no|on|off|true|false)", re.IGNORECASE),
        lambda text: text.lower() in ("yes", "on", "true"),
    ),
    "int": (re.compile(r"[-+]?[0-9]+"), int),
    "float": (re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"), float),
    "str": (re.compile(r".*", re.DOTALL), str),
}
"""What a word without quotes means, the first that fits: YAML 1.2's numbers (1e3 is one, 010 is ten, 1:30 and
2024-01-01 are texts), and YAML 1.1's yes, no, on and off."""

_TAG = "tag:yaml.org,2002:"


class _Loader(yaml.SafeLoader):
    yaml_implicit_resolvers: dict[Any, Any] = {}  # noqa: RUF012  the base's form

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        # A few of them that hold each other would stand for more than fits into memory.
        if self.check_event(yaml.AliasEvent):
            mark: Any = self.get_event().start_mark  # type: ignore[no-untyped-call]
            problem = "found an alias, which is not taken"
            raise yaml.composer.ComposerError(problem=problem, problem_mark=mark)
        return super().compose_node(parent, index)


class _Dumper(yaml.SafeDumper):
    """Puts a text into quotes where `_Loader` would take it for something else."""

    yaml_implicit_resolvers: dict[Any, Any] = {}  # noqa: RUF012  the base's form

    def ignore_aliases(self, data: Any) -> bool:  # noqa: ARG002
        return True


for _class in (_Loader, _Dumper):
    for _name, (_pattern, _) in _SCALARS.items():
        _class.add_implicit_resolver(_TAG + _name, re.compile(rf"(?:{_pattern.pattern})\Z", _pattern.flags), None)


@dataclass(frozen=True, slots=True, eq=False)
class YamlFile:
    """data: a mapping of plain values. lines: of keys and of items of lists, from 1, by their places."""

    path: Path
    data: dict[str, Any]
    lines: Mapping[Place, int]

    def error(self, message: str, *place: str | int) -> ConfigError:
        """The error `FILE:LINE: message`, with the line of the place, or of what is there of it."""
        known = (place[:length] for length in range(len(place), 0, -1))
        line = next((self.lines[part] for part in known if part in self.lines), 1)
        return ConfigError(f"{self.path}:{line}: {message}")

    def changed(self, **values: Any) -> "YamlFile":
        """The file with other values at the top."""
        return YamlFile(self.path, {**self.data, **values}, self.lines)

    def overlaid(self, *place: str) -> "YamlFile":
        """The file with the keys of the mapping at `place` in the place of those of the same names at the top."""
        over = self.data
        for key in place:
            over = over[key]
        moved = {at[len(place) :]: line for at, line in self.lines.items() if at[: len(place)] == place != at}
        kept = {at: line for at, line in self.lines.items() if at[0] not in over}
        return YamlFile(self.path, {**self.data, **over}, {**kept, **moved})


def read_yaml(path: Path) -> YamlFile:
    """The file, a mapping at its top.

    Raises ConfigError with the line for bad syntax, a key that comes twice or is no text, an alias or a tag.
    """
    text = _read(path)
    lines: dict[Place, int] = {}
    try:
        node = yaml.compose(text, _Loader)
        data = None if node is None else _plain(path, node, (), lines)
    except yaml.reader.ReaderError as error:
        line = text.count("\n", 0, error.position) + 1
        raise ConfigError(f"{path}:{line}: expected text, got an unprintable character") from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        raise ConfigError(f"{path}:{mark.line + 1 if mark else 1}: {_problem(error)}") from None
    except RecursionError:
        raise ConfigError(f"{path}:1: expected a study, got lists in lists too deep to be one") from None
    if not isinstance(data, dict):
        got = "an empty file" if data is None else f"{str(data)[:40]!r}"
        raise ConfigError(f"{path}:1: expected keys with values, as 'name: my_study', got {got}")
    return YamlFile(path, data, lines)


def dump_yaml(data: Mapping[str, Any]) -> str:
    """Text that `read_yaml` reads back to the same data, keys in their order."""
    return yaml.dump(
        dict(data), Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=110, default_flow_style=None
    )


def _read(path: Path) -> str:
    try:
        if path.stat().st_size > MAX_BYTES:
            raise ConfigError(f"{path}:1: expected a YAML file of at most {MAX_BYTES // 10**6} MB, got a larger one")
        content = path.read_bytes()
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read: {error.strerror}; check the path") from None
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise ConfigError(f"{path}:{line}: expected text in UTF-8, got other bytes; save it as UTF-8") from None


def _problem(error: yaml.MarkedYAMLError) -> str:
    """PyYAML's words, in one line."""
    if error.problem and "'\\t'" in error.problem:
        return "expected spaces, got a tab; indent with spaces"
    if "single document" in str(error.context):
        return "expected one document, got a second one; leave out the line ---"
    return " ".join(f"expected YAML, but {error.problem}; check quotes, brackets and indents".split())


def _plain(path: Path, node: yaml.Node, place: Place, lines: dict[Place, int]) -> Any:
    """Plain values of a node; the lines of all that is in it are written into `lines`."""
    if node.tag == _TAG + "map" and isinstance(node, yaml.MappingNode):
        return dict(_entries(path, node, place, lines))
    if node.tag == _TAG + "seq" and isinstance(node, yaml.SequenceNode):
        return [_at(path, item, (*place, k), lines, item) for k, item in enumerate(node.value)]
    return _scalar(path, node)


def _entries(path: Path, node: yaml.MappingNode, place: Place, lines: dict[Place, int]) -> Iterator[tuple[str, Any]]:
    seen = set()
    for key_node, value in node.value:
        key = _scalar(path, key_node) if isinstance(key_node, yaml.ScalarNode) else None
        if not isinstance(key, str):
            raise _error(path, key_node, f"expected a name before the colon, got {key!r}; put it into quotes")
        if key in seen:
            raise _error(path, key_node, f"expected every key once, got {key!r} again; join the two")
        seen.add(key)
        yield key, _at(path, value, (*place, key), lines, key_node)


def _at(path: Path, node: yaml.Node, place: Place, lines: dict[Place, int], marked: yaml.Node) -> Any:
    lines[place] = marked.start_mark.line + 1
    return _plain(path, node, place, lines)


def _scalar(path: Path, node: yaml.Node) -> Any:
    kind = node.tag.removeprefix(_TAG)
    if kind not in _SCALARS or not isinstance(node, yaml.ScalarNode):
        raise _error(path, node, f"expected texts, numbers, lists and mappings, got the tag {node.tag!r}")
    try:
        return _SCALARS[kind][1](node.value)
    except ValueError:
        raise _error(path, node, f"expected {kind}, got {node.value[:40]!r}") from None


def _error(path: Path, node: yaml.Node, message: str) -> ConfigError:
    return ConfigError(f"{path}:{node.start_mark.line + 1}: {message}")
