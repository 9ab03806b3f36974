import numpy as np
import pytest

from slamgym.errors import ConfigError
from slamgym.eval.plots.paired import plot_differences, plot_paired

NAN = np.nan


def test_pairs_are_counted_with_their_failures(texts_of):
    figure = plot_paired([0.1, 0.2, 0.3, NAN, NAN], [0.2, 0.1, 0.3, 0.1, NAN], quantity="ATE (m)")
    texts = texts_of(figure)
    assert "5 pairs: 2 better, 1 worse, 2 equal; failed in both: 1" in texts
    assert {"ATE (m), baseline", "ATE (m), new"} <= set(texts)
    assert texts.count("failed") == 2
    points, crosses = figure.axes[0].lines[1:]
    assert points.get_xydata().tolist() == [[0.1, 0.2], [0.2, 0.1], [0.3, 0.3]]
    assert (crosses.get_xdata() > 0.3).all()
    assert crosses.get_ydata()[0] == 0.1


def test_differences_are_sorted_and_worse_ones_are_hatched(texts_of):
    figure = plot_differences([10.0, -20.0, 0.0, NAN], quantity="points", worse="below")
    assert "1 worse, 1 better, 1 equal" in texts_of(figure)
    bars = sorted(figure.axes[0].patches, key=lambda bar: bar.get_x())
    assert [bar.get_height() for bar in bars] == [-20.0, 0.0, 10.0]
    assert [bool(bar.get_hatch()) for bar in bars] == [True, False, False]


def test_ratios_start_at_one(texts_of):
    figure = plot_differences([0.5, 4.0, 1.0], quantity="new / old", worse="above", ratio=True)
    assert {"1 worse, 1 better, 1 equal", "0.5", "1", "2", "4"} <= set(texts_of(figure))
    low, high = figure.axes[0].get_ylim()
    assert low * high == pytest.approx(1.0)
    bars = sorted(figure.axes[0].patches, key=lambda bar: bar.get_x())
    assert [bar.get_y() + bar.get_height() for bar in bars] == [0.5, 1.0, 4.0]


def test_odd_input_is_drawn_and_bad_input_refused(hostile_names):
    for name in hostile_names:
        plot_paired([0.1], [0.1], quantity=name, names=(name, name)).draw_without_rendering()
    plot_differences([], quantity="none", worse="above", ratio=True).draw_without_rendering()
    plot_paired([NAN], [NAN]).draw_without_rendering()
    with pytest.raises(ConfigError, match=r"expected two arrays \(P,\)"):
        plot_paired([0.1], [0.1, 0.2])
    with pytest.raises(ConfigError, match="expected differences"):
        plot_differences([[0.1]], quantity="x", worse="above")
