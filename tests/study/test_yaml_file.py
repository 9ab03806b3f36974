import pytest
import yaml

from slamgym.errors import ConfigError
from slamgym.study.yaml_file import dump_yaml, read_yaml


@pytest.fixture
def written(tmp_path):
    def write(content):
        path = tmp_path / "study.yaml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


def test_values_are_what_people_mean(written):
    text = "a: [on, Off, yes, NO, true, null, ~, 1e3, -2.5e-1, .5, 010, '1', 1:30, 2024-01-01, none, é]\nb:\n"
    expected = [True, False, True, False, True, None, None, 1e3, -0.25, 0.5, 10, "1", "1:30", "2024-01-01", "none", "é"]
    data = read_yaml(written(text)).data
    assert data == {"a": expected, "b": None}
    assert list(map(type, data["a"])) == list(map(type, expected))


def test_words_that_would_read_as_something_else_are_quoted(written):
    data = {
        "text": ["1e3", "on", "null", "", "010", "a: b", "# no comment", "é", "'", "a\nb"],
        "number": [1e-7, 1e22, 0.1, 3],
    }
    assert read_yaml(written(dump_yaml(data))).data == data


def test_written_lists_are_short_and_without_aliases(written):
    levels = [0.1, 0.2]
    text = dump_yaml({"b": {"speed": levels}, "a": levels})
    assert text == "b:\n  speed: [0.1, 0.2]\na: [0.1, 0.2]\n"
    assert yaml.safe_load(text) == read_yaml(written(text)).data


def test_lines_are_those_of_keys_and_of_items(written):
    file = read_yaml(
        written("# a comment\nname: x\npaths:\n  - scene: a\n\n  - scene: b\n    seeds:\n    - 1\n    - 2\n")
    )
    assert [file.lines[place] for place in [("name",), ("paths",), ("paths", 1), ("paths", 1, "seeds", 1)]] == [
        2,
        3,
        6,
        9,
    ]
    assert str(file.error("what", "paths", 1, "seeds", 1)) == f"{file.path}:9: what"
    assert str(file.error("what", "paths", 1, "missing", 7)) == f"{file.path}:6: what"
    assert str(file.error("what")) == f"{file.path}:1: what"


def test_a_part_of_a_file_replaces_keys_with_its_lines(written):
    file = read_yaml(written("a: {x: 1}\nb: 2\nsizes:\n  small:\n    a:\n      y: 3\n"))
    small = file.overlaid("sizes", "small")
    assert (small.data["a"], small.data["b"]) == ({"y": 3}, 2)
    assert (small.lines[("a",)], small.lines[("a", "y")], small.lines[("b",)]) == (5, 6, 2)
    assert ("a", "x") not in small.lines


@pytest.mark.parametrize(
    ("content", "line", "told"),
    [
        ("", 1, "an empty file"),
        ("# nothing\n", 1, "an empty file"),
        ("- a\n", 1, "['a']"),
        ("study\n", 1, "'study'"),
        ("a: 1\nb:\n  c: 1\n  c: 2\n", 4, "'c' again"),
        ("a: 1\n\tb: 2\n", 2, "a tab"),
        ("a: [1\nb: 2\n", 2, "expected ',' or ']'"),
        ("a: b: c\n", 1, "mapping values are not allowed here"),
        ("a: 'x\n", 2, "end of stream"),
        ("a: 1\n---\nb: 1\n", 2, "leave out the line ---"),
        ("a: &x [1]\nb: *x\n", 2, "alias"),
        ("a: &x [*x]\n", 1, "alias"),
        ("a: !!python/object/apply:os.system [ls]\n", 1, "the tag"),
        ("a: 1\nb: !!python/name:os.system\n", 2, "the tag"),
        ("a: !!int x\n", 1, "expected int, got 'x'"),
        ("a: 1\n2: 3\n", 2, "expected a name before the colon, got 2"),
        ("on: 3\n", 1, "put it into quotes"),
        ("? [a]\n: 1\n", 1, "expected a name before the colon"),
        ("a: 1\nb: \x00\n", 2, "unprintable"),
        (b"a: 1\nb: \xff\n", 2, "UTF-8"),
        (b"\x89PNG\r\n\x1a\n" + bytes(range(256)), 1, "UTF-8"),
        ("[" * 20_000, 1, "too deep"),
        ("a: " + "9" * 5000, 1, "expected int"),
    ],
)
def test_what_is_no_such_file_is_told_in_one_line(written, content, line, told):
    path = written(content)
    with pytest.raises(ConfigError) as error:
        read_yaml(path)
    message = str(error.value)
    assert message.startswith(f"{path}:{line}: ")
    assert told in message
    assert "\n" not in message


def test_a_tag_runs_nothing(written, tmp_path):
    path = written(f"a: !!python/object/apply:os.mkdir ['{tmp_path}/made']\n")
    with pytest.raises(ConfigError):
        read_yaml(path)
    assert not (tmp_path / "made").exists()


def test_a_file_that_cannot_be_read(tmp_path):
    with pytest.raises(ConfigError, match=r"missing\.yaml: cannot be read: No such file"):
        read_yaml(tmp_path / "missing.yaml")
    large = tmp_path / "large.yaml"
    with large.open("wb") as file:
        file.truncate(11_000_000)
    with pytest.raises(ConfigError, match="at most 10 MB"):
        read_yaml(large)
