"""The pictures over many runs: sorted bars, cumulative curves, boxes, scatter plots."""

import numpy as np
import pytest

from slamgym.errors import ConfigError
from slamgym.eval.plots import RankCorrelation, plot_boxes, plot_cumulative, plot_scatter, plot_sorted_bars, save_figure
from slamgym.eval.plots.boxes import quartiles
from slamgym.eval.plots.cumulative import LABEL_STEP, _apart
from slamgym.eval.plots.style import LOST

NAN, INF = np.nan, np.inf
PLOTS = [plot_sorted_bars, plot_cumulative, plot_boxes]
ODD_RUNS = {"one": [0.1], "all failed": [NAN, INF], "none failed": [0.1, 0.2], "exact": [0.0, 0.0], "empty": []}


@pytest.mark.parametrize("plot", PLOTS)
def test_odd_runs_are_drawn_and_their_failures_counted(plot, texts_of):
    texts = " ".join(texts_of(plot(ODD_RUNS)))
    assert "2 of 2 runs failed" in texts or "2 failed" in texts
    assert "1e" not in texts


@pytest.mark.parametrize("plot", PLOTS)
@pytest.mark.parametrize("values", [[NAN], [0.0], []])
def test_one_system_with_hardly_a_run(plot, values, texts_of):
    assert "ATE RMSE (m)" in texts_of(plot({"a": values}))


@pytest.mark.parametrize("plot", PLOTS)
def test_hostile_names_come_out_as_they_are(plot, hostile_names, texts_of):
    texts = "\n".join(texts_of(plot({name: [0.1, NAN] for name in hostile_names}, quantity="a_$_b (m)")))
    short = [name[:3] for name in hostile_names]
    assert all(name in texts for name in short)
    assert "_hidden" in texts
    assert "a_$_b (m)" in texts


@pytest.mark.parametrize("plot", PLOTS)
def test_no_system_at_all_is_refused(plot):
    with pytest.raises(ConfigError, match="at least one"):
        plot({})


def bars(axes):
    return [bar for container in axes.containers for bar in container]


def test_bars_are_sorted_and_failed_ones_hatched_at_the_right_up_to_the_top():
    axes = plot_sorted_bars({"a": [0.3, NAN, 0.1, 0.2]}).axes[0]
    tops = [bar.get_y() + bar.get_height() for bar in bars(axes)]
    assert tops[:3] == pytest.approx([0.1, 0.2, 0.3])
    assert tops[3] == axes.get_ylim()[1]
    assert [bool(bar.get_hatch()) for bar in bars(axes)] == [False, False, False, True]


def test_bars_bear_the_names_of_their_runs():
    axes = plot_sorted_bars({"a": [0.3, NAN, 0.1], "b": [NAN, 0.1, 0.2]}, names=["p", "q", "r"]).axes
    assert [[tick.get_text() for tick in panel.get_xticklabels()] for panel in axes] == [
        ["r", "p", "q"],
        ["q", "r", "p"],
    ]


def test_names_and_values_of_different_number_are_refused():
    with pytest.raises(ConfigError, match=r"expected 3 values of 'a'.*got 2"):
        plot_sorted_bars({"a": [0.1, 0.2]}, names=["p", "q", "r"])


def test_the_threshold_is_named_and_within_the_axis(texts_of):
    figure = plot_sorted_bars({"a": [0.01, 0.02]}, threshold=5.0, gap=(0.5, 50.0))
    assert figure.axes[0].get_ylim()[1] > 50.0
    assert {"failure threshold 5", "gap from 0.5 to 50"} <= set(texts_of(figure))


def test_without_a_threshold_none_is_drawn():
    assert plot_sorted_bars({"a": [0.01, 0.02]}).legends == []


def test_many_runs_have_no_names(texts_of):
    names = [f"n{i}" for i in range(200)]
    assert set(names).isdisjoint(texts_of(plot_sorted_bars({"a": np.arange(1, 201)}, names=names)))


def test_the_cumulative_curve_counts_failures_in_the_total(texts_of):
    # 0.1, 0.2 and 0.4 of five runs: 1/5, 2/5, 3/5.
    figure = plot_cumulative({"a": [0.4, NAN, 0.1, INF, 0.2]})
    line = figure.axes[0].get_lines()[0]
    assert line.get_xdata()[1:-1] == pytest.approx([0.1, 0.2, 0.4])
    assert line.get_ydata() == pytest.approx([0.0, 0.2, 0.4, 0.6, 0.6])
    assert "60 %" in texts_of(figure)


def test_a_cumulative_curve_of_frames_says_so(texts_of):
    texts = texts_of(plot_cumulative({"a": [0.4, NAN, 0.1]}, counted="frames"))
    assert {"share of all frames", "a: 1 of 3 frames failed"} <= set(texts)
    figure = plot_cumulative({"a": [0.4, NAN, 0.1]}, counted="frames", failed="not tracked")
    assert figure.axes[0].get_lines()[0].get_label() == "a: 1 of 3 frames not tracked"


def test_labels_at_the_ends_keep_apart_and_on_the_axis():
    heights = _apart([1.0, 0.0, 1.0, 0.99, 0.01])
    assert np.diff(np.sort(heights)).min() >= LABEL_STEP - 1e-12
    assert heights.min() >= 0.0
    assert heights.max() <= 1.0
    assert _apart([0.2, 0.8]) == pytest.approx([0.2, 0.8])
    # 21 labels have room for steps of 1/20 only.
    assert _apart([1.0] * 21) == pytest.approx(np.linspace(0.0, 1.0, 21), abs=1e-9)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ([1, 2, 3, 4, 5], [1, 2, 3, 4, 5]),
        # Ranks 0, 0.75, 1.5, 2.25, 3 of 1, 2, 3, infinity: 2.25 lies between 3 and infinity.
        ([3, NAN, 1, 2], [1, 1.75, 2.5, INF, INF]),
        ([7], [7, 7, 7, 7, 7]),
        ([NAN, INF], [INF] * 5),
    ],
)
def test_failed_runs_rank_last_in_the_quartiles(values, expected):
    assert quartiles(np.array(values, dtype=float)).tolist() == expected


def test_boxes_show_each_run_once_and_count_them_below(texts_of):
    figure = plot_boxes({"0.2": [0.1, 0.2, NAN], "0.4": [NAN, NAN]}, by="speed (m/s)")
    points = [line for line in figure.axes[0].get_lines() if line.get_marker() in ("o", "x")]
    assert [len(line.get_xdata()) for line in points] == [2, 1, 0, 2]
    texts = texts_of(figure)
    assert {"speed (m/s)", "n = 3", "1 failed", "n = 2", "2 failed"} <= set(texts)


def test_names_that_do_not_fit_below_their_boxes_stand_upright():
    few, many = (plot_boxes({f"a rather long name {i}": [0.1, 0.2] for i in range(n)}) for n in (2, 20))
    (label, *_), (upright, *_) = (figure.axes[0].get_xticklabels() for figure in (few, many))
    assert (label.get_rotation(), upright.get_rotation()) == (0.0, 90.0)
    assert label.get_text() == upright.get_text() == "a rather long name 0\nn = 2\n0 failed"
    assert many.get_figheight() > few.get_figheight()


def test_what_failed_means_is_said_above_the_bars(texts_of):
    assert "failed: lost" in texts_of(plot_sorted_bars({"a": [0.1, NAN]}, failed_when="lost"))


def test_a_scatter_plot_says_what_is_known(texts_of):
    figure = plot_scatter(
        {"speed (m/s)": [1, 2, 3, NAN], "turning (deg/s)": [4, 3, 2, 1]},
        [0.1, NAN, 0.2, 0.3],
        correlations={"speed (m/s)": RankCorrelation(0.5, 3, 0.0456)},
    )
    texts = set(texts_of(figure))
    assert {"speed (m/s)", "turning (deg/s)", "1 of 4 runs failed", "1 without this attribute"} <= texts
    assert "Spearman +0.50, n = 3, corrected p = 0.046" in texts


def test_a_scatter_plot_marks_failed_runs_at_the_upper_edge():
    axes = plot_scatter({"a": [1, 2, 3]}, [0.1, NAN, 0.2]).axes[0]
    good, failed = axes.get_lines()
    assert good.get_ydata() == pytest.approx([0.1, 0.2])
    assert failed.get_xdata() == pytest.approx([2])
    assert failed.get_color() == LOST
    assert max(good.get_ydata()) < failed.get_ydata()[0] < axes.get_ylim()[1]


@pytest.mark.parametrize(
    ("values", "log_y"), [([0.1], False), ([NAN], True), ([NAN], False), ([0.0], True), ([], True)]
)
def test_a_scatter_plot_of_hardly_a_run(values, log_y, hostile_names, texts_of):
    figure = plot_scatter({name: np.arange(len(values)) for name in hostile_names[:2]}, values, log_y=log_y)
    assert "_hidden" in texts_of(figure)


def test_attributes_of_other_runs_are_refused():
    with pytest.raises(ConfigError, match=r"'a'.*\(3,\)"):
        plot_scatter({"a": [1, 2, 3]}, [0.1])


def test_a_p_value_is_never_shown_as_zero(texts_of):
    correlation = RankCorrelation(-0.9, 2, 1e-9)
    assert "Spearman -0.90, n = 2, corrected p < 0.001" in texts_of(
        plot_scatter({"a": [1, 2]}, [0.1, 0.2], correlations={"a": correlation})
    )


def test_the_same_data_give_the_same_svg(tmp_path):
    for plot in PLOTS:
        first, _ = save_figure(plot({"a": [0.1, NAN]}), tmp_path / "first")
        second, _ = save_figure(plot({"a": [0.1, NAN]}), tmp_path / "second")
        assert first.read_bytes() == second.read_bytes()
