"""What seed and options decide."""

import hashlib
import subprocess
import sys

import numpy as np
import pytest

from slamgym.errors import ConfigError, SceneError
from slamgym.scenes.house import House
from slamgym.scenes.procedural import HomeOptions, Procedural

MAIN = {
    "bed",
    "sofa",
    "tv_bench",
    "wardrobe",
    "table",
    "chair",
    "desk",
    "bookshelf",
    "fridge",
    "oven",
    "toilet",
    "door",
}


def digest(house: House) -> str:
    state = hashlib.sha256()
    for part in house.parts:
        state.update(part.name.encode())
        for array in (part.vertices, part.faces, part.uv, part.material.texture):
            state.update(b"" if array is None else array.tobytes())
    state.update(repr((house.rooms, house.lamps)).encode())
    return state.hexdigest()


def test_same_seed_same_house_in_another_process(house):
    code = (
        "import runpy, sys; from slamgym.scenes.procedural import HomeOptions, furnished_house;"
        "home = furnished_house('home', 0, HomeOptions(size='small'));"
        "print(runpy.run_path(sys.argv[1])['digest'](home))"
    )
    other = subprocess.run(
        [sys.executable, "-c", code, __file__], capture_output=True, text=True, check=True, timeout=60
    ).stdout.strip()
    assert digest(house("small", 0)) == other


def test_seeds_and_sizes_differ(homes):
    assert len({digest(home) for home in homes}) == len(homes)


def test_clutter_and_texture_leave_plan_and_main_furniture_alone(house, pieces, kind_of, bounds):
    def main_furniture(home: House) -> dict[str, np.ndarray]:
        return {name: bounds(parts) for name, parts in pieces(home).items() if kind_of(name) in MAIN}

    plain, usual, rich = (house("small", clutter=share, texture=share) for share in (0.0, 1.0, 2.0))
    assert plain.rooms == usual.rooms == rich.rooms
    assert plain.windows == usual.windows == rich.windows
    expected = main_furniture(usual)
    for other in (plain, rich):
        found = main_furniture(other)
        assert found.keys() == expected.keys()
        for name, box in expected.items():
            np.testing.assert_array_equal(found[name], box)


def test_more_clutter_is_more_things(house, pieces):
    numbers = [len(pieces(house("small", clutter=clutter, texture=clutter))) for clutter in (0.0, 1.0, 2.0)]
    assert numbers[0] + 20 < numbers[1] < numbers[2] - 10


def test_negative_seed_is_refused():
    with pytest.raises(SceneError, match="expected a seed of 0 or more, got -1"):
        Procedural.load(-1, HomeOptions())


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"size": "larg"}, "did you mean 'large'"),
        ({"clutter": 2.5}, "'clutter'.*less than or equal to 2, got 2.5"),
        ({"texture": -1}, "'texture'.*greater than or equal to 0, got -1"),
        ({"rooms": 3}, "rooms"),
    ],
)
def test_bad_options_are_refused(options, message):
    with pytest.raises(ConfigError, match=message):
        Procedural.Options.checked(options)
