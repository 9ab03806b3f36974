"""The materials of one house: every surface that furniture and walls are made of, drawn once and shared."""

from dataclasses import dataclass

import numpy as np

from slamgym.scenes.home import colours, pictures, prints, textures, views, wallpapers
from slamgym.scenes.home.colours import Colour, Rgb
from slamgym.scenes.home.textures import Image
from slamgym.scenes.house import Material


@dataclass(frozen=True, slots=True, eq=False)
class Finish:
    """A material and the metres that one repeat of its texture covers; None: the mesh's uv are used as they are."""

    material: Material
    tile: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Palette:
    """Named finishes; tuples where pieces choose one."""

    oak: Finish
    walnut: Finish
    lacquer: Finish
    white: Finish
    trim: Finish
    ceiling: Finish
    facade: Finish
    metal: Finish
    black: Finish
    glass: Finish
    glow: Finish
    porcelain: Finish
    counter: Finish
    fronts: Finish
    linen: Finish
    blanket: Finish
    curtain: Finish
    sofa: Finish
    leaves: Finish
    soil: Finish
    clay: Finish
    books: Finish
    labels: Finish
    clock: Finish
    screen: Finish
    notes: Finish
    mirror: Finish
    card: Finish
    wicker: Finish
    backsplash: Finish
    plastics: tuple[Finish, ...]
    cushions: tuple[Finish, ...]
    rugs: tuple[Finish, ...]
    pictures: tuple[Finish, ...]
    views: tuple[Finish, ...]
    plain_walls: tuple[Finish, ...]
    papered_walls: tuple[Finish, ...]
    wall_tiles: Finish
    wood_floor: Finish
    carpet_floor: Finish
    kitchen_floor: Finish
    bath_floor: Finish


@dataclass(frozen=True, slots=True)
class _Painter:
    """Makes finishes from textures, as rich as asked for: 0 plain, 1 as made, 2 bold."""

    rng: np.random.Generator
    richness: float

    def surface(self, name: str, texture: Image, tile: float, kept: float = 0.0) -> Finish:
        """A repeated texture; kept: the share of its contrast that stays where surfaces are plain."""
        strength = kept + (1.0 - kept) * self.richness
        return Finish(Material(name, texture=textures.softened(texture, strength)), tile)

    def some(self, choices: tuple[Colour, ...]) -> list[Colour]:
        """All of them in a random order."""
        return [choices[i] for i in self.rng.permutation(len(choices))]

    def clothes(self, cloth: list[Colour]) -> tuple[Finish, ...]:
        woven = textures.checked(self.rng, cloth[3], cloth[4])
        plain = [textures.fabric(self.rng, cloth[i]) for i in (3, 0)]
        return tuple(self.surface(f"cushion {i}", texture, 0.5) for i, texture in enumerate((woven, *plain)))

    def paints(self, walls: list[Colour]) -> tuple[Finish, ...]:
        """The last is as smooth as walls get, and gives a camera next to nothing to hold on to."""
        chips = [self.surface(f"woodchip {i}", textures.woodchip(self.rng, walls[i]), 1.6) for i in range(3)]
        return *chips, self.surface("paint", textures.plaster(self.rng, walls[2], contrast=0.018), 2.0)

    def papers(self, walls: list[Colour], cloth: list[Colour]) -> tuple[Finish, ...]:
        return (
            self.surface("flowered paper", wallpapers.floral_wallpaper(self.rng, walls[3], cloth[1]), 1.7),
            self.surface("striped paper", wallpapers.striped_wallpaper(self.rng, walls[4]), 1.9),
            self.surface("lozenge paper", wallpapers.geometric_wallpaper(self.rng, walls[5], cloth[0]), 1.8),
        )

    def backsplash(self) -> Finish:
        colour = self.some(((222, 224, 220), (150, 170, 176), (196, 184, 160), (120, 132, 120)))[0]
        return self.surface("backsplash", textures.tiles(self.rng, colour, 8, 256, 0.06), 0.9, 0.4)


def make_palette(rng: np.random.Generator, richness: float = 1.0, number_of_pictures: int = 16) -> Palette:
    """A house's finishes, colours drawn from a few schemes; richness of surfaces from 0, plain, to 2, bold."""
    pictures_rng, rng = rng.spawn(2)
    p = _Painter(rng, richness)
    walls, cloth, floors = p.some(colours.WALLS), p.some(colours.CLOTHS), p.some(colours.FLOORS)
    floor = textures.parquet if rng.random() < 0.35 else textures.planks
    return Palette(
        oak=p.surface("oak", textures.wood(rng, p.some(colours.LIGHT_WOODS)[0]), 0.9, 0.4),
        walnut=p.surface("walnut", textures.wood(rng, p.some(colours.DARK_WOODS)[0]), 0.9, 0.4),
        lacquer=p.surface("lacquer", _painted(p, colours.DOORS), 1.2, 0.4),
        white=p.surface("white", textures.plaster(rng, (246, 244, 240), 256), 1.0),
        trim=p.surface("trim", textures.plaster(rng, (248, 246, 242), 256), 1.5),
        ceiling=p.surface("ceiling", textures.plaster(rng, (248, 247, 244), 512, 0.015), 3.0),
        facade=p.surface("facade", textures.plaster(rng, (205, 196, 180), 256, 0.05), 2.0),
        metal=_plain("metal", (0.42, 0.43, 0.45)),
        black=_plain("black", (colours.DARKEST,) * 3),
        glass=_plain("dark glass", (colours.DARKEST, 0.13, 0.14)),
        glow=_plain("lamp glow", (1.0, 0.95, 0.86)),
        porcelain=_plain("porcelain", (0.92, 0.92, 0.91)),
        counter=p.surface("counter", textures.marble(rng, p.some(colours.COUNTERS)[0]), 0.8, 0.4),
        fronts=p.surface("fronts", _painted(p, colours.FRONTS), 1.1),
        linen=p.surface("linen", textures.fabric(rng, (238, 234, 226)), 0.6),
        blanket=p.surface("blanket", _patterned(p, (226, 216, 200), cloth[0]), 1.3),
        curtain=p.surface("curtain", _patterned(p, (232, 222, 202), cloth[1]), 0.9),
        sofa=p.surface("sofa", textures.fabric(rng, cloth[2]), 0.6),
        leaves=p.surface("leaves", textures.leaves(rng), 0.3, 0.5),
        soil=_plain("soil", (0.17, 0.135, colours.DARKEST)),
        clay=p.surface("clay", textures.plaster(rng, (176, 104, 74), 128, 0.06), 0.5, 0.5),
        books=_picture("books", prints.book_spines(rng)),
        labels=_picture("labels", prints.labels(rng)),
        clock=_picture("clock", prints.clock_face(rng)),
        screen=_picture("screen", prints.screen(rng)),
        notes=_picture("notes", prints.notes(rng)),
        mirror=_picture("mirror", prints.reflection(rng)),
        card=p.surface("cardboard", textures.plaster(rng, (176, 140, 100), 128, 0.03), 0.6, 0.5),
        wicker=p.surface("wicker", textures.fabric(rng, (172, 132, 86), 128), 0.25, 0.5),
        backsplash=p.backsplash(),
        plastics=tuple(_plain(f"plastic {i}", colour) for i, colour in enumerate(colours.PLASTICS)),
        cushions=p.clothes(cloth),
        rugs=tuple(_picture(f"rug {i}", textures.softened(pictures.rug(rng), 0.4 + 0.6 * richness)) for i in range(3)),
        pictures=tuple(_hanging(pictures_rng, i) for i in range(number_of_pictures)),
        views=tuple(_picture(f"view {i}", views.outside(rng)) for i in range(3)),
        plain_walls=p.paints(walls),
        papered_walls=p.papers(walls, cloth),
        wall_tiles=p.surface(
            "wall tiles", textures.tiles(rng, p.some(colours.WALL_TILES)[0], 8, variation=0.05), 1.6, 0.4
        ),
        wood_floor=p.surface("wood floor", floor(rng, floors[0]), 2.4, 0.4),
        carpet_floor=p.surface("carpet", textures.carpet(rng, p.some(colours.CARPETS)[0]), 1.8),
        kitchen_floor=p.surface("kitchen floor", textures.tiles(rng, p.some(colours.KITCHEN_FLOORS)[0]), 2.1, 0.4),
        bath_floor=p.surface("bath floor", textures.tiles(rng, p.some(colours.BATH_FLOORS)[0], 8), 1.8, 0.4),
    )


def _patterned(p: _Painter, pale: Colour, dye: Colour) -> Image:
    """Cloth for beds and windows: checked, or printed with flowers or lozenges."""
    pattern = (textures.checked, wallpapers.floral_wallpaper, wallpapers.geometric_wallpaper)[int(p.rng.integers(3))]
    return pattern(p.rng, pale, dye, 256)


def _painted(p: _Painter, choices: tuple[Colour, ...]) -> Image:
    """Wood of one of the colours; grain hardly shows through paint, which is what pale and unlike wood is."""
    r, g, b = colour = p.some(choices)[0]
    return textures.softened(textures.wood(p.rng, colour), 1.0 if r - b > 55 and r > g else 0.25)


def _hanging(rng: np.random.Generator, number: int) -> Finish:
    return _picture(f"picture {number}", pictures.PICTURES[number % len(pictures.PICTURES)](rng))


def _picture(name: str, texture: Image) -> Finish:
    return Finish(Material(name, texture=texture))


def _plain(name: str, colour: Rgb) -> Finish:
    return Finish(Material(name, colour), 1.0)
