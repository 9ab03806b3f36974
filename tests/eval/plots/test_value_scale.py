import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from slamgym.errors import ConfigError
from slamgym.eval.plots.style import new_figure
from slamgym.eval.plots.value_scale import as_runs, failed_of, placed, set_value_axis, value_scale

numbers = st.lists(st.one_of(st.floats(1e-12, 1e12), st.sampled_from([0.0, np.nan, np.inf])), max_size=20)


@given(numbers, st.booleans())
def test_every_run_has_a_place_and_failed_ones_are_above_all_others(values, log):
    values = np.array(values)
    scale = value_scale([values], log=log)
    assert scale.low < scale.high < scale.failed < scale.top
    place = placed(values, scale)
    good = np.isfinite(values)
    assert np.all((scale.low <= place[good]) & (place[good] <= scale.high))
    assert np.all(place[~good] == scale.failed)


@settings(max_examples=40)
@given(numbers, st.booleans())
def test_an_axis_has_ticks_and_none_in_the_place_of_the_failed(values, log):
    scale = value_scale([values], log=log)
    axes = new_figure(4.0, 3.0).add_subplot()
    set_value_axis(axes, "y", scale, "ATE (m)", failed=True)
    *ticks, failed = axes.get_yticks()
    assert ticks
    assert failed == scale.failed
    assert np.all((np.array(ticks) >= scale.low) & (np.array(ticks) <= scale.high))


def test_alike_values_do_not_fill_the_axis():
    # 0.10 and 0.11 are 0.04 decades apart, of at least 0.6 that the axis shows.
    scale = value_scale([[0.10, 0.11]])
    assert np.log10(scale.high / scale.low) > 0.6


def test_the_scale_holds_the_values_of_all_systems():
    scale = value_scale([[0.01], [], [np.nan], [10.0]])
    assert scale.low < 0.01
    assert scale.high > 10.0


def test_failures_are_counted():
    assert failed_of(np.array([0.1, np.nan, np.inf, 0.0])) == "2 of 4 runs failed"
    assert failed_of(np.array([])) == "0 of 0 runs failed"


def test_no_system_and_odd_shapes_are_refused():
    with pytest.raises(ConfigError, match="at least one"):
        as_runs({})
    with pytest.raises(ConfigError, match=r"'a'.*\(2, 2\)"):
        as_runs({"a": np.zeros((2, 2))})
