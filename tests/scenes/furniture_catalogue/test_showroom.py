"""Models that stand where pieces made by code would."""

import importlib
import inspect
import pkgutil
from dataclasses import replace

import numpy as np
import pytest

from slamgym.scenes.furniture_catalogue.catalogue import read_catalogue
from slamgym.scenes.furniture_catalogue.meshes import shape_of
from slamgym.scenes.furniture_catalogue.showroom import Showroom, stand_in
from slamgym.scenes.furniture_catalogue.wanted import WANTED, Wanted
from slamgym.scenes.home import furniture
from slamgym.scenes.home.furniture.piece import Component, Piece, Top
from slamgym.scenes.home.palette import Finish
from slamgym.scenes.home.solids import box
from slamgym.scenes.house import House, Material

MAKERS = {
    name
    for found in pkgutil.iter_modules(furniture.__path__, f"{furniture.__name__}.")
    for name, maker in vars(importlib.import_module(found.name)).items()
    if inspect.isfunction(maker)
}

ANY = Wanted(("sofa",), (0.0, 0.0, 0.0), (9.0, 9.0, 9.0))


def piece(low, high, tops=()):
    mesh = box(*zip(low, high, strict=True))
    return Piece("thing", (Component("all", Finish(Material("wood")), mesh),), tops, front=0.4)


@pytest.fixture
def model(tmp_path, write_catalogue, entry):
    """A function that gives a model of 2.0 x 0.9 x 0.8 m with these keys."""

    def of(**changed):
        write_catalogue("a.sh3f", entry(**changed))
        return read_catalogue(tmp_path).models[0]

    return of


def standing(own, model, wanted=ANY):
    return stand_in(own, model, shape_of(model).components, wanted)


@pytest.mark.parametrize("name", WANTED)
def test_what_models_can_replace_is_made_by_code(name):
    """A maker is known by its function's name."""
    assert name in MAKERS


def test_a_model_has_its_own_size_and_its_back_to_the_wall(model):
    found = standing(piece((-0.9, 0.0, 0.0), (0.9, 0.8, 0.7)), model())
    np.testing.assert_allclose(found.bounds, [[-1.0, 0.0, 0.0], [1.0, 0.9, 0.8]], atol=1e-9)
    assert (found.kind, found.front, found.tops) == ("thing", 0.4, ())


def test_a_model_is_centred_where_the_other_piece_is(model):
    found = standing(piece((-0.1, -0.1, 0.0), (0.1, 0.1, 0.3)), model())
    np.testing.assert_allclose(found.bounds, [[-1.0, -0.45, 0.0], [1.0, 0.45, 0.8]], atol=1e-9)


def test_a_model_takes_the_size_and_height_that_are_wanted(model):
    own, hung = piece((-0.2, 0.0, 0.0), (0.2, 0.4, 0.5)), model(elevation="60")
    same = standing(own, hung, replace(ANY, same_size=True))
    np.testing.assert_allclose(same.bounds, own.bounds, atol=1e-9)
    raised = standing(own, hung, replace(ANY, at_elevation=True))
    np.testing.assert_allclose(raised.bounds[:, 2], [0.6, 1.4], atol=1e-9)


def test_things_stand_on_a_level_top_inside_its_edges(model):
    own = piece((-0.5, 0.0, 0.0), (0.5, 0.5, 0.7), tops=(Top((-0.4, 0.4), (0.1, 0.4), 0.7),))
    (top,) = standing(own, model()).tops
    assert top.z == pytest.approx(0.8)
    assert top.x == pytest.approx((-0.7, 0.7))
    assert top.y == pytest.approx((0.135, 0.765))


@pytest.mark.parametrize("drop", ["-1", "40"])
def test_nothing_stands_where_the_catalogue_says_no(model, drop):
    own = piece((-0.5, 0.0, 0.0), (0.5, 0.5, 0.7), tops=(Top((-0.4, 0.4), (0.1, 0.4), 0.7),))
    assert standing(own, model(dropOnTopElevation=drop)).tops == ()


def test_nothing_stands_on_a_point(tmp_path, write_catalogue, files):
    obj = files()["sofa/thing.obj"].decode().replace("v 2 5 4", "v 2 9 4")
    write_catalogue("a.sh3f", content=files(obj=obj))
    own = piece((-0.5, 0.0, 0.0), (0.5, 0.5, 0.7), tops=(Top((-0.4, 0.4), (0.1, 0.4), 0.7),))
    assert standing(own, read_catalogue(tmp_path).models[0]).tops == ()


@pytest.mark.parametrize(
    ("changed", "fits"),
    [
        ({}, True),
        ({"name": "Couch"}, True),
        ({"name": "Table"}, False),
        ({"width": "400"}, False),
        ({"height": "30"}, False),
        ({"id": "Scopia#coffee_table"}, False),
    ],
)
def test_a_sofa_is_known_by_its_name_and_size(model, changed, fits):
    assert WANTED["sofa"].suits(model(**changed)) == fits


def test_a_heavy_mesh_is_not_wanted(model):
    assert not WANTED["sofa"].suits(model()._replace(mesh_bytes=10_000_000))


def sofa(palette, rng):
    rng.random()
    return piece((-0.9, 0.0, 0.0), (0.9, 0.8, 0.7))


def house_of(found):
    return House("test", tuple(found.parts("thing_1")))


def test_models_are_credited_when_they_are_placed(model):
    showroom = Showroom([model()])
    rng = np.random.default_rng(0)
    pieces = [showroom.made(sofa, None, rng) for _ in range(20)]
    by_code = [found for found in pieces if len(found.components) == 1]
    models = [found for found in pieces if len(found.components) == 2]
    assert by_code
    assert list(showroom.credits(house_of(by_code[0]))) == []
    assert list(showroom.credits(house_of(models[0]))) == ["model: 'Sofa' by Ada, CC0 (a.sh3f)"]


def test_what_has_no_model_is_made_by_code(model):
    def teapot(palette, rng):
        return piece((0.0, 0.0, 0.0), (0.1, 0.1, 0.1))

    assert len(Showroom([model()]).made(teapot, None, np.random.default_rng(0)).components) == 1


def test_a_broken_model_is_told_once_and_made_by_code(tmp_path, write_catalogue, files):
    write_catalogue("a.sh3f", content=files(obj="v 1 2 3\n"))
    showroom = Showroom(read_catalogue(tmp_path).models)
    rng = np.random.default_rng(0)
    assert all(len(showroom.made(sofa, None, rng).components) == 1 for _ in range(20))
    (defect,) = showroom.defects
    assert defect.startswith("a.sh3f: Test#model1 left out: ")
