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


def test_the_added_pairs_are_as_large_as_the_changes_seen():
    graded = clustered_difference([0.2, 0.0, -0.1, 0.2, 0.0], np.arange(5))
    # Outcomes of one size: as wide as for -1, 0 and 1, times that size.
    signs = np.tile([1.0, 0.0, -1.0, 1.0, 0.0], 4)
    outcomes = clustered_difference(signs, np.arange(20))
    scaled = clustered_difference(0.3 * signs, np.arange(20))
    assert (scaled.low, scaled.high) == pytest.approx((0.3 * outcomes.low, 0.3 * outcomes.high))
    # By hand: n = 4 (5 paths, 5 / 4 as wide), sum of squares 0.09 of 5, that of the added pairs 2 * 0.09 / 3.
    center = 4 * 0.06 / 6
    half = 2.776445 * np.sqrt(((4 * 0.018 + 2 * 0.03) / 6 - center**2) / 6)
    assert (graded.low, graded.high) == pytest.approx((center - half, center + half), rel=1e-5)


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


@pytest.mark.slow
@pytest.mark.parametrize("repeats", [1, 3, 6])
@pytest.mark.parametrize("paths", [6, 12, 40])
def test_the_interval_of_graded_differences_holds_what_it_promises(paths, repeats):
    rng = np.random.default_rng(paths)
    held, widths, samples = 0, [], 1000
    for _ in range(samples):
        before = 0.6 * rng.beta(0.5, 0.5, paths)
        old, new = (rng.binomial(repeats, p, paths) / repeats for p in (before, before + 0.3))
        interval = clustered_difference(new - old, np.arange(paths))
        held += interval.low <= 0.3 <= interval.high
        widths.append(interval.high - interval.low)
    assert held / samples > 0.93
    # Graded shares tell more than single outcomes: two pairs of size 1 would make 6 paths as wide as 1.1.
    assert repeats < 6 or np.mean(widths) < {6: 0.7, 12: 0.4, 40: 0.2}[paths]


@pytest.mark.slow
@pytest.mark.parametrize("alike", [(0.05, 0.95), (0.1, 0.9)])
@pytest.mark.parametrize("paths", [6, 12, 30])
def test_a_share_of_few_failures_on_few_paths_holds_less(paths, alike):
    rng, held, samples = np.random.default_rng(paths), 0, 1000
    groups = np.repeat(np.arange(paths), 24)
    for _ in range(samples):
        failed = rng.random((paths, 24)) < rng.beta(*alike, paths)[:, None]
        interval = clustered_share(failed.ravel(), groups)
        held += interval.low <= alike[0] / sum(alike) <= interval.high
    assert held / samples > 0.8
