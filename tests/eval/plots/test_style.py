import errno
from itertools import combinations

import matplotlib as mpl
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.text import Text

from slamgym.errors import OutputError
from slamgym.eval.plots import plot_cumulative, save_figure
from slamgym.eval.plots.names import MAX_LETTERS, percent, plain, plain_names, printable
from slamgym.eval.plots.style import COLOURS, DASHES, LOST, MARKERS, TRUTH, legend_below, look, new_figure


def a_figure():
    figure = new_figure(4.0, 3.0)
    figure.add_subplot().bar([1, 2], [3, 4], hatch="//")
    return figure


def test_no_two_series_look_alike_in_grey():
    looks = [look(i) for i in range(42)]
    for one, other in combinations(looks, 2):
        assert (one.dash, one.marker) != (other.dash, other.marker)


def test_the_first_series_differ_in_each_of_colour_dash_and_marker():
    for one, other in combinations([look(i) for i in range(len(COLOURS))], 2):
        assert one.colour != other.colour
        assert one.dash != other.dash
        assert one.marker != other.marker


def test_no_style_is_listed_twice_and_no_series_looks_like_the_truth_or_a_loss():
    for styles in (COLOURS, DASHES, MARKERS):
        assert len(set(styles)) == len(styles)
    assert {TRUTH, LOST}.isdisjoint(COLOURS)


def test_no_colour_vanishes_on_white_paper():
    for colour in (*COLOURS, LOST):
        red, green, blue = to_rgb(colour)
        assert 0.299 * red + 0.587 * green + 0.114 * blue < 0.7


def drawn(text):
    """What matplotlib makes of a text that may hold mathematics."""
    shown, is_math = Text(text=text)._preprocess_math(text)
    assert not is_math
    return shown


@given(st.text(st.characters(exclude_categories=("C", "Z")), max_size=MAX_LETTERS))
def test_a_short_name_comes_out_as_it_is(name):
    assert drawn(plain(name)) == name


@given(st.text())
def test_any_name_becomes_one_printable_line_of_limited_length(name):
    shown = drawn(plain(name))
    assert len(shown) <= MAX_LETTERS
    assert shown == "" or shown.isprintable()


@pytest.mark.parametrize(
    ("name", "shown"), [("abcdefghij", "abc…hij"), ("abcdefg", "abcdefg"), ("a\nb\x00", "a b\ufffd")]
)
def test_long_names_lose_their_middle(name, shown):
    assert plain(name, 7) == shown


def test_a_printable_name_is_one_line_of_its_own_letters():
    assert printable(" a\tb\nc  $ d ") == "a b c $ d"
    assert printable("\x1b[31mred\udcff") == "\ufffd[31mred\ufffd"


def test_long_names_that_look_the_same_are_numbered():
    assert plain_names(["abcXdef", "abcYdef", "short"], 5) == ["ab…ef #1", "ab…ef #2", "short"]


@pytest.mark.parametrize(
    ("share", "shown"), [(1.0, "100 %"), (0.9999, "99.9 %"), (0.29, "29 %"), (0.0, "0 %"), (2 / 3, "67 %")]
)
def test_a_percentage_is_100_only_when_nothing_is_missing(share, shown):
    assert percent(share) == shown


def test_a_legend_shows_every_name_below_the_axes(hostile_names, texts_of):
    figure = new_figure(6.0, 4.0)
    axes = figure.add_subplot()
    names = plain_names(hostile_names)
    legend_below(figure, [axes.plot([0, 1], [0, i], label=name)[0] for i, name in enumerate(names)])
    assert set(map(drawn, names)) <= set(texts_of(figure))
    (legend,) = figure.legends
    assert legend.get_window_extent().y1 < axes.get_window_extent().y0
    assert legend.get_window_extent().x0 >= 0.0


@pytest.mark.parametrize("n", [1, 20])
def test_a_legend_of_many_names_leaves_the_axes_their_height(n):
    figure = plot_cumulative({f"system {i} with a long enough name": [0.1, 0.2] for i in range(n)})
    figure.draw_without_rendering()
    assert figure.axes[0].get_position().height * figure.get_figheight() == pytest.approx(4.4, abs=0.3)


def test_the_same_figure_gives_the_same_bytes(tmp_path):
    figure = a_figure()
    first, _ = save_figure(figure, tmp_path / "a.b")
    second, _ = save_figure(a_figure(), tmp_path / "second")
    again, _ = save_figure(figure, tmp_path / "again")
    assert first.read_bytes() == second.read_bytes() == again.read_bytes()
    assert first.name == "a.b.svg"


def test_nothing_but_the_two_files_is_left_and_no_setting_changed(tmp_path):
    before = dict(mpl.rcParams)
    svg, png = save_figure(a_figure(), tmp_path / "new" / "x")
    assert sorted((tmp_path / "new").iterdir()) == [png, svg]
    assert dict(mpl.rcParams) == before


def test_a_failed_write_keeps_the_old_files_and_says_so(tmp_path, monkeypatch):
    svg, png = save_figure(a_figure(), tmp_path / "x")
    old = svg.read_bytes(), png.read_bytes()

    def full(self, *args, **kwargs):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Figure, "savefig", full)
    with pytest.raises(OutputError, match=r"x.svg.*No space left"):
        save_figure(a_figure(), tmp_path / "x")
    assert (svg.read_bytes(), png.read_bytes()) == old
    assert sorted(tmp_path.iterdir()) == [png, svg]


def test_a_file_in_the_place_of_a_folder_is_refused(tmp_path):
    (tmp_path / "taken").write_text("")
    with pytest.raises(OutputError, match="name another place"):
        save_figure(a_figure(), tmp_path / "taken" / "x")
