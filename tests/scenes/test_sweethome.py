"""Homes with furniture of a catalogue: with a small one written here, and with Debian's where it is installed."""

import hashlib
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from slamgym.agents.planner import plan_path
from slamgym.errors import ConfigError, SceneError
from slamgym.scenes.furniture_catalogue.catalogue import read_catalogue
from slamgym.scenes.furniture_catalogue.meshes import shape_of
from slamgym.scenes.furniture_catalogue.wanted import LEFT_OUT, WANTED
from slamgym.scenes.occupancy import free_space, occupancy_grid
from slamgym.scenes.registry import find_scene, load_scene
from slamgym.scenes.sweethome import SweetHome

INSTALLED = Path("/usr/share/sweethome3d/furniture")
OBJ = """mtllib thing.mtl
v 0 0 0
v 2 0 0
v 2 5 0
v 0 5 0
v 0 0 4
v 2 0 4
v 2 5 4
v 0 5 4
usemtl cloth
f 2 1 4 3
f 1 5 8 4
f 6 2 3 7
f 4 8 7 3
f 5 1 2 6
f 5 6 7 8
"""


def entry(number, name, width, depth, height):
    return "".join(
        f"{key}#{number}={value}\n"
        for key, value in {
            "id": f"Test#{name}",
            "name": name,
            "category": "Living room",
            "model": "/thing/thing.obj",
            "width": width,
            "depth": depth,
            "height": height,
            "creator": "Ada",
        }.items()
    )


@pytest.fixture
def catalogue(tmp_path):
    """A folder with a kitchen cupboard in CC0, and a sink by attribution; one entry is broken."""
    lists = {
        "free.sh3f": "license=Public domain\n" + entry(1, "Lower cabinet", 60, 61, 88),
        "by.sh3f": "license=Creative Commons Attribution 3.0\n"
        + entry(1, "Sink cabinet", 60, 61, 121)
        + entry(2, "Sofa", "wide", 90, 80),
    }
    for name, text in lists.items():
        with zipfile.ZipFile(tmp_path / name, "w") as archive:
            archive.writestr("PluginFurnitureCatalog.properties", text)
            archive.writestr("thing/thing.obj", OBJ)
            archive.writestr("thing/thing.mtl", "newmtl cloth\nKd 0.5 0.25 0.2\n")
    return tmp_path


def load(seed, **options):
    return SweetHome.load(seed, SweetHome.Options.checked(options))


def models(house):
    return {line for line in house.assumptions if line.startswith("model: ")}


def digest(house):
    told = hashlib.sha256()
    for part in house.parts:
        told.update(part.name.encode() + part.vertices.tobytes() + part.faces.tobytes())
    return told.hexdigest()


def drive(house):
    """A path of 10 m through the house, as the environment plans it."""
    grid = occupancy_grid(house, 0.9)
    return plan_path(grid, free_space(grid, 0.25), 10.0, np.random.default_rng(0))


def test_models_of_a_catalogue_stand_in_the_home_and_are_credited(catalogue):
    house = load(0, catalogue=str(catalogue))
    assert house.name == "sweethome:0"
    assert models(house) == {
        "model: 'Lower cabinet' by Ada, CC0 (free.sh3f)",
        "model: 'Sink cabinet' by Ada, CC-BY 3.0 (by.sh3f)",
    }
    (defect,) = house.defects
    assert defect.startswith("by.sh3f: model '2' left out: ")
    cupboards = [part for part in house.parts if part.name.startswith("cupboard_")]
    assert cupboards
    assert {part.material.name for part in cupboards} == {"cloth"}


def test_a_licence_that_is_not_allowed_is_not_used(catalogue):
    house = load(0, catalogue=str(catalogue), licences="CC0, other")
    assert models(house) == {"model: 'Lower cabinet' by Ada, CC0 (free.sh3f)"}


def test_the_same_seed_gives_the_same_home(catalogue):
    first, second = (load(4, catalogue=str(catalogue), size="small") for _ in range(2))
    assert digest(first) == digest(second)


def test_its_options_are_known_before_a_catalogue_can_be_read():
    """Whoever asks what scenes there are does not wait for the readers of meshes."""
    code = "import sys, slamgym.scenes.sweethome; print({'trimesh', 'javaproperties'} & {*sys.modules})"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert told.stdout.strip() == "set()"


def test_options_are_those_of_procedural_homes_and_two_more():
    assert {"size", "clutter", "texture", "catalogue", "licences"} == set(SweetHome.Options.model_fields)
    with pytest.raises(ConfigError, match=r"unknown licence 'CC-BB'\. Valid: CC-BY, CC0, other"):
        find_scene("sweethome:1", {"licences": "CC0,CC-BB"})
    with pytest.raises(ConfigError, match="licences: expected one or more of CC0, CC-BY, other, got ''"):
        find_scene("sweethome:1", {"licences": ""})
    with pytest.raises(ConfigError, match="unknown scene option 'licenses'; did you mean 'licences'"):
        find_scene("sweethome:1", {"licenses": "CC0"})


def test_without_a_catalogue_the_message_says_what_to_install(tmp_path):
    with pytest.raises(SceneError, match="`apt install sweethome3d-furniture`"):
        load_scene("sweethome:1", {"catalogue": str(tmp_path)})


@pytest.fixture
def installed():
    if not INSTALLED.is_dir():
        pytest.skip("expected Debian's sweethome3d-furniture; install it with apt")


@pytest.mark.usefixtures("installed")
@pytest.mark.parametrize("seed", range(2))
def test_homes_with_real_furniture_are_drivable(seed):
    house = load(seed)
    assert house.defects == ()
    assert len(models(house)) >= 15
    assert drive(house).length_m == pytest.approx(10.0, abs=0.3)


@pytest.mark.usefixtures("installed")
def test_every_model_that_is_wanted_can_be_shown():
    found = read_catalogue(INSTALLED).models
    for name, wanted in WANTED.items():
        suiting = [model for model in found if wanted.suits(model)]
        assert suiting, name
        assert all(shape_of(model).components for model in suiting)
    assert {model.id for model in found} >= LEFT_OUT


@pytest.mark.slow
@pytest.mark.usefixtures("installed")
@pytest.mark.parametrize("seed", range(2, 102))
def test_a_hundred_homes_are_drivable(seed):
    assert drive(load(seed)).length_m == pytest.approx(10.0, abs=0.3)
