import pytest

from slamgym.eval.statistics import Interval
from slamgym.report.wording import confidence, count, listed, number, number_range, percent, percent_range, sentence


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0341, "0.034"),
        (0.97, "0.97"),
        (1.0, "1.0"),
        (12.4, "12"),
        (340.4, "340"),
        (2159.0, "2160"),
        (0.0, "0"),
        (-0.5, "-0.50"),
        (float("nan"), "-"),
        (float("inf"), "infinity"),
        (4e-15, "4e-15"),
        (9.96, "10"),
        (99.7, "100"),
    ],
)
def test_numbers_are_short(value, text):
    assert number(value) == text


@pytest.mark.parametrize(
    ("share", "text"),
    [
        (0.0, "0 %"),
        (1.0, "100 %"),
        (0.123, "12 %"),
        (0.004, "0.4 %"),
        (0.00001, "0.1 %"),
        (0.999, "99.9 %"),
        (0.99999, "99.9 %"),
        (-0.02, "-2 %"),
        (-0.004, "-0.4 %"),
        (float("nan"), "-"),
    ],
)
def test_a_share_is_never_all_or_nothing_unless_it_is(share, text):
    assert percent(share) == text


def test_intervals_and_lists():
    assert percent_range(Interval(0.1, -0.061, 0.0836)) == "-6 to 8 %"
    assert percent_range(Interval(0.0, -0.0001, 0.0001)) == "0 to 0 %"
    assert percent_range(Interval(0.5, 0.003, 0.86)) == "0.3 to 86 %"
    assert number_range(Interval(0.9, 0.81, 1.14)) == "0.81 to 1.1"
    assert number_range(Interval(0.9, 0.81, float("inf"))) == "0.81 or more"
    assert number_range(Interval(0.9, float("-inf"), 1.14)) == "1.1 or less"
    assert confidence(Interval(0.0, 0.0, 0.0)) == "95 % interval"
    assert confidence(Interval(0.0, 0.0, 0.0, 1 - 0.05 / 3)) == "98.3 % interval"
    assert [count(1, "run"), count(31000, "run")] == ["1 run", "31,000 runs"]
    assert [listed([]), listed(["a"]), listed(["a", "b"]), listed(["a", "b", "c"])] == [
        "",
        "a",
        "a and b",
        "a, b and c",
    ]
    assert sentence("half of them") == "Half of them."
