import numpy as np
import pandas as pd
import pytest

from slamgym.errors import ConfigError
from slamgym.eval.statistics import correlations

NAN, INF = np.nan, np.inf


def frame(**columns):
    return pd.DataFrame(columns, dtype=np.float64)


def only_row(x, y):
    return correlations(frame(x=x), frame(y=y)).iloc[0]


def test_five_paths_by_hand():
    # Ranks 1 2 3 4 5 against 1 2 3 5 4: rho = 1 - 6 x 2 / (5 x 24) = 0.9; 9 of 10 pairs in order: tau = (9 - 1) / 10.
    # As extreme are the order itself and four swaps of neighbours, and their reverses: p = 10 / 120 for both.
    row = only_row([0.1, 0.2, 0.3, 0.4, 0.5], [1, 4, 9, 25, 16])
    assert row["n"] == 5
    assert (row["spearman"], row["kendall"]) == pytest.approx((0.9, 0.8))
    assert (row["spearman_p"], row["kendall_p"]) == pytest.approx((10 / 120, 10 / 120))


def test_a_perfect_order_is_never_certain():
    assert only_row(range(5), range(5))["spearman_p"] == pytest.approx(2 / 120)
    row = only_row(range(9), range(9))
    assert row["spearman_p"] == pytest.approx(row["kendall_p"])
    assert row["spearman_p"] == pytest.approx(2 / 362880)


def test_failures_take_the_last_rank():
    assert only_row([1, 2, 3, 4, 5], [1, 4, 9, 25, INF])["spearman"] == pytest.approx(1.0)


def test_nan_is_left_out_of_its_pair_only():
    table = correlations(frame(x=[1, 2, 3, 4, NAN], u=[1, 2, 3, 4, 5]), frame(y=[1, 2, 3, 4, 5]))
    assert table["attribute"].tolist() == ["x", "u"]
    assert table["n"].tolist() == [4, 5]


@pytest.mark.parametrize(
    ("x", "y"),
    [([2, 2, 2, 2], [1, 2, 3, 4]), ([1, 2, 3, 4], [INF] * 4), ([1, 2], [1, 2]), ([], []), ([NAN] * 4, [1] * 4)],
)
def test_what_has_no_order_has_no_correlation(x, y):
    values = only_row(x, y)[["spearman", "spearman_p", "spearman_p_corrected", "kendall", "kendall_p"]]
    assert values.isna().all()


def test_corrections_by_hand():
    # p = 2/120 for the perfect order and 10/120 for the swap, as above; the constant column is no test.
    # Holm: 2 x 2/120, then 1 x 10/120. Benjamini and Hochberg: 2/1 x 2/120, 2/2 x 10/120. Alike for two tests;
    # a third with p = 10/120 again: Holm 3 x 2/120, 2 x 10/120 twice; BH 3 x 2/120, then 3/3 x 10/120 for both.
    attributes = frame(perfect=[1, 2, 3, 4, 5], swap=[1, 2, 3, 5, 4], other=[2, 1, 3, 4, 5], constant=[7] * 5)
    metrics = frame(y=[1, 2, 3, 4, 5])
    holm = correlations(attributes, metrics)
    assert holm["spearman_p_corrected"].iloc[:3].tolist() == pytest.approx([6 / 120, 20 / 120, 20 / 120])
    assert holm["kendall_p_corrected"].iloc[:3].tolist() == pytest.approx([6 / 120, 20 / 120, 20 / 120])
    assert np.isnan(holm["spearman_p_corrected"].iloc[3])
    bh = correlations(attributes, metrics, "fdr_bh")
    assert bh["spearman_p_corrected"].iloc[:3].tolist() == pytest.approx([6 / 120, 10 / 120, 10 / 120])


def test_noise_is_rarely_found_among_many_tests():
    rng = np.random.default_rng(0)
    found = 0
    for _ in range(15):
        table = correlations(pd.DataFrame(rng.normal(size=(15, 5))), pd.DataFrame(rng.normal(size=(15, 4))))
        found += (table["spearman_p_corrected"] < 0.05).any()
        assert (table["spearman_p_corrected"] >= table["spearman_p"]).all()
    # Uncorrected, about 0.6 of such tables have a finding; 15 at 5 % give more than 4 with 0.1 %.
    assert found <= 4


def test_tables_that_do_not_fit_are_refused():
    with pytest.raises(ConfigError, match="same index"):
        correlations(frame(x=[1, 2]), frame(y=[1, 2, 3]))
    with pytest.raises(ConfigError, match="did you mean 'holm'"):
        correlations(frame(x=[1, 2]), frame(y=[1, 2]), "holms")
