import numpy as np
import pytest

from slamgym.eval.plots.contact_sheet import contact_sheet
from slamgym.eval.plots.film_strip import film_strip


def plain(grey, height=240, width=320):
    return np.full((height, width, 3), grey, dtype=np.uint8)


def test_frames_stand_in_a_row_above_their_captions():
    strip = film_strip(
        [plain(10), plain(20), plain(30)], ["0.10 s  ok", "0.20 s  ok", "0.30 s  lost"], [True, True, False]
    )
    assert strip.shape == (150 + 22, 3 * 200 + 2 * 4, 3)
    assert [strip[75, x].tolist() for x in (100, 202, 304, 508)] == [[10] * 3, [255] * 3, [20] * 3, [30] * 3]
    good, bad = strip[-1, 100], strip[-1, 508]
    assert good[1] > good[0]  # green
    assert bad[0] > bad[1]  # vermilion
    assert (strip[150:, :200] == 255).any()  # letters


def test_each_frame_needs_its_caption():
    with pytest.raises(ValueError, match="shorter"):
        film_strip([plain(10), plain(20)], ["one"], [True, True])


def test_contact_sheet_fills_its_last_row_with_white():
    sheet = contact_sheet([plain(10)] * 4, columns=3, view_width=80)
    assert sheet.shape == (2 * 60, 3 * 80, 3)
    assert (sheet[60:, 80:] == 255).all()
    assert sheet[119, 79].tolist() == [10] * 3
