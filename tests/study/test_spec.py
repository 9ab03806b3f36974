from pathlib import Path

import pytest

from slamgym.errors import ConfigError
from slamgym.study.spec import StudySpec, factor_names, read_study, write_study

PATHS = "name: s\npaths:\n- {scene: procedural:1, seeds: 1}\n"


@pytest.fixture
def written(tmp_path):
    def write(text, name="study.yaml"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def test_a_study_is_what_its_file_says(written):
    spec = read_study(
        written(
            """
name: speed
description: How fast?
paths:
  - scene: [procedural, "procedural:07"]
    seeds: [1, 2]
    dataset: homes
  - scene: sweethome:3
    seeds: 5
fixed: {agent: patrol, scene_options: {texture: 2}, slam_options.features: 1e3}
factors:
  - speed: [0.1, 0.4]
  - stride: [0, 1]
    loop_closure: [on, off]
repeats: 3
max_workers: 1
"""
        )
    )
    assert (spec.name, spec.description, spec.repeats, spec.max_workers) == ("speed", "How fast?", 3, 1)
    assert [(group.scene, group.seeds, group.dataset) for group in spec.paths] == [
        (("procedural:0", "procedural:7"), (1, 2), "homes"),
        (("sweethome:3",), (5,), None),
    ]
    assert spec.fixed == {"agent": "patrol", "scene_options.texture": 2, "slam_options.features": 1000.0}
    assert spec.factors == ({"speed": (0.1, 0.4)}, {"stride": (0, 1), "loop_closure": (True, False)})
    assert factor_names(spec) == ("speed", "stride", "loop_closure")


def test_without_factors_it_is_one_run_a_path(written):
    spec = read_study(written(PATHS))
    assert (spec.factors, spec.fixed, spec.repeats, spec.max_workers) == ((), {}, 1, None)


@pytest.mark.parametrize(
    ("more", "line", "told"),
    [
        ("repeat: 3", 4, "unknown key of a study 'repeat'; did you mean 'repeats'?"),
        ("repeats: 0", 4, "greater than or equal to 1, got 0"),
        ("repeats: 1.5", 4, "valid integer, got 1.5"),
        ("max_workers: 0", 4, "max_workers"),
        ("description: [a]", 4, "description"),
        ("fixed: {sped: 1}", 4, "unknown parameter 'sped'; did you mean 'speed'?"),
        ("fixed: 3", 4, "fixed"),
        ("fixed:\n  scene_options: 3", 5, "expected the name scene_options.NAME"),
        ("fixed:\n  scene_options:\n    size: small\n  scene_options.size: large", 7, "twice in fixed"),
        ("fixed: {scene: procedural}", 4, "expected scenes in paths"),
        ("factors:\n- stride: [1]\n- sped: [1]", 6, "did you mean 'speed'?"),
        ("factors: {speed: [1]}", 4, "expected a list, each entry after a dash"),
        ("factors:\n- {}", 5, "expected a factor with its levels"),
        ("factors:\n- speed: []", 5, "speed: expected one level or more, got none"),
        ("factors:\n- speed: 1", 5, "speed: expected a list of levels, got 1"),
        ("factors:\n- speed:\n  - 1\n  - 0.5\n  - 1.0", 8, "expected every level once, got speed 1.0 again"),
        ("factors:\n- camera: [small, {width: 3}]", 5, "camera: expected a number, a text, on, off or null as level"),
        ("factors:\n- speed: [1, 2]\n  stride: [0]", 6, "got 2 of speed, 1 of stride"),
        ("factors:\n- speed: [1, 2, 1]\n  stride: [0, 0, 0]", 5, "got speed 1, stride 0 again"),
        ("factors:\n- speed: [1]\n- speed: [2]", 6, "'speed' twice in factors"),
        ("fixed: {speed: 1}\nfactors:\n- speed: [2]", 6, "'speed' twice in fixed and factors"),
        ("factors:\n- scene: [procedural:1]", 5, "expected scenes in paths"),
        ("factors:\n- speed.x: [1]", 5, "expected the name speed, got 'speed.x'"),
        ("factors:\n- slam_options: [1]", 5, "expected the name slam_options.NAME"),
        ("factors:\n- slam_options.: [1]", 5, "expected the name slam_options.NAME"),
        ("sizes: 3", 4, "sizes: expected names"),
        ("sizes:\n  small: 3", 5, "size 'small': expected the keys"),
        ("sizes:\n  small:\n    name: x", 6, "unknown key of a size 'name'"),
        ("sizes:\n  small:\n    sizes: {}", 6, "unknown key of a size 'sizes'"),
        ("sizes:\n  small: {}\n  large:\n    factors:\n    - sped: [1]", 8, "did you mean 'speed'?"),
        ("sizes:\n  small:\n    paths:\n    - scene: a\n      seed: 1", 8, "unknown key of a group of paths 'seed'"),
    ],
)
def test_a_mistake_is_told_with_its_line(written, more, line, told):
    path = written(PATHS + more + "\n")
    with pytest.raises(ConfigError) as error:
        read_study(path)
    message = str(error.value)
    assert message.startswith(f"{path}:{line}: ")
    assert told in message
    assert "\n" not in message


@pytest.mark.parametrize(
    ("paths", "line", "told"),
    [
        ("", 1, "expected paths to run on, got none"),
        ("paths: []", 2, "expected paths to run on, got none"),
        ("paths: {scene: procedural, seeds: 1}", 2, "expected a list, each entry after a dash"),
        ("paths:\n- seeds: 1", 3, "expected either scene or sequence in a group of paths, got neither"),
        ("paths:\n- scene: a\n  seeds: 1\n  sequence: b", 3, "got both"),
        ("paths:\n- scene: a", 3, "expected seeds beside scene"),
        ("paths:\n- sequence: a\n  seeds: 1", 3, "expected no seeds beside sequence"),
        ("paths:\n- scene: []\n  seeds: 1", 3, "scene"),
        ("paths:\n- scene: a\n  seeds:\n  - 1\n  - -1", 6, "got -1"),
        ("paths:\n- scene: a\n  seeds: yes", 4, "got True"),
        (
            "paths:\n- scene: procedural\n  seeds: 1\n- scene: procedural:0\n  seeds: [2, 1]",
            5,
            "procedural:0 with seed 1",
        ),
        ("paths:\n- sequence: x/../a\n- sequence: a", 4, "expected every path once"),
        ("paths:\n- sequence: a\nfactors:\n- stride: [0]\n- speed: [1]", 6, "recorded sequences are as they are"),
        ("paths:\n- sequence: a\nfixed:\n  fps: 10", 5, "all paths are recorded"),
    ],
)
def test_paths_that_are_none_are_told_with_their_line(written, paths, line, told):
    path = written(f"name: s\n{paths}\n")
    with pytest.raises(ConfigError) as error:
        read_study(path)
    assert str(error.value).startswith(f"{path}:{line}: ")
    assert told in str(error.value)


def test_names_that_go_together_may_share_a_level(written):
    together = "factors:\n- slam_sync: [lockstep, realtime, realtime]\n  busy_processes: [0, 0, 2]\n"
    assert len(read_study(written(PATHS + together)).factors[0]["busy_processes"]) == 3


@pytest.mark.parametrize("name", ["a b", "../up", ".hidden", "a/b", "x" * 65, "<script>", "on"])
def test_a_name_has_to_be_fit_for_a_folder(written, name):
    with pytest.raises(ConfigError, match=r"study\.yaml:1: name: "):
        read_study(written(PATHS.replace("name: s", f"name: {name}")))


def test_the_first_size_is_taken_without_a_choice(written):
    path = written(PATHS + "repeats: 7\nsizes:\n  small: {repeats: 1, description: quick}\n  full: {}\n")
    assert [read_study(path, size).repeats for size in (None, "small", "full")] == [1, 1, 7]
    assert read_study(path).description == "quick"
    with pytest.raises(ConfigError, match=r"study\.yaml:5: unknown size 'ful'; did you mean 'full'\?"):
        read_study(path, "ful")
    with pytest.raises(ConfigError, match="without; leave it out"):
        read_study(written(PATHS, "plain.yaml"), "small")


def test_files_are_relative_to_the_study(written, tmp_path, monkeypatch):
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    monkeypatch.setenv("HOME", "/home/me")
    written("", "a.txt")
    path = written(
        """
name: files
paths:
- {scene: [flat.glb, ~/house.obj, "mesh:sub/x.ply", ../up.glb, procedural:3], seeds: 1}
- {sequence: [fr1, /data/fr2]}
fixed: {occupancy_map: maps/m.yaml, slam_options: {vocabulary: v.txt, command: rgbd_tum x}}
factors:
- slam: [command]
"""
    )
    spec = read_study(path, sequences=["here", "/data/fr3"])
    assert spec.paths[0].scene == (
        f"{tmp_path}/flat.glb",
        "/home/me/house.obj",
        f"mesh:{tmp_path}/sub/x.ply",
        f"{tmp_path.parent}/up.glb",
        "procedural:3",
    )
    assert spec.paths[1].sequence == (f"{tmp_path}/fr1", "/data/fr2")
    assert spec.paths[2].sequence == (f"{tmp_path}/elsewhere/here", "/data/fr3")
    assert spec.fixed == {
        "occupancy_map": f"{tmp_path}/maps/m.yaml",
        "slam_options.vocabulary": f"{tmp_path}/v.txt",
        "slam_options.command": "rgbd_tum x",
    }


def test_levels_that_are_files_are_relative_too(written, tmp_path):
    spec = read_study(written(PATHS + "factors:\n- slam_options.vocabulary: [null, mine.txt]\n"))
    assert spec.factors == ({"slam_options.vocabulary": (None, f"{tmp_path}/mine.txt")},)


def test_sequences_of_the_command_line_may_be_all_there_is(written):
    spec = read_study(written("name: s\nfactors:\n- stride: [0, 1]\n"), sequences=[Path("/data/tum/fr1")])
    assert [group.sequence for group in spec.paths] == [("/data/tum/fr1",)]


def test_sequences_do_not_go_with_factors_of_the_drive(written):
    with pytest.raises(ConfigError, match=r"study\.yaml:5: .*recorded sequences are as they are, got 'speed'"):
        read_study(written(PATHS + "factors:\n- speed: [0.1, 0.2]\n"), sequences=["/data/fr1"])


def test_a_written_study_is_read_back(written, tmp_path):
    spec = read_study(
        written(
            PATHS + "fixed: {agent: patrol, camera: small, scene_options.size: small}\nrepeats: 2\n"
            "factors:\n- brightness: [1e-1, 1]\n  slam_options.levels: [4, 8]\n- loop_closure: [on, null]\n"
            "sizes: {a: {description: 'on: 1e3 # \"x\"'}}\n"
        )
    )
    again = read_study(write_study(spec, tmp_path / "elsewhere" / "study.yaml"))
    assert again.model_dump() == spec.model_dump()
    assert again.description == 'on: 1e3 # "x"'


def test_a_study_made_in_python_is_checked_as_well():
    with pytest.raises(ConfigError, match="did you mean 'speed'"):
        StudySpec.checked({"name": "s", "paths": [{"scene": "procedural", "seeds": 1}], "factors": [{"sped": [1]}]})


def test_options_have_dotted_names_however_they_are_given():
    paths = [{"scene": "procedural:1", "seeds": 1}]
    spec = StudySpec.checked({"name": "s", "paths": paths, "fixed": {"scene_options": {"size": "small"}, "speed": 1}})
    assert spec.fixed == {"scene_options.size": "small", "speed": 1}
