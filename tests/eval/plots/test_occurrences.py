import numpy as np
import pytest

from slamgym.errors import ConfigError
from slamgym.eval.plots.occurrences import MOST_DOTS, plot_occurrences
from slamgym.eval.plots.style import LOST

CASES = {
    "1. fast_turn\n3.2 s": {"unchanged": (3, 3), "slower": (1, 3)},
    "2. dark\n7.5 s": {"unchanged": (2, 3), "more light": (0, 3)},
}


def dots(figure):
    """Column, row -> filled dots, hollow dots."""
    counted = {}
    for line in figure.axes[0].lines:
        kind = line.get_markerfacecolor() != LOST
        for x, y in line.get_xydata():
            counted.setdefault((round(x), round(y)), [0, 0])[kind] += 1
    return counted


def test_a_dot_for_each_repeat(texts_of):
    figure = plot_occurrences(CASES)
    expected = {(0, 0): [3, 0], (0, 1): [1, 2], (1, 0): [2, 1], (1, 2): [0, 3]}
    assert dots(figure) == expected
    assert {"unchanged", "slower", "more light", "1. fast_turn", "7.5 s", "lost", "tracked"} <= set(texts_of(figure))
    assert texts_of(figure).count("\N{EN DASH}") == 2  # what was not tried


def test_many_repeats_are_written_in_figures(texts_of):
    figure = plot_occurrences({"a": {"unchanged": (7, MOST_DOTS + 1), "slower": (0, MOST_DOTS)}})
    assert f"7 of {MOST_DOTS + 1}" in texts_of(figure)
    assert dots(figure) == {(0, 1): [0, MOST_DOTS]}


def test_dots_of_one_cell_do_not_touch_those_of_the_next():
    figure = plot_occurrences({name: {"unchanged": (MOST_DOTS, MOST_DOTS)} for name in "ab"})
    places = sorted(x for line in figure.axes[0].lines for x, _ in line.get_xydata())
    assert places[MOST_DOTS] - places[MOST_DOTS - 1] > 2 * np.diff(places[:MOST_DOTS]).max()


def test_hostile_names(hostile_names, texts_of):
    figure = plot_occurrences({name: {name: (1, 2)} for name in hostile_names})
    assert any("$x_1$ & <b>" in text for text in texts_of(figure))


@pytest.mark.parametrize("cases", [{}, {"a": {}}, {"a": {"unchanged": (4, 3)}}, {"a": {"unchanged": (-1, 3)}}])
def test_what_cannot_be_drawn_is_refused(cases):
    with pytest.raises(ConfigError, match="plot_occurrences: expected"):
        plot_occurrences(cases)
