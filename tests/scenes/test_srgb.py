import numpy as np
import pytest

from slamgym.scenes.srgb import linear_of_srgb, srgb_of_linear


def test_values_of_the_standard():
    # IEC 61966-2-1: c / 12.92 up to 0.04045, and ((c + 0.055) / 1.055)^2.4.
    assert linear_of_srgb([0.0, 0.04, 0.5, 1.0]) == pytest.approx([0.0, 0.04 / 12.92, 0.21404, 1.0], abs=1e-5)
    assert srgb_of_linear([0.0, 0.003, 0.2, 1.0]) == pytest.approx([0.0, 12.92 * 0.003, 0.4845, 1.0], abs=1e-4)


def test_each_is_the_other_turned_round():
    values = np.linspace(0.0, 1.0, 1001).reshape(7, 11, 13)
    np.testing.assert_allclose(srgb_of_linear(linear_of_srgb(values)), values, atol=1e-6)
    np.testing.assert_allclose(linear_of_srgb(srgb_of_linear(values)), values, atol=1e-6)
