"""Procedural homes for the tests: a few of each size, made once."""

from collections import defaultdict
from functools import cache

import numpy as np
import pytest

from slamgym.scenes.house import House, Part
from slamgym.scenes.procedural import HomeOptions, furnished_house

HOMES = (("medium", 0), ("medium", 1), ("small", 0), ("large", 0))
SHELL = {"floor", "ceiling", "wall", "window", "doorway", "facade"}


def _house(size: str = "medium", seed: int = 0, clutter: float = 1.0, texture: float = 1.0) -> House:
    return _made(size, seed, clutter, texture)


@cache
def _made(size: str, seed: int, clutter: float, texture: float) -> House:
    return furnished_house("home", seed, HomeOptions(size=size, clutter=clutter, texture=texture))


def _kind_of(name: str) -> str:
    return name.split("/")[0].rsplit("_", 1)[0]


def _pieces(house: House) -> dict[str, list[Part]]:
    found = defaultdict(list)
    for part in house.parts:
        if _kind_of(part.name) not in SHELL:
            found[part.name.split("/")[0]].append(part)
    return found


def _bounds(parts: list[Part]) -> np.ndarray:
    vertices = np.concatenate([p.vertices for p in parts]).astype(np.float64)
    return np.stack([vertices.min(axis=0), vertices.max(axis=0)])


@pytest.fixture(params=HOMES, ids=lambda home: f"{home[0]}-{home[1]}")
def size_and_seed(request):
    return request.param


@pytest.fixture
def size(size_and_seed):
    return size_and_seed[0]


@pytest.fixture
def home(size_and_seed):
    """Each of the homes in turn."""
    return _house(*size_and_seed)


@pytest.fixture
def homes():
    """All of them at once."""
    return [_house(*home) for home in HOMES]


@pytest.fixture
def house():
    """A function (size, seed, clutter, texture) that gives a home, always the same."""
    return _house


@pytest.fixture
def most_triangles():
    """Of a home, by its size."""
    return {"small": 150_000, "medium": 150_000, "large": 300_000}


@pytest.fixture
def kind_of():
    """A function that gives the kind of piece that a part belongs to, by its name."""
    return _kind_of


@pytest.fixture
def pieces():
    """A function that gives the parts of each piece of furniture, by the piece's name."""
    return _pieces


@pytest.fixture
def bounds():
    """A function that gives the box (2, 3) around parts."""
    return _bounds
