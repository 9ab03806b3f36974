from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from slamgym.eval.statistics import Interval
from slamgym.report.judged import judged_runs
from slamgym.report.pairs import difference_text, furthest, ratio_text
from slamgym.report.shares import FEWEST_PATHS, MOST_CURVE_RUNS, _some_paths, compare_levels, failure_trend
from slamgym.study.results import StudyResults
from tests.report.varied_study import varied_study


def study_of(rows, factors):
    """rows: path, repeat, levels of the factors, success, ATE."""
    table = pd.DataFrame(rows, columns=["path", "repeat", *factors, "success", "ate_rmse_m"])
    table = table.assign(dataset="made", status=np.where(table["success"], "ok", "lost"))
    return judged_runs(StudyResults(None, "made", "", tuple(factors), len(table), table))


def test_levels_are_compared_on_the_same_paths_only():
    rows = [
        ("p1", 1, "off", True, 0.1),
        ("p1", 1, "on", True, 0.2),
        ("p2", 1, "off", False, 0.1),
        ("p2", 1, "on", True, 0.2),
    ]
    rows += [("only off", 1, "off", False, 0.1), ("only on", 1, "on", True, 0.1)]
    judged = study_of(rows, ["loop"])
    (compared,) = compare_levels(judged, judged.factors[0])
    assert (compared.base, compared.level, compared.paths, compared.pairs) == ("off", "on", 2, 2)
    assert (compared.base_failed, compared.failed, compared.base_runs, compared.runs) == (1, 0, 2, 2)
    assert compared.difference.estimate == -0.5
    assert compared.both_paths == 1
    assert compared.ratio.estimate == pytest.approx(2.0)
    assert np.isnan([compared.ratio.low, compared.ratio.high]).all()  # too few paths for an interval


def test_levels_are_compared_at_the_same_levels_of_the_other_factors():
    # At stride 1 everything fails, and loop closing was tried there alone: no level may be blamed for the other's.
    rows = [(f"p{k}", 1, 0, "off", True, 0.1) for k in range(8)] + [(f"p{k}", 1, 1, "on", False, 0.1) for k in range(8)]
    rows += [(f"p{k}", 1, 1, "off", False, 0.1) for k in range(8)]
    judged = study_of(rows, ["stride", "loop"])
    stride, loop = judged.factors
    assert compare_levels(judged, loop)[0].difference.estimate == 0
    assert compare_levels(judged, stride)[0].difference.estimate == 1


def test_repeats_are_brought_together_with_failed_ones_last():
    ates = [0.1, 0.2, 0.9]
    rows = [("p1", r, "off", r < 2, ate) for r, ate in enumerate(ates)]
    rows += [("p1", r, "on", True, ate) for r, ate in enumerate(ates)]
    judged = study_of(rows, ["loop"])
    # off: 0.1, 0.2 and a failure: their median is 0.2, as it is on. The share that failed is 1 / 3.
    (compared,) = compare_levels(judged, judged.factors[0])
    assert compared.ratio.estimate == 1
    assert compared.difference.estimate == pytest.approx(-1 / 3)


@pytest.mark.parametrize(("failures_on", "word"), [(12, "more failures with loop on"), (2, "no difference seen")])
def test_a_difference_is_told_where_the_interval_holds_no_zero(failures_on, word):
    rows = [
        (f"p{k}", 1, level, not (level == "on" and k < failures_on), 0.1) for k in range(20) for level in ("off", "on")
    ]
    judged = study_of(rows, ["loop"])
    (compared,) = compare_levels(judged, judged.factors[0])
    assert word in difference_text(compared)
    assert f"with loop on, {failures_on} of 20 runs failed; with loop off, 0 of 20" in difference_text(compared)


def test_a_difference_that_depends_on_another_factor_says_so():
    levels = [(0, "off"), (0, "on"), (1, "off"), (1, "on")]
    rows = [(f"p{k}", 1, *level, level != (1, "on"), 0.1) for k in range(12) for level in levels]
    judged = study_of(rows, ["stride", "loop"])
    (compared,) = compare_levels(judged, judged.factors[0])
    text = difference_text(compared)
    assert "with stride 0, 0 of 24, over all levels of the other factors (difference 50 percentage points" in text
    assert text.endswith("; it depends on the loop")
    same_everywhere = [(*row[:4], row[2] == 0, 0.1) for row in rows]
    judged = study_of(same_everywhere, ["stride", "loop"])
    (compared,) = compare_levels(judged, judged.factors[0])
    assert compared.depends_on == ()


def test_intervals_that_hold_together_tell_their_own_confidence():
    rows = [(f"p{k}", 1, speed, k > 2, 0.1 * speed) for k in range(12) for speed in (1, 2, 3, 4)]
    judged = study_of(rows, ["speed"])
    compared = compare_levels(judged, judged.factors[0])
    assert "no difference seen that could not be chance with 12 paths" in difference_text(compared[0])
    assert "98.3 % interval" in difference_text(compared[0])
    assert "98.3 % interval" in ratio_text(compared[0])


def test_few_paths_tell_nothing_of_others():
    rows = [(f"p{k}", 1, level, level == "off", 0.1) for k in range(4) for level in ("off", "on")]
    judged = study_of(rows, ["loop"])
    (compared,) = compare_levels(judged, judged.factors[0])
    assert difference_text(compared).endswith("too few paths (4) to tell whether that would hold for others")
    assert ratio_text(compared).startswith("too few paths where runs with loop on and with loop off both succeeded (0)")


def test_the_accuracy_is_compared_as_far_as_runs_succeed():
    rng = np.random.default_rng(0)
    noise = rng.lognormal(0, 0.1, (10, 3))
    rows = [
        (f"p{k}", 1, speed, speed < 3 or k < 2, 0.01 * speed * noise[k, i])
        for k in range(10)
        for i, speed in enumerate((1, 2, 3))
    ]
    judged = study_of(rows, ["speed"])
    (told,) = furthest(compare_levels(judged, judged.factors[0]))
    assert told.level == "2"
    text = ratio_text(told)
    assert text.startswith("the ATE at 2 m/s is ")
    assert text.count("at 1 m/s") == 1
    assert 1.8 < told.ratio.estimate < 2.2


def test_a_trend_rises_or_falls_as_the_runs_do():
    rising = judged_runs(varied_study({"speed": [0.4, 0.8, 1.2, 1.6]}, paths=12))
    trend = failure_trend(rising, rising.factors[0])
    assert trend.rising
    assert trend.is_seen
    assert trend.midpoint_is_known
    assert 1.0 in trend.curve.midpoint
    falling = judged_runs(varied_study({"speed": [0.4, 0.8, 1.2, 1.6]}, paths=12, slope=-6.0))
    trend = failure_trend(falling, falling.factors[0])
    assert not trend.rising
    assert trend.is_seen
    assert 1.0 in trend.curve.midpoint
    no_factor = judged_runs(varied_study({"stride": [0, 1, 2, 3]}, paths=12))
    assert not failure_trend(no_factor, no_factor.factors[0]).is_seen


def test_of_very_many_runs_whole_paths_are_drawn():
    table = pd.DataFrame({"place": np.repeat([f"p{k}" for k in range(2000)], 10), "failed": False})
    drawn = _some_paths(table)
    assert len(drawn) == MOST_CURVE_RUNS
    assert (drawn.groupby("place").size() == 10).all()
    assert len(_some_paths(table.assign(place="one"))) == 2 * MOST_CURVE_RUNS


def test_the_ratio_of_the_accuracy_counts_each_path_once():
    # Three pairs of one path where the ATE is 8 times as large, one pair each of two others where it is as large.
    rows = [("p0", 1, stride, level, True, ate) for stride in range(3) for level, ate in (("off", 0.1), ("on", 0.8))]
    rows += [(path, 1, 0, level, True, 0.1) for path in ("p1", "p2") for level in ("off", "on")]
    judged = study_of(rows, ["stride", "loop"])
    (compared,) = compare_levels(judged, judged.factors[1])
    assert compared.both_paths == 3
    assert compared.ratio.estimate == pytest.approx(2.0)  # the cube root of 8 * 1 * 1


def test_a_trend_takes_so_many_paths():
    made = judged_runs(varied_study({"speed": [0.2, 0.6, 1.4, 1.8]}, paths=FEWEST_PATHS, repeats=6, slope=12.0))
    trend = failure_trend(made, made.factors[0])
    assert trend.is_seen
    assert not replace(trend, paths=FEWEST_PATHS - 1).changes


@pytest.mark.parametrize(("paths", "differs"), [(FEWEST_PATHS - 1, False), (FEWEST_PATHS, True)])
def test_a_ratio_takes_so_many_paths(paths, differs):
    rows = [(f"p{k}", 1, level, True, ate) for k in range(paths) for level, ate in (("off", 0.1), ("on", 0.3))]
    judged = study_of(rows, ["loop"])
    (compared,) = compare_levels(judged, judged.factors[0])
    assert compared.ratio_differs is differs


def test_the_midpoint_ends_where_levels_end():
    made = judged_runs(varied_study({"speed": [0.4, 0.8, 1.2, 1.6]}, paths=12))
    trend = failure_trend(made, made.factors[0])

    def ends(low, high):
        moved = replace(trend, curve=replace(trend.curve, midpoint=Interval(1.0, low, high)))
        return moved.midpoint.low, moved.midpoint.high

    assert ends(0.4, 1.6) == (0.4, 1.6)
    assert ends(0.39, 1.61) == (-np.inf, np.inf)
