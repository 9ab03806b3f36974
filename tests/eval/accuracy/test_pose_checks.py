import numpy as np
import pytest

from slamgym.errors import TrajectoryError
from slamgym.eval.accuracy import absolute_errors


def stretched(factor):
    """A good pose and one whose rotation part R is stretched: R^T R is off 1 by factor^2 - 1, about 2 (factor - 1)."""
    return np.array([np.eye(4), np.diag([factor, factor, factor, 1.0])])


def test_digits_that_a_file_cuts_off_are_no_fault():
    # 2 * 4e-5 = 8e-5.
    trans, _ = absolute_errors(stretched(1.0), stretched(1 + 4e-5))
    np.testing.assert_array_equal(trans, [0.0, 0.0])


@pytest.mark.parametrize("factor", [1 + 1e-4, 1 - 1e-4])
def test_a_scale_of_a_ten_thousandth_is_none_of_them(factor):
    # 2 * 1e-4 = 2e-4.
    with pytest.raises(TrajectoryError, match=r"estimate: expected rigid poses, .* in pose 1: is there a scale in it"):
        absolute_errors(stretched(1.0), stretched(factor))
