"""The materials of one house: every surface that furniture and walls are made of, drawn once and shared."""

from dataclasses import dataclass

import numpy as np

from slamgym.scenes.home import pictures, prints, textures
from slamgym.scenes.home.textures import Colour, Image
from slamgym.scenes.house import Material

Rgb = tuple[float, float, float]


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


_WALL_COLOURS: tuple[Colour, ...] = (
    (226, 219, 204),
    (205, 214, 206),
    (214, 208, 218),
    (228, 208, 184),
    (196, 208, 218),
)
_CLOTH_COLOURS: tuple[Colour, ...] = ((96, 112, 128), (150, 92, 70), (88, 116, 92), (168, 148, 110), (120, 84, 104))
_FLOOR_COLOURS: tuple[Colour, ...] = ((172, 126, 82), (150, 104, 66), (188, 150, 108), (132, 96, 68))
_FRONT_COLOURS: tuple[Colour, ...] = ((222, 220, 210), (150, 168, 160), (190, 160, 120), (122, 140, 158))


def make_palette(rng: np.random.Generator) -> Palette:
    """A house's finishes, colours drawn from a few schemes."""
    walls = [_WALL_COLOURS[i] for i in rng.permutation(len(_WALL_COLOURS))]
    cloth = [_CLOTH_COLOURS[i] for i in rng.permutation(len(_CLOTH_COLOURS))]
    floors = [_FLOOR_COLOURS[i] for i in rng.permutation(len(_FLOOR_COLOURS))]
    front = _FRONT_COLOURS[rng.integers(len(_FRONT_COLOURS))]
    floor = textures.parquet if rng.random() < 0.4 else textures.planks
    return Palette(
        oak=_textured("oak", textures.wood(rng, (190, 150, 104)), 0.9),
        walnut=_textured("walnut", textures.wood(rng, (112, 76, 52)), 0.9),
        lacquer=_textured("lacquer", textures.wood(rng, (158, 110, 72)), 1.2),
        white=_textured("white", textures.plaster(rng, (232, 230, 225), 256), 1.0),
        trim=_textured("trim", textures.plaster(rng, (238, 236, 230), 256), 1.5),
        ceiling=_textured("ceiling", textures.plaster(rng, (240, 239, 235), 512, 0.02), 3.0),
        facade=_textured("facade", textures.plaster(rng, (205, 196, 180), 256, 0.05), 2.0),
        metal=_plain("metal", (0.42, 0.43, 0.45)),
        black=_plain("black", (0.025, 0.025, 0.028)),
        glass=_plain("dark glass", (0.012, 0.014, 0.018)),
        glow=_plain("lamp glow", (1.0, 0.95, 0.86)),
        porcelain=_plain("porcelain", (0.83, 0.83, 0.82)),
        counter=_textured("counter", textures.marble(rng, (120, 116, 112)), 0.8),
        fronts=_textured("fronts", textures.wood(rng, front), 1.1),
        linen=_textured("linen", textures.fabric(rng, (232, 228, 218)), 0.6),
        blanket=_textured("blanket", textures.checked(rng, cloth[0], (214, 204, 186)), 1.3),
        curtain=_textured("curtain", textures.checked(rng, (206, 194, 172), cloth[1]), 0.9),
        sofa=_textured("sofa", textures.fabric(rng, cloth[2]), 0.6),
        leaves=_textured("leaves", textures.leaves(rng), 0.3),
        soil=_plain("soil", (0.05, 0.035, 0.025)),
        clay=_textured("clay", textures.plaster(rng, (176, 104, 74), 128, 0.06), 0.5),
        books=_picture("books", prints.book_spines(rng)),
        labels=_picture("labels", prints.labels(rng)),
        clock=_picture("clock", prints.clock_face(rng)),
        screen=_picture("screen", prints.screen(rng)),
        cushions=tuple(
            _textured(f"cushion {i}", texture, 0.5)
            for i, texture in enumerate(
                (
                    textures.checked(rng, cloth[3], cloth[4]),
                    textures.fabric(rng, cloth[3]),
                    textures.fabric(rng, cloth[0]),
                )
            )
        ),
        rugs=tuple(_picture(f"rug {i}", pictures.rug(rng)) for i in range(2)),
        pictures=tuple(_picture(f"picture {i}", pictures.PICTURES[i % len(pictures.PICTURES)](rng)) for i in range(14)),
        views=tuple(_picture(f"view {i}", prints.outside(rng)) for i in range(2)),
        # The last is as smooth as walls get, and gives a camera next to nothing to hold on to.
        plain_walls=(
            *(_textured(f"woodchip {i}", textures.woodchip(rng, walls[i]), 1.6) for i in range(3)),
            _textured("paint", textures.plaster(rng, walls[2]), 2.0),
        ),
        papered_walls=(
            _textured("flowered paper", textures.floral_wallpaper(rng, walls[3], cloth[1]), 1.7),
            _textured("striped paper", textures.striped_wallpaper(rng, walls[4]), 1.9),
        ),
        wall_tiles=_textured("wall tiles", textures.tiles(rng, (214, 220, 218), 8, variation=0.03), 1.6),
        wood_floor=_textured("wood floor", floor(rng, floors[0]), 2.4),
        carpet_floor=_textured("carpet", textures.carpet(rng, (160, 146, 128)), 1.8),
        kitchen_floor=_textured("kitchen floor", textures.tiles(rng, (178, 160, 138)), 2.1),
        bath_floor=_textured("bath floor", textures.tiles(rng, (128, 138, 144), 8), 1.8),
    )


def _textured(name: str, texture: Image, tile: float) -> Finish:
    return Finish(Material(name, texture=texture), tile)


def _picture(name: str, texture: Image) -> Finish:
    return Finish(Material(name, texture=texture))


def _plain(name: str, colour: Rgb) -> Finish:
    return Finish(Material(name, colour), 1.0)
