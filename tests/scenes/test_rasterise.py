import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from slamgym.errors import SceneError
from slamgym.scenes import rasterise
from slamgym.scenes.rasterise import Raster

RASTER = Raster(np.array([-1.0, 2.0]), (12, 16), 0.5)


def overlapping(corners, grow):
    """Cells of RASTER, made larger by `grow` on each side, that no line separates from a triangle (3, 2)."""
    edges = np.roll(corners, -1, axis=0) - corners
    # A triangle that is no more than a line, or a point, is kept apart by lines across it, too.
    normals = np.vstack([np.eye(2), np.column_stack([-edges[:, 1], edges[:, 0]]), edges])
    normals = normals[np.abs(normals).max(axis=1) > 0]
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    rows, columns = np.mgrid[: RASTER.shape[0], : RASTER.shape[1]]
    centres = (np.stack([columns, rows], axis=-1) + 0.5) * RASTER.resolution_m + RASTER.origin_xy
    reach = np.abs(normals).sum(axis=1) * (RASTER.resolution_m / 2 + grow)
    low, high = (corners @ normals.T).min(axis=0), (corners @ normals.T).max(axis=0)
    at = centres @ normals.T
    return ((at + reach >= low) & (at - reach <= high)).all(axis=-1)


COORDINATES = st.floats(-4, 12, width=32) | st.integers(-8, 24).map(lambda n: n / 2)


@settings(max_examples=300, deadline=None)
@given(arrays(np.float64, (3, 2), elements=COORDINATES), st.sampled_from([None, 0, 1]))
def test_the_cells_are_those_that_meet_the_triangle(corners, level):
    if level is not None:
        corners[:, level] = corners[0, level]  # a wall along an axis
    touched = RASTER.touched(np.column_stack([corners, [0.0, 1.0, 2.0]])[None])
    assert (touched >= overlapping(corners, -1e-6)).all()
    assert (touched <= overlapping(corners, 1e-6)).all()


def test_what_triangles_touch_together_is_what_each_touches(monkeypatch):
    monkeypatch.setattr(rasterise, "SPANS_AT_A_TIME", 7)
    triangles = np.random.default_rng(0).uniform(-4, 12, (40, 3, 3))
    each = [RASTER.touched(triangle[None]) for triangle in triangles]
    assert np.array_equal(RASTER.touched(triangles), np.any(each, axis=0))
    assert not RASTER.touched(triangles[:0]).any()


def test_cost_goes_with_rows_and_is_bounded(monkeypatch):
    raster = Raster.over((0, 0), (180, 150), 0.05)
    floor = np.array([[(0, 0, 0), (180, 0, 0), (180, 150, 0)], [(0, 0, 0), (180, 150, 0), (0, 150, 0)]], float)
    monkeypatch.setattr(rasterise, "MAX_SPANS", 2 * raster.shape[0])
    assert np.count_nonzero(raster.touched(floor)) == 3001 * 3601
    beside, far = floor + np.array([200.0, 0.0, 0.0]), floor * 1e30
    assert not raster.touched(np.concatenate([beside] * 10)).any()
    assert raster.touched(far)[2:, 2:].all()
    with pytest.raises(SceneError, match=r"at most 6006 rows of cells in all, got 60\d\d\d; simplify it"):
        raster.touched(np.concatenate([floor] * 10))


@pytest.mark.parametrize("upper", [(600, 400), (1e300, 1e300), (np.inf, 1), (1, np.nan)])
def test_a_raster_of_no_size_that_a_house_has(upper):
    with pytest.raises(SceneError, match=r"too large: expected at most 25000000 cells of 0\.05 m, got .*in metres"):
        Raster.over((0, 0), upper, 0.05)
