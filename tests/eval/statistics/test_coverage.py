"""How often the 95 % intervals hold the truth, and how often a gap is found where there is one and where there is none.

Quick runs draw 100 samples; the slow ones draw 1,000 and give the shares that the docstrings state.
"""

from itertools import product

import numpy as np
import pytest
from scipy import stats

from slamgym.eval.statistics import (
    bootstrap_interval,
    compare_pairs,
    failure_curve,
    failure_threshold,
    median_interval,
    proportion_interval,
)

SPEEDS = np.array([0.2, 0.4, 0.6, 0.8, 1.0, 1.2])


def median_of(n):
    return lambda rng: (median_interval(rng.lognormal(0.0, 0.8, n)), 1.0)


def mean_normal(rng):
    return bootstrap_interval(rng.normal(3.0, 1.0, 20), "mean"), 3.0


def mean_log_normal(rng):
    return bootstrap_interval(rng.lognormal(0.0, 0.8, 20), "mean"), np.exp(0.8**2 / 2)


def proportion(rng):
    return proportion_interval(rng.binomial(20, 0.3), 20), 0.3


def curve_of_independent_runs(slope, midpoint=0.8, runs=10):
    def draw(rng):
        x = np.repeat(SPEEDS, runs)
        return failure_curve(x, rng.random(len(x)) < 1 / (1 + np.exp(-slope * (x - midpoint)))).midpoint, midpoint

    return draw


def runs_of_paths(rng, paths, repeats):
    """Levels, failures and paths; each path has a limit of its own, around 0.8, and each run shakes it a little."""
    limits = rng.normal(0.8, 0.2, (paths, 1, 1)) + rng.logistic(0.0, 0.05, (paths, len(SPEEDS), repeats))
    x = np.broadcast_to(SPEEDS[:, None], limits.shape)
    path = np.broadcast_to(np.arange(paths)[:, None, None], limits.shape)
    return x.ravel(), (x > limits).ravel(), path.ravel()


def curve_of_grouped_runs(paths, repeats=1):
    def draw(rng):
        x, failed, path = runs_of_paths(rng, paths, repeats)
        return failure_curve(x, failed, path).midpoint, 0.8

    return draw


def pairs(field, truth):
    """30 paths: b is 0.03 further off in the median, or 1.2 times in the geometric mean."""

    def draw(rng):
        shared = rng.lognormal(np.log(0.05), 0.5, 30)
        a, b = shared + 0.2, shared + 0.23 + np.clip(rng.normal(0.0, 0.03, 30), -0.2, 0.2)
        if field == "geometric_mean_ratio":
            a, b = shared, shared * 1.2 * rng.lognormal(0.0, 0.3, 30)
        none = np.zeros(30, dtype=bool)
        return getattr(compare_pairs(a, b, none, none), field), truth

    return draw


def two_groups(rng, good, bad, sigma=(0.4, 0.4)):
    return np.concatenate(
        [rng.lognormal(np.log(0.02), sigma[0], good), rng.lognormal(np.log(0.5), sigma[1], bad)],
    )


def threshold(good, bad, sigma=(0.4, 0.4)):
    truth = np.exp((np.log(0.02) * sigma[1] + np.log(0.5) * sigma[0]) / sum(sigma))

    def draw(rng):
        while not (result := failure_threshold(two_groups(rng, good, bad, sigma))).found:
            pass
        return result.threshold, truth

    return draw


INTERVALS = {
    "median, n = 6": median_of(6),
    "median, n = 10": median_of(10),
    "median, n = 30": median_of(30),
    "mean, normal, n = 20": mean_normal,
    "mean, log-normal, n = 20": mean_log_normal,
    "proportion 0.3, n = 20": proportion,
    "curve, 6 x 10 independent runs, slope 8": curve_of_independent_runs(8.0),
    "curve, 6 x 10 independent runs, slope 3": curve_of_independent_runs(3.0),
    "curve, 6 x 10 independent runs, midpoint near the end": curve_of_independent_runs(8.0, midpoint=1.1),
    "curve, 12 paths x 6": curve_of_grouped_runs(12),
    "curve, 40 paths x 6": curve_of_grouped_runs(40),
    "curve, 12 paths x 6 x 3 repeats": curve_of_grouped_runs(12, repeats=3),
    "pairs, median difference, 30 paths": pairs("median_difference", -0.03),
    "pairs, ratio of geometric means, 30 paths": pairs("geometric_mean_ratio", 1 / 1.2),
    "threshold, 8 + 4": threshold(8, 4),
    "threshold, 15 + 6": threshold(15, 6),
    "threshold, 40 + 20": threshold(40, 20),
    "threshold, 90 + 10": threshold(90, 10),
    "threshold, 40 + 20, wide bad group": threshold(40, 20, (0.3, 0.6)),
}

ONE_GROUP = {
    "log-normal 0.4": lambda rng, n: rng.lognormal(0.0, 0.4, n),
    "log-normal 0.8": lambda rng, n: rng.lognormal(0.0, 0.8, n),
    "uniform": lambda rng, n: rng.uniform(0.0, 1.0, n),
    "exponential": lambda rng, n: rng.exponential(1.0, n),
    "log-uniform": lambda rng, n: np.exp(rng.uniform(0.0, 3.0, n)),
}


def coverage(draw, draws, seed=0):
    rng = np.random.default_rng(seed)
    samples = [draw(rng) for _ in range(draws)]
    return np.mean([truth in interval for interval, truth in samples])


def share_with_gap(draw, draws, seed=0):
    rng = np.random.default_rng(seed)
    return np.mean([failure_threshold(draw(rng)).found for _ in range(draws)])


@pytest.fixture
def tell(capsys):
    """Print a share beside the dots: the docs state it."""

    def tell_share(name, share):
        with capsys.disabled():
            print(f"\n{name}: {100 * share:.1f} %")  # noqa: T201
        return share

    return tell_share


@pytest.mark.parametrize("name", INTERVALS)
def test_intervals_hold_the_truth_roughly(name):
    # 100 draws at 95 % give fewer than 87 hits with a probability below 0.1 %.
    assert coverage(INTERVALS[name], 100) >= 0.87


@pytest.mark.slow
@pytest.mark.parametrize("name", INTERVALS)
def test_intervals_hold_the_truth(name, tell):
    share = tell(f"interval of {name} holds the truth", coverage(INTERVALS[name], 1000, seed=1))
    assert 0.92 <= share <= 0.98


def test_runs_of_one_path_are_not_independent():
    def as_if_independent(rng):
        x, failed, _ = runs_of_paths(rng, 12, 3)
        return failure_curve(x, failed).midpoint, 0.8

    assert coverage(as_if_independent, 100) < 0.75


@pytest.mark.parametrize(("good", "bad"), [(8, 4), (15, 6), (40, 20), (90, 10)])
def test_two_groups_are_told_apart_mostly(good, bad):
    assert share_with_gap(lambda rng: two_groups(rng, good, bad), 50) >= 0.9


@pytest.mark.slow
@pytest.mark.parametrize(("good", "bad"), [(8, 4), (15, 6), (40, 20), (90, 10)])
def test_two_groups_are_told_apart(good, bad, tell):
    share = tell(f"gap found, {good} + {bad}", share_with_gap(lambda rng: two_groups(rng, good, bad), 1000))
    assert share >= 0.97


@pytest.mark.parametrize("n", [12, 30, 100])
@pytest.mark.parametrize("name", ONE_GROUP)
def test_one_group_is_rarely_taken_for_two_roughly(name, n):
    # 50 draws at 5 % give more than 8 hits with a probability below 0.1 %.
    assert share_with_gap(lambda rng: ONE_GROUP[name](rng, n), 50) <= 0.16


@pytest.mark.slow
@pytest.mark.parametrize("n", [12, 30, 100])
@pytest.mark.parametrize("name", ONE_GROUP)
def test_one_group_is_rarely_taken_for_two(name, n, tell):
    share = tell(f"gap seen in one group, {name}, n = {n}", share_with_gap(lambda rng: ONE_GROUP[name](rng, n), 1000))
    # Few values that are spread evenly over the logarithms are the hardest; 1,000 draws are known to 0.7 %.
    assert share <= (0.07 if name == "log-uniform" else 0.05)


@pytest.fixture(scope="module")
def success_differences():
    """Intervals for all numbers of paths, of 30, on which only b failed and only a failed."""
    ones, path = np.ones(30), np.arange(30)
    return {
        (only_b, only_a): compare_pairs(ones, ones, path < only_a, path >= 30 - only_b).success_difference
        for only_b, only_a in product(range(31), repeat=2)
        if only_b + only_a <= 30
    }


@pytest.mark.parametrize(
    ("only_b", "only_a"), [(0.2, 0.05), (0.25, 0.1), (0.1, 0.1), (0.3, 0.0), (0.1, 0.02), (0.3, 0.3)]
)
def test_exact_coverage_of_the_difference_of_success_rates(success_differences, only_b, only_a):
    model = stats.multinomial(30, [only_b, only_a, 1 - only_b - only_a])
    hits = [counts for counts, interval in success_differences.items() if only_b - only_a in interval]
    assert 0.92 <= sum(model.pmf([*counts, 30 - sum(counts)]) for counts in hits) <= 0.98


@pytest.mark.parametrize("share", [0.1, 0.2, 0.3, 0.5, 0.7, 0.9])
def test_exact_coverage_of_a_proportion(share):
    hits = [k for k in range(21) if share in proportion_interval(k, 20)]
    assert 0.92 <= stats.binom.pmf(hits, 20, share).sum() <= 0.98
