import numpy as np
import trimesh

from slamgym.scenes.house import Material, Part
from slamgym.scenes.light.imagined_lamps import imagined_lamps
from slamgym.scenes.light.places import Places, places_in
from slamgym.scenes.light.rays import rays_of, stacked


def part(mesh: trimesh.Trimesh, inside_out: bool = False) -> Part:
    faces = np.asarray(mesh.faces[:, ::-1] if inside_out else mesh.faces, np.int32)
    return Part("part", Material("grey"), np.asarray(mesh.vertices, np.float32), faces)


def box(low: tuple[float, ...], high: tuple[float, ...], inside_out: bool = False) -> Part:
    return part(trimesh.creation.box(bounds=[low, high]), inside_out)


def places(*parts: Part) -> Places:
    return places_in(rays_of(parts), stacked(parts)[0])


ROOM = box((-3, -2, 0), (3, 2, 2.5), inside_out=True)
ROOMS = [box((x, y, 0), (x + 4, y + 4, 2.5), inside_out=True) for x in (0, 4.2) for y in (0, 4.2)]
LAWN = box((-60, -60, -0.3), (60, 60, -0.1))


def test_cameras_stand_in_rooms_and_not_in_furniture() -> None:
    cupboard = box((-3.0, -2.0, 0.0), (-2.4, -0.8, 2.0))
    found = places(ROOM, cupboard)
    assert len(found.indoors) > 20
    assert (np.abs(found.everywhere) < [3.0, 2.0, 2.5]).all()
    assert not ((found.everywhere[:, 0] < -2.4) & (found.everywhere[:, 1] < -0.8)).any()


def test_there_are_no_cameras_without_a_floor() -> None:
    for found in (places(box((-3, -2, 1.4), (3, 2, 1.6))), places_in(rays_of([]), np.zeros((0, 3)))):
        assert found.indoors.shape == found.everywhere.shape == (0, 3)


def test_an_object_of_many_faces_draws_no_cameras_to_itself() -> None:
    room = box((0, 0, 0), (12, 8, 2.5), inside_out=True)
    ball = trimesh.creation.icosphere(subdivisions=6, radius=0.3)
    ball.apply_translation((11.0, 7.0, 0.3))
    found = places(room, part(ball)).indoors
    assert len(found) > 0.9 * len(places(room).indoors)


def test_a_garden_takes_no_lamps_from_the_rooms() -> None:
    found = places(LAWN, *ROOMS)
    assert len(found.everywhere) > len(found.indoors) > 0.8 * len(places(*ROOMS).indoors)
    assert ((found.indoors[:, :2] > 0.0) & (found.indoors[:, :2] < 8.2)).all()
    lamps = np.array([lamp.position for lamp in imagined_lamps(found.indoors, rays_of([LAWN, *ROOMS]))])
    assert 4 <= len(lamps) <= 16
    assert len(np.unique(lamps[:, :2] > 4.1, axis=0)) == 4
    assert (lamps[:, 2] < 2.5).all()


def test_without_a_ceiling_all_places_count_although_a_lamp_hangs_there() -> None:
    floor, shade = box((-4, -4, -0.1), (4, 4, 0.0)), box((-0.8, -0.8, 2.0), (0.8, 0.8, 2.2))
    found = places(floor, shade)
    assert len(found.indoors) > 150
    np.testing.assert_array_equal(found.indoors, found.everywhere)
