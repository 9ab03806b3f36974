from dataclasses import replace

import numpy as np
import trimesh

from slamgym.scenes.house import Material, Part
from slamgym.scenes.light.facing import turned_to_view
from slamgym.scenes.light.imagined_lamps import imagined_lamps
from slamgym.scenes.light.places import places_in
from slamgym.scenes.light.rays import rays_of, stacked
from slamgym.types import FloatArray


def box(low: tuple[float, ...], high: tuple[float, ...], inside_out: bool = False) -> Part:
    mesh = trimesh.creation.box(bounds=[low, high]).subdivide()
    faces = np.asarray(mesh.faces[:, ::-1] if inside_out else mesh.faces, np.int32)
    return Part("box", Material("grey"), np.asarray(mesh.vertices, np.float32), faces)


ROOM = box((-3, -2, 0), (3, 2, 2.5), inside_out=True)
CHEST = box((0.5, 0.5, 0.0), (2.0, 1.5, 0.9))


def places(*parts: Part) -> FloatArray:
    return places_in(rays_of(parts), stacked(parts)[0]).everywhere


def test_a_well_wound_house_stays_as_it_is() -> None:
    turned = turned_to_view([ROOM, CHEST], places(ROOM, CHEST))
    assert turned[0] is ROOM
    assert turned[1] is CHEST


def test_a_room_wound_inside_out_is_turned_over() -> None:
    wrong = replace(ROOM, faces=ROOM.faces[:, ::-1])
    turned = turned_to_view([wrong, CHEST], places(wrong, CHEST))
    hidden = np.count_nonzero((turned[0].faces != ROOM.faces).any(axis=1))
    assert hidden <= 4
    assert (wrong.faces == ROOM.faces[:, ::-1]).all()


def test_mixed_winding_becomes_one() -> None:
    flip = np.random.default_rng(0).random(len(CHEST.faces)) < 0.5
    mixed = replace(CHEST, faces=np.where(flip[:, None], CHEST.faces[:, ::-1], CHEST.faces))
    turned = turned_to_view([ROOM, mixed], places(ROOM, mixed))[1]
    seen = CHEST.vertices[CHEST.faces].mean(axis=1)[:, 2] > 0.01  # the bottom is hidden
    assert (turned.faces == CHEST.faces)[seen].all()


def test_thin_surfaces_that_are_seen_from_both_sides_stay_as_they_are() -> None:
    mesh = trimesh.creation.box(bounds=[(-1.0, -1.0, 0.0), (1.0, 1.0, 1.8)])
    upright = np.abs(mesh.face_normals[:, 0]) > 0.9
    sheet = Part(
        "sheet", Material("m"), mesh.vertices.astype(np.float32) * [0, 1, 1], mesh.faces[upright].astype(np.int32)
    )
    assert turned_to_view([ROOM, sheet], places(ROOM, sheet))[1] is sheet


def test_what_shines_is_never_turned() -> None:
    shining = replace(ROOM, faces=ROOM.faces[:, ::-1], light=np.ones_like(ROOM.vertices))
    assert turned_to_view([shining], places(shining))[0] is shining


def test_imagined_lamps_hang_free_and_light_every_room() -> None:
    wall = box((-0.1, -2.0, 0.0), (0.1, 2.0, 2.5))
    lamps = imagined_lamps(places(ROOM, wall), rays_of([ROOM, wall]))
    x, y, z = np.array([lamp.position for lamp in lamps]).T
    assert (x < 0).any()
    assert (x > 0).any()
    assert len(lamps) <= 4
    assert (np.abs(y) < 1.3).all()
    assert ((z > 1.9) & (z < 2.2)).all()


def test_no_place_no_lamp() -> None:
    assert imagined_lamps(np.zeros((0, 3)), rays_of([ROOM])) == ()
