import numpy as np
import pytest

from slamgym.errors import ConfigError
from slamgym.eval.statistics import compare_pairs, proportion_interval
from slamgym.eval.statistics.clustered import clustered_difference, clustered_share


def test_many_paths_of_one_run_each_give_wilsons_interval():
    failed = np.arange(2000) % 4 == 0
    ours, wilson = clustered_share(failed, np.arange(2000)), proportion_interval(500, 2000)
    assert ours.estimate == 0.25
    assert (ours.low, ours.high) == pytest.approx((wilson.low, wilson.high), abs=2e-4)


def test_copies_of_a_run_tell_nothing_new():
    failed = np.array([True, False, False, True, False, False, False, False])
    once = clustered_share(failed, np.arange(8))
    copied = clustered_share(np.repeat(failed, 10), np.repeat(np.arange(8), 10))
    assert (copied.low, copied.high) == pytest.approx((once.low, once.high))


def test_where_all_runs_agree_those_of_a_path_count_as_one():
    none_failed = clustered_share(np.zeros(80, bool), np.repeat(np.arange(8), 10))
    assert none_failed.low == 0
    assert none_failed.high == pytest.approx(clustered_share(np.zeros(8, bool), np.arange(8)).high)


def test_many_pairs_on_a_path_each_give_bonett_and_prices_interval():
    rng = np.random.default_rng(0)
    a, b = rng.random(1000) < 0.3, rng.random(1000) < 0.2
    ours = clustered_difference(a.astype(float) - b, np.arange(1000))
    theirs = compare_pairs(np.ones(1000), np.ones(1000), b, a).success_difference
    assert (ours.estimate, ours.low, ours.high) == pytest.approx((theirs.estimate, theirs.low, theirs.high), abs=2e-3)


def test_pairs_that_all_agree_still_leave_room():
    nothing = clustered_difference(np.zeros(40), np.repeat(np.arange(10), 4))
    # 10 paths and one more for either outcome: the mean is 0, its variance 2 / 12 / 12.
    half = 2.262157 * np.sqrt(2 / 12 / 12)
    assert (nothing.low, nothing.high) == pytest.approx((-half, half), rel=1e-4)


def test_one_path_tells_nothing_of_others():
    for interval in (clustered_share([True, False], ["a", "a"]), clustered_difference([0.5, 1.0], ["a", "a"])):
        assert np.isnan([interval.low, interval.high]).all()


@pytest.mark.parametrize(
    ("values", "groups"), [([], []), ([0.5], ["a", "b"]), ([2.0], ["a"]), ([np.nan], ["a"]), ([[0.5]], [["a"]])]
)
def test_wrong_input_is_refused_in_one_line(values, groups):
    with pytest.raises(ConfigError, match=r"^clustered: expected .*got .*$"):
        clustered_share(values, groups)


@pytest.mark.slow
@pytest.mark.parametrize("alike", [0.05, 0.2, 0.6])
@pytest.mark.parametrize("paths", [6, 12, 40])
def test_intervals_hold_what_they_promise(paths, alike):
    rng = np.random.default_rng(paths)
    p, runs, samples = 0.3, 8, 1000
    groups = np.repeat(np.arange(paths), runs)
    held = np.zeros(2)
    for _ in range(samples):
        of_path = rng.beta(p * (1 - alike) / alike, (1 - p) * (1 - alike) / alike, paths)[:, None]
        a, b = (rng.random((paths, runs)) < of_path for _ in range(2))
        held += (
            p in clustered_share(a.ravel(), groups),
            0.0 in clustered_difference(a.ravel() * 1.0 - b.ravel(), groups),
        )
    assert (held / samples > 0.93).all()
