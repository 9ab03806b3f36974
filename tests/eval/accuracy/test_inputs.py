import numpy as np
import pytest

from slamgym.eval.accuracy import absolute_errors, align, ate, rpe, rpe_all_steps, rpe_pooled, segment_drift

TRACKED, STAMPS = np.arange(20) % 5 > 0, np.arange(20, dtype=np.int64) * 100_000_000


@pytest.mark.parametrize(
    "call",
    [
        absolute_errors,
        lambda ref, est: align(ref, est, "sim3").apply(est),
        lambda ref, est: align(ref, est, "none").apply(est),
        ate,
        lambda ref, est: rpe(ref, est, 2, tracked=TRACKED),
        lambda ref, est: rpe(ref, est, 0.2, "seconds", stamps_ns=STAMPS),
        lambda ref, est: rpe_all_steps(ref, est, TRACKED),
        rpe_pooled,
        segment_drift,
    ],
)
def test_nothing_that_is_given_changes(call, random_pair):
    arrays = (*random_pair(0, 20), TRACKED, STAMPS)
    before = [array.copy() for array in arrays]
    call(*arrays[:2])
    for array, copy in zip(arrays, before, strict=True):
        np.testing.assert_array_equal(array, copy)
