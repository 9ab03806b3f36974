"""Furnishing one room: pieces against walls, on walls, on top of one another."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from slamgym.scenes.home.furniture import decor
from slamgym.scenes.home.furniture.piece import Made, Maker, Piece
from slamgym.scenes.home.palette import Finish, Palette
from slamgym.scenes.home.placement import Placed, RoomLayout


@dataclass(frozen=True, slots=True)
class Household:
    """What all rooms of a house share. pictures: those that do not hang yet. clutter: 1 as in most homes."""

    palette: Palette
    pictures: Iterator[Finish]
    clutter: float
    made: Made


class Furnisher:
    """One room's layout in its household.

    Main furniture is drawn from `rng`, small things only afterwards from `small_rng`: how many there are does not
    change what stands where.
    """

    def __init__(
        self, layout: RoomLayout, household: Household, rng: np.random.Generator, small_rng: np.random.Generator
    ) -> None:
        self.layout = layout
        self.household = household
        self.palette = household.palette
        self.rng = rng
        self._small_rng = small_rng
        self._later: list[Callable[[], None]] = []

    def make(self, maker: Maker) -> Piece:
        return self.household.made(maker, self.palette, self.rng)

    def stand(self, *makers: Maker, walls: Sequence[int] | None = None) -> list[Placed]:
        """Puts pieces against walls, those that fit."""
        items = (self.layout.against_wall(self.make(maker), self.rng, walls) for maker in makers)
        return [item for item in items if item]

    def hang(self, maker: Maker, z: float, walls: Sequence[int] | None = None) -> None:
        self.layout.against_wall(self.make(maker), self.rng, walls, z, margin=0.06, gap=0.002)

    def scatter(self, hosts: Sequence[Placed], makers: Sequence[Maker], each: float) -> None:
        """Small things on the tops of the given pieces, about `each` on every top; they come with `add_clutter`."""
        self._later.append(lambda: self._scatter(hosts, makers, each))

    def _scatter(self, hosts: Sequence[Placed], makers: Sequence[Maker], each: float) -> None:
        for host in hosts:
            for top in host.piece.tops:
                for maker in self._some(makers, each):
                    self.layout.on_top(host, top, self.make(maker), self.rng)

    def litter(self, makers: Sequence[Maker], number: float, walls: Sequence[int] | None = None) -> None:
        """Small things on the floor by the walls, about `number`, where routes stay free; see `scatter`."""
        self._later.append(lambda: self._litter(makers, number, walls))

    def _litter(self, makers: Sequence[Maker], number: float, walls: Sequence[int] | None) -> None:
        self.stand(*self._some(makers, number), walls=walls)

    def _some(self, makers: Sequence[Maker], number: float) -> list[Maker]:
        """About `number` of the makers, times the household's clutter; none twice before all came once."""
        count = int(number * self.household.clutter + self.rng.random())
        order = [i for _ in range(count // len(makers) + 1) for i in self.rng.permutation(len(makers)).tolist()]
        return [makers[i] for i in order[:count]]

    def add_clutter(self) -> None:
        """Puts the small things that were asked for; from now on all is drawn from their stream."""
        self.rng = self._small_rng
        for put in self._later:
            put()

    def rug_at(self, host: Placed, x: float, y: float, size: tuple[float, float]) -> None:
        item = host.beside(decor.rug(self.palette, self.rng, *size), x, y)
        if self.layout.contains(item):
            self.layout.lay(item)
