"""The shell of a house: floors, ceilings, walls with doorways and windows, skirting boards."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from slamgym.scenes.home.floorplan import (
    DOOR_FRAME,
    DOOR_HEIGHT,
    DOOR_WIDTH,
    INNER_WALL,
    OUTER_WALL,
    Doorway,
    FloorPlan,
    Opening,
    PlannedRoom,
    Wall,
)
from slamgym.scenes.home.furniture.piece import Component, Piece
from slamgym.scenes.home.palette import Finish, Palette
from slamgym.scenes.home.solids import Mesh, bevelled, border, box, merge, picture, placed, quads
from slamgym.scenes.house import Window

_PANE_DEPTH = 0.17  # of the window pane behind the inner face of the wall
_DAYLIGHT_DEPTH = 0.1  # of where daylight begins, in front of the frames
_SKIRTING = (0.012, 0.08)  # thickness, height


def shell_pieces(plan: FloorPlan, palette: Palette, rng: np.random.Generator, richness: float = 1.0) -> Iterator[Piece]:
    """All pieces of the shell, in world coordinates; richness: of wallpapers, 1 as in most homes."""
    papers = _wall_finishes(plan, palette, rng, richness)
    for planned, paper in zip(plan.rooms, papers, strict=True):
        yield from _floor_and_ceiling(planned, plan.height, palette)
        around = 0.0
        for wall in planned.walls:
            yield _wall(wall, paper, palette, plan.height, around)
            around += wall.length
            yield from (_window(wall, o, palette, rng) for o in wall.openings if o.kind == "window")
    yield from (_door_frame(doorway, palette) for doorway in plan.doorways)
    yield from _facade(plan, palette)


def daylight(plan: FloorPlan) -> Iterator[Window]:
    """The clear panes of all windows as sources of light, a little inside the frames."""
    for planned in plan.rooms:
        for wall in planned.walls:
            c, s = float(np.cos(wall.yaw)), float(np.sin(wall.yaw))
            for o in wall.openings:
                if o.kind == "window":
                    middle = wall.point(o.centre, -_DAYLIGHT_DEPTH, (o.bottom + o.top) / 2)
                    half = o.width / 2 - 0.08
                    yield Window(middle, (0.0, 0.0, (o.top - o.bottom) / 2 - 0.08), (half * c, half * s, 0.0))


def _wall_finishes(plan: FloorPlan, palette: Palette, rng: np.random.Generator, richness: float) -> list[Finish]:
    """Tiles in bathrooms; paper in some rooms, in more the richer a house is; plain paint elsewhere."""
    papers = [palette.papered_walls[i] for i in rng.permutation(len(palette.papered_walls))]
    plain = [palette.plain_walls[i] for i in rng.permutation(len(palette.plain_walls))]
    share = rng.random(len(plan.rooms))
    finishes = []
    for i, planned in enumerate(plan.rooms):
        likely = _PAPERED.get(planned.room.kind, 0.15) * richness + 2.0 * max(richness - 1.5, 0.0)
        papered = richness >= 0.25 and share[i] < likely
        finishes.append(papers[i % len(papers)] if papered else plain[i % len(plain)])
    return [
        palette.wall_tiles if planned.room.kind == "bathroom" else finish
        for planned, finish in zip(plan.rooms, finishes, strict=True)
    ]


_PAPERED = {"living_room": 0.5, "bedroom": 0.6, "nursery": 0.5, "dining_room": 0.4, "hall": 0.4, "kitchen": 0.0}


def _floor_finish(kind: str, palette: Palette) -> Finish:
    floors = {
        "kitchen": palette.kitchen_floor,
        "bathroom": palette.bath_floor,
        "bedroom": palette.carpet_floor,
        "nursery": palette.carpet_floor,
    }
    return floors.get(kind, palette.wood_floor)


def _floor_and_ceiling(planned: PlannedRoom, height: float, palette: Palette) -> Iterator[Piece]:
    cell = planned.cell
    corners = [(cell.x_min, cell.y_min), (cell.x_max, cell.y_min), (cell.x_max, cell.y_max), (cell.x_min, cell.y_max)]
    floor = quads([[(x, y, 0.0) for x, y in corners]], [corners])
    ceiling = quads([[(x, y, height) for x, y in corners[::-1]]], [corners[::-1]])
    finish = _floor_finish(planned.room.kind, palette)
    yield Piece("floor", (Component("plane", finish, floor),))
    yield Piece("ceiling", (Component("plane", palette.ceiling, ceiling),))


def _wall(wall: Wall, paper: Finish, palette: Palette, height: float, around: float) -> Piece:
    """One side of a room; `around` is the length of wall before it, so that the pattern goes on around the corner."""
    face = _in_world(wall, _pierced_face(wall.length, height, wall.openings, around))
    doors = [o for o in wall.openings if o.kind == "door"]
    thickness, top = _SKIRTING
    runs = _gaps(wall.length, [(o.centre - o.width / 2 - 0.03, o.centre + o.width / 2 + 0.03) for o in doors])
    skirting = merge(box(run, (0.0, thickness), (0.0, top)) for run in runs)
    return Piece(
        "wall",
        (Component("inner", paper, face), Component("skirting", palette.trim, _in_world(wall, skirting))),
    )


def _in_world(wall: Wall, mesh: Mesh) -> Mesh:
    return placed(mesh, wall.yaw, wall.point(0.0))


def _gaps(length: float, taken: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """What is left of [0, length] without the sorted intervals."""
    edges = [0.0, *(edge for interval in taken for edge in interval), length]
    return [(a, b) for a, b in zip(edges[::2], edges[1::2], strict=True) if b > a]


def _pierced_face(length: float, height: float, openings: tuple[Opening, ...], around: float = 0.0) -> Mesh:
    """An upright face towards +y with rectangular holes; uv in metres, u to the right."""
    spans = [(o.centre - o.width / 2, o.centre + o.width / 2) for o in openings]
    columns: list[tuple[float, float, Opening | None]] = [(*gap, None) for gap in _gaps(length, spans)]
    columns += [(*span, opening) for span, opening in zip(spans, openings, strict=True)]
    # All columns are cut at the same heights: neighbours then share their vertices, and with them the light.
    levels = sorted({0.0, height, *(o.bottom for o in openings), *(o.top for o in openings)})
    corners = np.array(
        [
            _facing(left, right, low, high)
            for left, right, opening in columns
            for low, high in pairwise(levels)
            if opening is None or high <= opening.bottom or low >= opening.top
        ]
    )
    return quads(corners, np.stack([-corners[..., 0] - around, corners[..., 2]], axis=-1))


def _facing(x0: float, x1: float, z0: float, z1: float) -> list[tuple[float, float, float]]:
    return [(x0, 0.0, z0), (x0, 0.0, z1), (x1, 0.0, z1), (x1, 0.0, z0)]


def _window(wall: Wall, opening: Opening, palette: Palette, rng: np.random.Generator) -> Piece:
    """Lining of the recess, casements with a mullion, a sill board, and a part of the view as a bright pane."""
    width, z = opening.width, (opening.bottom, opening.top)
    x, inner = (-width / 2, width / 2), (-width / 2 + 0.02, width / 2 - 0.02)
    lining = border(x, (-OUTER_WALL + 0.01, 0.004), z, 0.02)
    casement = border(inner, (-_PANE_DEPTH, -_PANE_DEPTH + 0.05), (z[0] + 0.02, z[1] - 0.02), 0.06)
    mullion = box((-0.03, 0.03), (-_PANE_DEPTH, -_PANE_DEPTH + 0.045), (z[0] + 0.08, z[1] - 0.08))
    sill = bevelled((-width / 2 - 0.05, width / 2 + 0.05), (-_PANE_DEPTH + 0.05, 0.06), (z[0] - 0.03, z[0] + 0.021))
    view = palette.views[rng.integers(len(palette.views))]
    pane = picture(width, z, -_PANE_DEPTH + 0.01)
    outlook = Mesh(pane.vertices, pane.faces, pane.uv * (0.5, 0.8) + rng.uniform(0.0, (0.5, 0.2)))
    components = (
        Component("frame", palette.trim, merge([lining, casement, mullion])),
        Component("sill", palette.trim, sill),
        Component("view", view, outlook, glow=True),
    )
    return Piece("window", components).placed(wall.yaw, wall.point(opening.centre))


def _door_frame(doorway: Doorway, palette: Palette) -> Piece:
    """Jambs and lintel around the clear opening, flush with the plaster but for an edge of 15 mm."""
    half, edge = DOOR_WIDTH / 2, DOOR_FRAME + 0.04
    y = (-INNER_WALL / 2 - 0.015, INNER_WALL / 2 + 0.015)
    frame = [
        box((-half - edge, -half), y, (0.0, DOOR_HEIGHT + edge)),
        box((half, half + edge), y, (0.0, DOOR_HEIGHT + edge)),
        box((-half, half), y, (DOOR_HEIGHT, DOOR_HEIGHT + edge)),
    ]
    yaw = 0.0 if doorway.along == "x" else np.pi / 2
    return Piece("doorway", (Component("frame", palette.trim, merge(frame)),)).placed(yaw, (*doorway.centre, 0.0))


def _facade(plan: FloorPlan, palette: Palette) -> Iterator[Piece]:
    """The four outer faces, pierced by the windows of the rooms behind them."""
    w, d, t = plan.width, plan.depth, OUTER_WALL
    corners = ((w + t, -t), (w + t, d + t), (-t, d + t), (-t, -t))
    for side, (corner, yaw) in enumerate(zip(corners, (np.pi, -np.pi / 2, 0.0, np.pi / 2), strict=True)):
        face = Wall(corner, yaw, (w if side % 2 == 0 else d) + 2 * t, outer=True)
        inner = [planned.walls[side] for planned in plan.rooms if planned.walls[side].outer]
        holes = [replace(o, centre=face.along(wall.point(o.centre))[0]) for wall in inner for o in wall.openings]
        holes.sort(key=lambda o: o.centre)
        mesh = _pierced_face(face.length, plan.height, tuple(holes))
        yield Piece("facade", (Component("face", palette.facade, _in_world(face, mesh)),))
