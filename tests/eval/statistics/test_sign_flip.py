import numpy as np
import pytest

from slamgym.errors import ConfigError
from slamgym.eval.statistics.sign_flip import sign_flip_p


def test_by_hand():
    # Of the 8 signs of 1, 2, 3 only +++ and --- have a mean as far from 0; for 1, 2, -3 all signs do.
    assert sign_flip_p([1.0, 2.0, 3.0]) == pytest.approx(2 / 8)
    assert sign_flip_p([1.0, 2.0, -3.0]) == pytest.approx(1.0)
    assert sign_flip_p([-1.0] * 8) == pytest.approx(2 / 2**8)
    assert sign_flip_p([0.0, 0.0]) == 1.0
    assert sign_flip_p([0.7]) == 1.0


def test_zeros_carry_no_weight():
    assert sign_flip_p([1.0, 2.0, 3.0, 0.0, 0.0]) == pytest.approx(sign_flip_p([1.0, 2.0, 3.0]))


def test_many_paths_are_drawn_at_random_and_the_same_each_time():
    values = np.random.default_rng(1).normal(0.4, 1.0, 60)
    p = sign_flip_p(values)
    assert p == sign_flip_p(values)
    assert 0.0002 <= p < 0.05
    assert sign_flip_p(values + 2) == pytest.approx(2 / 10_000)


def test_without_a_difference_it_is_below_5_percent_in_5_percent():
    rng = np.random.default_rng(7)
    below = [sign_flip_p(rng.exponential(1.0, 9) * rng.choice([-1, 1], 9)) < 0.05 for _ in range(400)]
    assert 0.02 < np.mean(below) < 0.08


@pytest.mark.parametrize("bad", [[], [[1.0]], [np.nan], [np.inf]])
def test_bad_input(bad):
    with pytest.raises(ConfigError, match="expected finite differences"):
        sign_flip_p(bad)
