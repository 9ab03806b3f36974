"""Tests of `slamgym.eval.statistics.multiple`."""

import numpy as np
import pytest

from slamgym.eval.statistics.multiple import corrected


def test_holm_by_hand():
    # Sorted 0.01, 0.02, 0.04 times 3, 2, 1, each no smaller than the one before.
    assert corrected([0.04, 0.01, np.nan, 0.02]) == pytest.approx([0.04, 0.03, np.nan, 0.04], nan_ok=True)
    assert np.isnan(corrected([np.nan])).all()


def test_benjamini_hochberg_by_hand():
    # Sorted 0.01, 0.02, 0.04 times 3/1, 3/2, 3/3, each no larger than the one after.
    assert corrected([0.04, 0.01, np.nan, 0.02], "fdr_bh") == pytest.approx([0.04, 0.03, np.nan, 0.03], nan_ok=True)
