"""Pieces of furniture that are models where a catalogue has one, and made by code where not."""

from collections.abc import Iterable, Sequence

import numpy as np

from slamgym.errors import SceneError
from slamgym.scenes.furniture_catalogue.catalogue import Model
from slamgym.scenes.furniture_catalogue.meshes import Shape, shape_of
from slamgym.scenes.furniture_catalogue.wanted import WANTED, Wanted
from slamgym.scenes.home.furniture.piece import Component, Maker, Piece, Top
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.solids import Mesh
from slamgym.scenes.house import House
from slamgym.types import FloatArray

_MANY = 3
"""Models of a kind from which on none is made by code, so that homes differ."""
_CENTRED_BELOW = -0.01
_TOP_INSET = 0.15
_LEVEL_M = 0.03
_LEVEL_SHARE = 0.5


class Showroom:
    """Chooses models for one house. used: what it gave, placed or not. defects: models that could not be shown."""

    def __init__(self, models: Sequence[Model]) -> None:
        self._choices = {name: _choices(models, wanted) for name, wanted in WANTED.items()}
        self.used: dict[Model, Shape] = {}
        self.defects: list[str] = []

    def made(self, maker: Maker, palette: Palette, rng: np.random.Generator) -> Piece:
        """A model, drawn from those that can stand in for the maker's piece; or the maker's own, where they are few."""
        own = maker(palette, rng)
        name = getattr(maker, "__name__", "")
        choices = self._choices.get(name, [])
        model = choices[int(rng.integers(len(choices)))] if choices else None
        if model is None:
            return own
        try:
            self.used[model] = shape_of(model)
        except SceneError as error:
            self.defects += [str(error)] * (str(error) not in self.defects)
            return own
        return stand_in(own, model, self.used[model].components, WANTED[name])

    def credits(self, house: House) -> Iterable[str]:
        """A line for each model that stands in the house, sorted: who made it, its licence, and what it lacks."""
        seen = {id(part.material) for part in house.parts}
        for model in sorted(self.used, key=lambda model: (model.archive.name, model.id)):
            shape = self.used[model]
            if any(id(component.finish.material) in seen for component in shape.components):
                lacks = f"; {shape.missing} of its textures missing, plain colours instead" if shape.missing else ""
                yield f"model: {model.name!r} by {model.creator}, {model.licence} ({model.archive.name}){lacks}"


def _choices(models: Sequence[Model], wanted: Wanted) -> list[Model | None]:
    """The models that are wanted; None for a piece made by code."""
    found: list[Model | None] = [model for model in models if wanted.suits(model)]
    return [*found, None] if len(found) < _MANY and not (found and wanted.in_row) else found


def stand_in(own: Piece, model: Model, components: Sequence[Component], wanted: Wanted) -> Piece:
    """A model's components of the unit box as a piece that stands as `own` does, smaller things on it too."""
    low, high = own.bounds
    size = high - low if wanted.same_size else np.array(model.size_m)
    y = -size[1] / 2 if low[1] < _CENTRED_BELOW else 0.0
    at = np.array([0.0, y, model.elevation_m if wanted.at_elevation else 0.0])
    stretched = tuple(
        Component(c.name, c.finish, Mesh(c.mesh.vertices * size + at, c.mesh.faces, c.mesh.uv)) for c in components
    )
    return Piece(own.kind, stretched, _tops(own, model, size, at, components), own.front)


def _tops(
    own: Piece, model: Model, size: FloatArray, at: FloatArray, components: Iterable[Component]
) -> tuple[Top, ...]:
    """The upper side, where it is level and both the catalogue and `own` have smaller things stand on it."""
    drop = model.drop_on_top_m
    if (
        not own.tops
        or drop is None
        or abs(drop - model.size_m[2]) > _LEVEL_M
        or _level_share(components) < _LEVEL_SHARE
    ):
        return ()
    x, y = (0.5 - _TOP_INSET) * size[0], _TOP_INSET * size[1]
    return (Top((-float(x), float(x)), (float(at[1] + y), float(at[1] + size[1] - y)), float(at[2] + size[2])),)


def _level_share(components: Iterable[Component]) -> float:
    """How much of the unit box's upper side a model's faces fill."""
    corners = np.concatenate([c.mesh.vertices[c.mesh.faces] for c in components])
    upper = corners[(corners[..., 2] > 1.0 - _LEVEL_M).all(axis=1), :, :2]
    sides = upper[:, 1:] - upper[:, :1]
    return float(np.abs(np.linalg.det(sides)).sum() / 2.0)
