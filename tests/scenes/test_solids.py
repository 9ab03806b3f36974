import numpy as np
import pytest
import trimesh

from slamgym.scenes.home import solids

SOLIDS = {
    "box": (solids.box((0, 1), (0, 2), (0, 3)), 6.0),
    "cylinder": (solids.cylinder(0.5, (0, 2), sides=256), np.pi / 2),
    "tube": (solids.lathe([(1, 0), (2, 0), (2, 1), (1, 1), (1, 0)], sides=256), 3 * np.pi),
    "ball": (solids.ball(1.0, (3, 2, 1)), 3.2),
    "ellipsoid": (solids.cushion((-1, 1), (-2, 2), (-3, 3), softness=1.0), 4 / 3 * np.pi * 6),
    "bevelled": (solids.bevelled((0, 1), (0, 2), (0, 3), 0.05), 5.9),
    "block": (solids.cushion((0, 1), (0, 1), (0, 1), softness=0.05), 1.0),
    "ribbon": (solids.ribbon(np.column_stack([np.linspace(0, 2, 9), np.zeros(9)]), 0.1, (0, 3)), 0.6),
    "tub": (solids.lathe([(0, 0), (1, 0), (1, 1), (0, 1)], sides=64, roundness=0.05), 4.0),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_solids_are_closed_outward_and_of_the_right_size(name):
    mesh, volume = SOLIDS[name]
    checked = trimesh.Trimesh(mesh.vertices, mesh.faces)
    checked.merge_vertices(merge_tex=True, merge_norm=True)
    checked.update_faces(checked.nondegenerate_faces())
    assert checked.is_watertight
    assert checked.is_winding_consistent
    assert checked.volume == pytest.approx(volume, rel=0.1)


def test_wood_grain_runs_along_the_longer_side():
    top = solids.box((0, 2), (0, 1), (0, 1))
    for corner in range(0, 24, 4):
        vertices, uv = top.vertices[corner : corner + 4], top.uv[corner : corner + 4]
        assert np.ptp(uv[:, 0]) == pytest.approx(np.ptp(vertices, axis=0).max())


def test_picture_is_upright_and_not_mirrored_seen_from_the_front():
    mesh = solids.picture(2.0, (0.0, 1.0), 0.0)
    a, b, c = mesh.vertices[mesh.faces[0]]
    assert np.cross(b - a, c - a) @ (0, 1, 0) > 0
    right = mesh.vertices[:, 0] < 0  # of somebody who looks along -y
    assert (mesh.uv[right, 0] == 1).all()
    assert (mesh.uv[mesh.vertices[:, 2] == 1.0, 1] == 1).all()
