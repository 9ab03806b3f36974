import numpy as np
import pytest
import trimesh

from slamgym.scenes.house import Material
from slamgym.scenes.importing.cleaning import areas_of, clean, far_faces, weighted_quantile
from slamgym.scenes.importing.data_root import DataRoot
from slamgym.scenes.importing.pieces import Piece
from slamgym.scenes.importing.reader import read_pieces


def piece(name, vertices, faces, **more):
    return Piece(name, Material(name), np.array(vertices, float), np.array(faces), **more)


def box(name, low, high, scale=1.0):
    bounds = np.array([low, high], float) * scale
    mesh = trimesh.creation.box(bounds=bounds)
    return piece(name, mesh.vertices, mesh.faces)


def room(scale=1.0):
    tables = [box(f"table{x}", (x, 1, 0), (x + 0.5, 2, 0.7), scale) for x in range(4)]
    return [box("room", (0, 0, 0), (5, 4, 2.6), scale), *tables]


def faces(pieces):
    return sum(len(p.faces) for p in pieces)


SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]


def test_bad_faces_go_and_the_rest_stays():
    bad = piece(
        "bad",
        [*SQUARE, [np.nan, 0, 0], [np.inf, 1, 0], [5, 5, 5]],
        [[0, 1, 2], [0, 2, 3], [0, 1, 4], [1, 2, 5], [0, 0, 1], [0, 1, 7], [-1, 0, 1]],
        uv=np.arange(14, dtype=np.float32).reshape(7, 2),
        colour=np.arange(21, dtype=np.float32).reshape(7, 3),
    )
    (cleaned,), told = clean([bad])
    assert (cleaned.vertices[cleaned.faces] == bad.vertices[bad.faces[:2]]).all()
    assert (cleaned.uv == bad.uv[:4]).all()
    assert (cleaned.colour == bad.colour[:4]).all()
    assert told == [
        "2 faces with vertices that are not there left out, in 'bad'",
        "2 faces with vertices that are not numbers left out, in 'bad'",
        "1 face without area left out, in 'bad'",
    ]
    assert len(bad.faces) == 7  # as it was


def test_thin_faces_stay():
    sliver = piece("sliver", [[0, 0, 0], [10, 0, 0], [5, 1e-4, 0]], [[0, 1, 2]])
    assert faces(clean([sliver])[0]) == 1


def test_nothing_is_left_of_nothing():
    assert clean([]) == ([], [])
    assert clean([piece("dot", [[1, 1, 1]], [[0, 0, 0]])])[0] == []


@pytest.mark.parametrize("scale", [1.0, 1000.0, 0.01])
@pytest.mark.parametrize("distance", [200.0, 3e5])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_far_objects_go(scale, distance, axis):
    low = np.zeros(3)
    low[axis] = -distance
    cleaned, told = clean([*room(scale), box("junk", low, low + 1.0, scale)])
    assert [p.name for p in cleaned] == [p.name for p in room()]
    assert told == ["12 faces far away from all others left out, in 'junk'"]


def test_a_far_plane_larger_than_the_house_goes():
    plane = box("plane", (3e5, 0, 0), (3.02e5, 2e3, 0.1))
    cleaned, _ = clean([*room(), box("lamp", (2, 2, 2), (2.2, 2.2, 2.4)), plane])
    assert "plane" not in [p.name for p in cleaned]
    assert faces(cleaned) == faces(room()) + 12


def test_a_face_that_reaches_far_away_goes_alone():
    stretched = piece("wall", [*SQUARE, [3e5, 3e5, 0]], [[0, 1, 2], [0, 2, 3], [0, 1, 4]])
    cleaned, told = clean([*room(), stretched])
    assert faces(cleaned) == faces(room()) + 2
    assert told == ["1 face far away from all others left out, in 'wall'"]


def test_a_garden_shed_stays():
    assert faces(clean([*room(), box("shed", (25, 0, 0), (28, 3, 2.2))])[0]) == faces(room()) + 12


def test_what_is_less_than_ten_times_the_house_away_stays():
    post = box("post", (15, 1, 0), (15.1, 1.1, 1))
    assert faces(clean([*room(), post])[0]) == faces(room()) + 12
    far_post = box("post", (60, 1, 0), (60.1, 1.1, 1))
    assert faces(clean([*room(), far_post])[0]) == faces(room())


def test_a_large_plane_does_not_make_its_house_an_outlier():
    plane = piece("plane", [[0, 0, 0], [600, 0, 0], [0, 600, 0]], [[0, 1, 2]])
    assert faces(clean([*room(), plane])[0]) == faces(room()) + 1


def test_a_dense_statue_does_not_make_its_house_an_outlier():
    sphere = trimesh.creation.icosphere(subdivisions=5, radius=0.2)
    statue = piece("statue", sphere.vertices + 1.0, sphere.faces)
    hall = box("hall", (0, 0, 0), (40, 25, 8))
    assert not far_faces(np.concatenate([p.vertices[p.faces] for p in (statue, hall)])).any()


def test_a_real_house_is_kept_whole_and_junk_is_not(shared_data):
    file = shared_data / "scenes" / "aws_small_house.glb"
    pieces = read_pieces(file.read_bytes(), "glb", DataRoot(file.parent)).pieces
    house, _ = clean(pieces)
    assert faces(house) == faces(pieces) - 4  # two of its models have faces without area
    junk = [box("near", (200, 0, 0), (201, 1, 1)), box("far", (0, 3e5, 0), (1e3, 3.01e5, 1))]
    cleaned, told = clean([*house, *junk])
    assert faces(cleaned) == faces(house)
    assert told == ["24 faces far away from all others left out, in 'near', 'far'"]


def test_areas_and_quantiles():
    assert areas_of(np.array([[[0, 0, 0], [3, 0, 0], [0, 4, 0]]], float)).tolist() == [6.0]
    assert weighted_quantile(np.array([3.0, 1.0, 2.0]), np.array([1.0, 1.0, 8.0]), 0.5) == 2.0
    assert weighted_quantile(np.array([3.0, 1.0, 2.0]), np.array([1.0, 1.0, 8.0]), 0.05) == 1.0
