import numpy as np
import pytest

from slamgym.errors import ConfigError
from slamgym.eval.plots import plot_cumulative, plot_scatter, plot_sorted_bars, save_figure
from slamgym.eval.plots.failure_curves import FailureCounts, plot_failure_curves
from slamgym.eval.plots.heat_map import plot_heat_map
from slamgym.eval.plots.level_pairs import MAX_LINES, plot_level_pairs
from slamgym.eval.plots.stacked_bars import plot_stacked_bars
from slamgym.eval.statistics import failure_curve


def test_a_heat_map_counts_in_its_cells_and_leaves_empty_ones_white():
    figure = plot_heat_map([[0, 3], [4, 0]], [[4, 4], [4, 0]], ["0.2", "0.8"], ["0", "3"], y_factor="stride")
    axes = figure.axes[0]
    assert [text.get_text() for text in axes.texts] == ["0/4", "3/4", "4/4", "-"]
    shares = axes.collections[0].get_array()
    assert np.ma.filled(shares, -1).ravel().tolist() == [0, 0.75, 1, -1]
    assert axes.get_title(loc="left") == "7 of 12 runs failed"
    assert [label.get_text() for label in axes.get_yticklabels()] == ["0", "3"]


def test_darker_means_more_failures_in_grey_too():
    colours = plot_heat_map([[0, 5, 10]], [[10, 10, 10]], ["a", "b", "c"], ["x"]).axes[0].collections[0]
    lightness = colours.to_rgba(np.array([0.0, 0.5, 1.0]))[:, :3] @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(lightness) < -0.2).all()


def test_a_large_heat_map_has_no_counts_and_few_ticks():
    many = [str(i) for i in range(100)]
    axes = plot_heat_map(np.ones((100, 100)), np.full((100, 100), 2), many, many).axes[0]
    assert not axes.texts
    assert len(axes.get_xticks()) <= 24


@pytest.mark.parametrize(("failed", "runs"), [([[1]], [[1, 1]]), ([[2]], [[1]]), ([[-1]], [[1]])])
def test_a_heat_map_refuses_counts_that_do_not_fit(failed, runs):
    with pytest.raises(ConfigError, match="plot_heat_map: expected"):
        plot_heat_map(failed, runs, ["a"], ["b"])


def test_stacked_bars_stand_one_after_another():
    axes = plot_stacked_bars({"blur": [1, 0], "dark $x$": [2, 3]}, ["slow", "fast"], by="speed").axes[0]
    left = [(bar.get_x(), bar.get_width(), bar.get_hatch()) for bars in axes.containers for bar in bars]
    assert [part[:2] for part in left] == [(0, 1), (0, 0), (1, 2), (0, 3)]
    assert len({hatch for *_, hatch in left}) == 2
    with pytest.raises(ConfigError, match="2 amounts of 0 or more of 'blur'"):
        plot_stacked_bars({"blur": [1, -1]}, ["slow", "fast"])


def test_pairs_have_a_line_a_path_and_a_median_with_failures_last():
    values = [[0.1, 0.2], [0.1, np.inf], [0.3, np.nan]]
    figure = plot_level_pairs(values, ["off", "on"], by="loop closing")
    axes = figure.axes[0]
    assert [len(lines.get_segments()) for lines in axes.collections] == [1, 2, 0]
    median = axes.lines[-1].get_ydata()
    assert median[0] == pytest.approx(0.1)
    assert median[1] > 0.35  # in the band, since two of three failed
    assert [label.get_text() for label in axes.get_xticklabels()] == ["off\n0 failed", "on\n2 failed"]


def test_of_very_many_paths_some_are_drawn_and_all_counted():
    values = np.full((10_000, 2), 0.1)
    values[:4000, 1] = np.nan
    axes = plot_level_pairs(values, ["off", "on"]).axes[0]
    assert sum(len(lines.get_segments()) for lines in axes.collections) == MAX_LINES
    assert "on\n4000 failed" in [label.get_text() for label in axes.get_xticklabels()]
    with pytest.raises(ConfigError, match="2 levels"):
        plot_level_pairs([[0.1]], ["off", "on"])


def test_failure_curves_have_points_and_a_line_of_each_level():
    x, failed = np.repeat([0.2, 0.6, 1.0], 20), np.repeat([False, True, True], 20)
    failed[:4], failed[25:30] = True, False
    levels, k, n = np.array([0.2, 0.6, 1.0]), np.array([4, 15, 20]), np.full(3, 20)
    series = {
        "off": FailureCounts(levels, k, n, failure_curve(x, failed)),
        "on": FailureCounts(levels, np.array([0, 1, 0]), n),
    }
    axes = plot_failure_curves(series, by="loop closing").axes[0]
    points = [line for line in axes.lines if line.get_marker() not in ("None", "")]
    assert [line.get_label() for line in points] == ["off: 39 of 60 failed", "on: 1 of 60 failed"]
    assert points[0].get_ydata().tolist() == [0.2, 0.75, 1.0]
    assert len({line.get_marker() for line in points}) == 2
    with pytest.raises(ConfigError, match="plot_failure_curves: expected"):
        plot_failure_curves({})


def test_a_hundred_thousand_runs_stay_small_and_quick(tmp_path):
    values = np.random.default_rng(0).lognormal(-3, 0.5, 100_000)
    values[::5] = np.nan
    figures = {
        "bars": plot_sorted_bars({"all": values}),
        "curve": plot_cumulative({"all": values}),
        "scatter": plot_scatter({"turning": np.arange(100_000.0)}, values),
    }
    for name, figure in figures.items():
        svg, _ = save_figure(figure, tmp_path / name)
        assert svg.stat().st_size < 600_000
        assert "20000 of 100000 runs failed" in svg.read_text()
    assert len(figures["bars"].axes[0].patches) == 0


def test_what_is_counted_and_what_cannot_fail_is_said():
    bars = plot_sorted_bars({"all": [0.1, np.nan]}, counted="cases").axes[0]
    assert bars.get_title(loc="left") == "all: 1 of 2 cases failed"
    assert bars.get_xlabel() == "2 cases, sorted"
    named = plot_sorted_bars({"all": [0.1, np.nan]}, failed="without an ATE").axes[0]
    assert [label.get_text() for label in named.get_yticklabels()][-1] == "without an ATE"
    scatter = plot_scatter({"a": [1, 2]}, [0.5, 0.9], log_y=False, counted="paths", can_fail=False)
    assert scatter.get_suptitle() == "2 paths"
    assert "failed" not in [label.get_text() for label in scatter.axes[0].get_yticklabels()]
