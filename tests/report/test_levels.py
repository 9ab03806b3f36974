import warnings

import numpy as np
import pandas as pd
import pytest

from slamgym.report.levels import find_factors, level_name, tied_names, title_and_unit, with_columns, with_levels


@pytest.mark.parametrize(
    ("value", "name"),
    [
        (True, "on"),
        (np.False_, "off"),
        ("True", "on"),
        (None, "default"),
        (np.nan, "default"),
        (pd.NA, "default"),
        (1.0, "1"),
        (np.int64(3), "3"),
        (0.1, "0.1"),
        ("icl_nuim", "icl_nuim"),
        ({"a": 1}, '{"a": 1}'),
        ("a\x00b", "a�b"),
    ],
)
def test_a_level_has_a_name_for_people(value, name):
    assert level_name(value) == name


@pytest.mark.parametrize(
    ("parameter", "told"),
    [
        ("speed", ("speed", "m/s")),
        ("camera_height", ("camera height", "")),
        ("path_length_m", ("path length", "m")),
        ("slam_timeout_s", ("slam timeout", "s")),
        ("scene_options.texture", ("texture", "")),
        ("a_factor_of_tomorrow", ("a factor of tomorrow", "")),
    ],
)
def test_a_parameter_has_a_name_for_people(parameter, told):
    assert title_and_unit(parameter) == told


def test_levels_come_in_an_order_that_people_expect():
    table = pd.DataFrame(
        {
            "speed": [10.0, 2.0, 0.5, 2.0],
            "turn_rate": [np.nan, 2.0, 1.0, np.nan],
            "loop_closure": [True, None, False, True],
            "slam": ["orbslam3", "opencv", "a", "b"],
            "stride": [0, 0, 0, 0],
        }
    )
    speed, turn_rate, loops, slam = (find_factors(table, [name])[0] for name in table.columns[:4])
    assert speed.levels == ("0.5", "2", "10")
    assert speed.values.tolist() == [0.5, 2.0, 10.0]
    assert turn_rate.levels == ("default", "1", "2")
    assert not turn_rate.is_numeric
    assert loops.levels == ("default", "off", "on")
    assert slam.levels == ("orbslam3", "opencv", "a", "b")
    assert find_factors(table, ["stride", "missing"]) == ()
    with_speed = with_levels(table, [speed])
    assert list(with_speed[speed.column]) == ["10", "2", "0.5", "2"]
    assert list(with_speed[speed.column].cat.categories) == ["0.5", "2", "10"]


def test_factors_that_change_together_are_one():
    table = pd.DataFrame({"stride": [0, 1, 2, 0, 1, 2], "fps": [30, 15, 10, 30, 15, 10], "slam": list("aaabbb")})
    together, slam = find_factors(table, ["stride", "fps", "slam"])
    assert together.names == ("stride", "fps")
    assert together.label == "stride with frame rate (frames left out)"
    assert together.levels == ("0, 30", "1, 15", "2, 10")
    assert together.values.tolist() == [0, 1, 2]
    assert slam.names == ("slam",)


def test_a_factor_that_another_one_tells_belongs_to_it():
    table = pd.DataFrame({"loop_closure": [True, False, True, False], "stride": [0, 1, 2, 3]})
    (together,) = find_factors(table, ["loop_closure", "stride"])
    assert together.levels == ("off, 1", "off, 3", "on, 0", "on, 2")
    assert not together.is_numeric


def test_what_other_rows_tell_apart_is_not_one_factor():
    rows = pd.DataFrame({"stride": [0, 1, 0, 1], "slam": ["a", "b", "b", "a"]})
    diagonal = rows[:2]
    assert len(find_factors(diagonal, list(rows))) == 1
    assert [factor.names for factor in find_factors(diagonal, list(rows), tied_names(rows, list(rows)))] == [
        ("stride",),
        ("slam",),
    ]


def test_a_table_of_many_columns_takes_more_at_once(recwarn):
    wide = pd.DataFrame({"speed": [1.0, 2.0]})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pd.errors.PerformanceWarning)
        for k in range(150):
            wide[f"column {k}"] = k
    speed = find_factors(wide, ["speed"])
    assert list(with_levels(wide, speed)[speed[0].column]) == ["1", "2"]
    replaced = with_columns(wide, {"speed": [3.0, 4.0], "new": [5, 6]})
    assert (replaced["speed"].tolist(), replaced["new"].tolist()) == ([3.0, 4.0], [5, 6])
    assert replaced.columns.is_unique
    assert not recwarn.list


def test_levels_are_told_with_their_unit_or_their_factor():
    table = pd.DataFrame(
        {"speed": [0.5, 0.8], "stride": [2, 3], "loop_closure": [True, False], "turn_rate": [None, 1.0]}
    )
    speed, stride, loops, turn_rate = (find_factors(table, [name])[0] for name in table.columns)
    assert (speed.told("0.8"), speed.at("0.8")) == ("0.8 m/s", "at 0.8 m/s")
    assert (stride.told("2"), stride.at("2")) == ("stride 2", "with stride 2")
    assert loops.at("on") == "with loop closing on"
    assert turn_rate.told("default") == "turn rate default"


def test_of_many_levels_some_are_shown_with_both_ends():
    (factor,) = find_factors(pd.DataFrame({"speed": np.arange(100.0)}), ["speed"])
    assert len(factor.shown) == 6
    assert (factor.shown[0], factor.shown[-1]) == ("0", "99")
