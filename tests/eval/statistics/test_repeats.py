import numpy as np
import pandas as pd
import pytest

from slamgym.errors import ConfigError
from slamgym.eval.statistics import median_over_repeats

NAN, INF = np.nan, np.inf


def table(**columns):
    return pd.DataFrame(columns)


def test_one_row_a_path():
    runs = table(path=["b", "a", "b", "a", "b"], ate=[0.4, 0.1, 0.2, 0.3, 0.3], rpe=[1.0, 2.0, 3.0, 4.0, 5.0])
    expected = table(path=["a", "b"], ate=[0.2, 0.3], rpe=[3.0, 3.0], runs=[2, 3], failures=[0, 0])
    pd.testing.assert_frame_equal(median_over_repeats(runs, ["path"], ["ate", "rpe"]), expected)


def test_failures_count_as_the_worst_values():
    # 1 of 3 failed: median of 0.1, 0.2, inf. 2 of 4 failed: halfway between 0.2 and inf. All failed.
    runs = table(path=[1] * 3 + [2] * 4 + [3] * 2, ate=[0.1, NAN, 0.2, 0.1, 0.2, NAN, INF, NAN, NAN])
    expected = table(path=[1, 2, 3], ate=[0.2, INF, INF], runs=[3, 4, 2], failures=[1, 2, 2])
    pd.testing.assert_frame_equal(median_over_repeats(runs, ["path"], ["ate"]), expected)


def test_a_lost_run_counts_as_failed_however_good_the_rest_of_it():
    runs = table(path=[1, 1, 1], ate=[0.01, 0.2, 0.3], success=[False, True, True])
    row = median_over_repeats(runs, ["path"], ["ate"], failed=~runs["success"]).iloc[0]
    assert (row["ate"], row["failures"]) == (0.3, 1)
    assert runs["ate"].tolist() == [0.01, 0.2, 0.3]


def test_a_run_that_lacks_one_value_lacks_all():
    runs = table(path=[1, 1, 1], ate=[0.1, 0.2, 0.3], rpe=[NAN, 0.2, 0.3])
    assert median_over_repeats(runs, ["path"], ["ate", "rpe"])["ate"].tolist() == [0.3]


def test_levels_of_a_path_stay_apart_and_a_missing_level_is_one_too():
    runs = table(path=[1, 1, 1, 1], speed=[0.2, 0.4, NAN, 0.2], ate=[0.1, 0.2, 0.3, 0.3])
    medians = median_over_repeats(runs, ["path", "speed"], ["ate"])
    assert medians["ate"].tolist() == [0.2, 0.2, 0.3]
    assert medians["runs"].tolist() == [2, 1, 1]


def test_an_empty_table_has_no_path():
    medians = median_over_repeats(table(path=[], ate=[]), ["path"], ["ate"])
    assert list(medians.columns) == ["path", "ate", "runs", "failures"]
    assert medians.empty


def test_a_missing_column_is_named():
    with pytest.raises(ConfigError, match=r"expected the columns \['ate'\], got \['path'\]"):
        median_over_repeats(table(path=[1]), ["path"], ["ate"])


def test_what_would_be_overwritten_or_is_no_flag_is_refused():
    runs = table(path=[1, 1], ate=[0.1, 0.2], runs=[3, 4])
    with pytest.raises(ConfigError, match=r"other columns than \['runs'\]"):
        median_over_repeats(runs, ["path"], ["runs"])
    for failed in ([True], [-1, -2], ["False", "False"]):
        with pytest.raises(ConfigError, match="expected `failed` as bool"):
            median_over_repeats(runs, ["path"], ["ate"], failed=failed)
