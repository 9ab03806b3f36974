import pytest

from slamgym.errors import SceneError
from slamgym.scenes.procedural import procedural_house
from slamgym.scenes.registry import SCENES, load_scene


@pytest.mark.parametrize("name", SCENES)
def test_every_scene_loads(name):
    assert load_scene(f"{name}:12").name == f"{name}:12"


def test_seed_is_zero_unless_given():
    assert load_scene("procedural").rooms == procedural_house(0).rooms


@pytest.mark.parametrize("spec", ["procedural:", "procedural:abc", "procedural:-1", "procedural:1.5", "procedural:²"])
def test_malformed_seed(spec):
    with pytest.raises(SceneError, match=r"expected a seed of 0 or more, got .*; write for example procedural:7"):
        load_scene(spec)


def test_unknown_name_names_the_closest():
    with pytest.raises(SceneError, match="unknown scene 'proceedural'; did you mean 'procedural'"):
        load_scene("proceedural:3")
