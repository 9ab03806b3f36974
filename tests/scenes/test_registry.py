import warnings

import numpy as np
import pytest

from slamgym.errors import ConfigError, SceneError, SceneWarning
from slamgym.scenes.house import House, Material, Part
from slamgym.scenes.loader import SceneOptions
from slamgym.scenes.registry import SCENES, find_scene, load_scene

STL = """solid floor
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 6 0 0
vertex 0 4 0
endloop
endfacet
endsolid floor
"""


class Worn:
    """A house with as many defects as its seed."""

    Options = SceneOptions
    suffixes = ()

    @staticmethod
    def load(source, options):
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
        floor = Part("floor", Material("wood"), corners, np.array([[0, 1, 2]], np.int32))
        return House("worn", (floor,), defects=tuple(f"defect {number}" for number in range(source)))


class Sloppy(Worn):
    suffixes = ".usd"  # type: ignore[assignment]


def test_a_broken_loader_hides_no_other_and_is_told_where_none_reads_a_file(monkeypatch):
    monkeypatch.setitem(SCENES, "broken", "no_such_module:Loader")
    with pytest.raises(SceneError, match="did you mean 'procedural'"):
        find_scene("procedurl")
    with pytest.raises(SceneError, match=r"expected a file ending in .*no_such_module"):
        find_scene("flat.usd")


def test_a_seed_is_zero_unless_given():
    assert find_scene("procedural").source == 0
    assert find_scene("procedural:12").source == 12


def test_a_file_is_found_by_its_ending_or_by_the_loaders_name(tmp_path):
    file = tmp_path / "Flat.STL"
    file.write_text(STL)
    found, named = find_scene(str(file)), find_scene(f"mesh:{file}")
    assert found.source == named.source == file
    assert found.loader is named.loader
    assert found.loader.__name__ == "Mesh"
    house = tmp_path / "house" / "1" / "house.json"
    house.parent.mkdir(parents=True)
    house.write_text("{}")
    assert find_scene(str(house)).loader.__name__ == "Suncg"


@pytest.mark.parametrize(
    "spec",
    ["procedural:", "procedural:abc", "procedural:-1", "procedural:1.5", "procedural:²", "procedural:" + "9" * 5000],
)
def test_malformed_seed(spec):
    with pytest.raises(SceneError, match=r"expected a seed of 0 or more, got .*; write for example procedural:7"):
        load_scene(spec)


def test_unknown_name_names_the_closest():
    with pytest.raises(SceneError, match="unknown scene 'proceedural'; did you mean 'procedural'"):
        load_scene("proceedural:3")


@pytest.mark.parametrize(
    ("spec", "told"),
    [
        ("nowhere/flat.glb", "expected a file, got '.*', which is not there"),
        ("~nobody-here/flat.glb", "expected a file, got '.*', which is not there"),
        ("mesh:flat.glb", "expected a file, got 'flat.glb', which is not there"),
        ("mesh", "write for example mesh:FILE"),
        ("mesh:", "write for example mesh:FILE"),
        ("a" * 300 + ".glb", "got a name that cannot be one"),
        ("mesh:.", "expected a file, got '.', a folder"),
        ("mesh:/dev/null", "which is no plain file"),
        (".", "expected a file ending in"),
    ],
)
def test_missing_file(spec, told):
    with pytest.raises(SceneError, match=told):
        find_scene(spec)


def test_a_file_that_nothing_reads_names_the_endings(tmp_path):
    (tmp_path / "flat.fbx").write_text("")
    with pytest.raises(SceneError, match=r"expected a file ending in one of .*\.glb.*house\.json"):
        find_scene(str(tmp_path / "flat.fbx"))


def test_options_are_those_of_the_loader(tmp_path):
    assert find_scene("procedural", {"size": "large"}).options.model_dump()["size"] == "large"
    with pytest.raises(ConfigError, match="unknown scene option 'siz'; did you mean 'size'"):
        find_scene("procedural", {"siz": "large"})


def test_defects_are_warned_of_and_the_sixth_is_only_counted(monkeypatch):
    monkeypatch.setitem(SCENES, "worn", f"{__name__}:Worn")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        load_scene("worn:5")
        assert [str(w.message) for w in caught] == [f"defect {number}" for number in range(5)]
        caught.clear()
        load_scene("worn:7")
    assert {w.category for w in caught} == {SceneWarning}
    assert {w.filename for w in caught} == {__file__}
    assert str(caught[-1].message).startswith("scene 'worn:7': 2 more defects")


def test_loader_of_an_installed_package_is_found(tmp_path, monkeypatch):
    """As pip leaves it: a module, and its entry points in a folder beside it."""
    (tmp_path / "my_scene.py").write_text("from slamgym.scenes.procedural import Procedural as MyScene\n")
    info = tmp_path / "my_scene-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: my-scene\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[slamgym.scenes]\nmine = my_scene:MyScene\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert find_scene("mine:4").source == 4
    with pytest.raises(SceneError, match="did you mean 'mine'"):
        find_scene("mien")


@pytest.mark.parametrize(
    ("target", "message"),
    [
        (f"{__name__}:Sloppy", "expected suffixes as a tuple of texts, got '.usd'"),
        ("no_such_module:Loader", "importable 'module:class', got ModuleNotFoundError"),
        ("slamgym.scenes.house:House", r"without \['Options', 'suffixes', 'load'\]"),
    ],
)
def test_what_is_no_loader_is_told(target, message, monkeypatch):
    monkeypatch.setitem(SCENES, "broken", target)
    with pytest.raises(ConfigError, match=message):
        find_scene("broken")
