"""Furnishing one room: pieces against walls, on walls, on top of one another."""

from collections.abc import Iterator, Sequence

from slamgym.scenes.home.furniture import decor
from slamgym.scenes.home.furniture.clutter import Maker
from slamgym.scenes.home.furniture.piece import Piece
from slamgym.scenes.home.palette import Finish, Palette
from slamgym.scenes.home.placement import Placed, RoomLayout


class Furnisher:
    """One room's layout together with the house's palette."""

    def __init__(self, layout: RoomLayout, palette: Palette, pictures: Iterator[Finish]) -> None:
        self.layout = layout
        self.palette = palette
        self.rng = layout.rng
        self.pictures = pictures

    def make(self, maker: Maker) -> Piece:
        return maker(self.palette, self.rng)

    def stand(self, *makers: Maker, walls: Sequence[int] | None = None) -> list[Placed]:
        """Puts pieces against walls, those that fit."""
        items = (self.layout.against_wall(self.make(maker), walls) for maker in makers)
        return [item for item in items if item]

    def hang(self, maker: Maker, z: float, walls: Sequence[int] | None = None) -> None:
        self.layout.against_wall(self.make(maker), walls, z, margin=0.06, gap=0.002)

    def scatter(self, hosts: Sequence[Placed], makers: Sequence[Maker], each: int) -> None:
        """Small things on the tops of the given pieces."""
        for host in hosts:
            for top in host.piece.tops:
                for i in self.rng.permutation(len(makers))[:each].tolist():
                    self.layout.on_top(host, top, self.make(makers[i]))

    def rug_at(self, host: Placed, x: float, y: float, size: tuple[float, float]) -> None:
        item = host.beside(decor.rug(self.palette, self.rng, *size), x, y)
        if self.layout.contains(item):
            self.layout.lay(item)
