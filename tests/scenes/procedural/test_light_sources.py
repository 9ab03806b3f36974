"""Windows and lamps of procedural homes."""

import numpy as np
import pytest


def test_daylight_comes_in_through_every_window(home, kind_of, bounds):
    panes = [bounds([p]) for p in home.parts if kind_of(p.name) == "window" and p.name.endswith("/view")]
    assert len(home.windows) == len(panes) >= 4
    for window, (low, high) in zip(home.windows, panes, strict=True):
        inward = np.cross(window.half_u, window.half_v)
        inward /= np.linalg.norm(inward)
        ahead = window.centre + 0.5 * inward
        assert any(r.x_min < ahead[0] < r.x_max and r.y_min < ahead[1] < r.y_max for r in home.rooms)
        assert np.abs(inward @ (np.array(window.centre) - (low + high) / 2)) == pytest.approx(0.06, abs=0.01)
        for u, v in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
            corner = np.array(window.centre) + u * np.array(window.half_u) + v * np.array(window.half_v)
            assert (corner > low - 0.08).all()
            assert (corner < high + 0.08).all()


def test_lamps_hang_free_in_every_room(home, bounds):
    for room in home.rooms:
        assert any(
            room.x_min < lamp.position[0] < room.x_max and room.y_min < lamp.position[1] < room.y_max
            for lamp in home.lamps
        )
    boxes = [bounds([p]) for p in home.parts if p.name.split("/")[0].startswith("ceiling_lamp")]
    for lamp in home.lamps:
        assert 1.9 < lamp.position[2] < 2.4
        assert not any(((box[0] < lamp.position) & (lamp.position < box[1])).all() for box in boxes)
