import numpy as np
import pytest

from slamgym.errors import ConfigError
from slamgym.eval.robustness import (
    Exposure,
    cause_counts,
    evaluated_frames,
    exposure,
    failure_rates,
    find_losses,
    status_counts,
    total_exposure,
)
from slamgym.types import LossContext, LossEvent

NAN = pytest.approx(np.nan, nan_ok=True)


def loss(duration_s, outcome):
    return LossEvent(0, 0, 0.0, duration_s, 0.0, 0.0, outcome)


def test_rates_and_means_of_known_losses():
    # Three losses in 120 s and 30 m, of which 90 s and 24 m were tracked; two relocalised, after 1 and 4 s.
    losses = [loss(1.0, "relocalized"), loss(4.0, "relocalized"), loss(25.0, "never")]
    rates = failure_rates(losses, Exposure(120, 30, 90, 24))
    assert (rates.loss_count, rates.losses_per_minute, rates.losses_per_metre) == pytest.approx((3, 1.5, 0.1))
    assert (rates.mean_time_between_losses_s, rates.mean_distance_between_losses_m) == pytest.approx((30, 8))
    assert (rates.relocalized_count, rates.mean_time_to_relocalize_s) == pytest.approx((2, 2.5))


def test_without_a_loss_the_time_between_them_is_infinite():
    rates = failure_rates([], Exposure(60, 10, 60, 10))
    assert rates == (0, 0, 0, np.inf, np.inf, 0, NAN)


def test_a_slam_that_never_initialised_is_not_free_of_failures():
    assert failure_rates([], Exposure(60, 10, 0, 0)) == (0, NAN, NAN, NAN, NAN, 0, NAN)
    assert failure_rates([], Exposure(0, 0, 0, 0)) == (0, NAN, NAN, NAN, NAN, 0, NAN)


def test_lost_at_once_never_operated():
    rates = failure_rates([loss(60.0, "never")], Exposure(60, 10, 0, 0))
    assert rates == (1, pytest.approx(1), pytest.approx(0.1), 0, 0, 0, NAN)


def test_a_drive_of_no_time_has_no_rate():
    assert failure_rates([loss(0.0, "never")], Exposure(0, 0, 0, 0)) == (1, NAN, NAN, 0, 0, 0, NAN)


def test_a_robot_that_only_turned_has_no_rate_by_distance():
    rates = failure_rates([], Exposure(60, 0, 60, 0))
    assert (rates.losses_per_minute, rates.losses_per_metre) == (0, NAN)
    assert (rates.mean_time_between_losses_s, rates.mean_distance_between_losses_m) == (np.inf, NAN)


def test_two_recorded_runs_together(make_record):
    # 0.1 s and about 0.1 m a frame; "00x00": 4 steps of which 2 are tracked; ".0xx": 3 steps, none tracked.
    records = [make_record("00x00"), make_record(".0xx")]
    drives = [exposure(record.stamps_ns, record.T_world_cam, evaluated_frames(record)) for record in records]
    losses = [event for record in records for event in find_losses(record)]
    rates = failure_rates(losses, total_exposure(drives))
    assert (rates.loss_count, rates.losses_per_minute) == (2, pytest.approx(2 / (0.7 / 60)))
    assert (rates.mean_time_between_losses_s, rates.mean_distance_between_losses_m) == pytest.approx((0.1, 0.1))
    assert (rates.relocalized_count, rates.mean_time_to_relocalize_s) == (1, pytest.approx(0.1))


def test_statuses_are_counted_in_a_fixed_order():
    counts = status_counts(["lost", "ok", "crashed", "ok"])
    assert list(counts.items()) == [("ok", 2), ("lost", 1), ("init_failed", 0), ("crashed", 1), ("timeout", 0)]
    assert sum(status_counts([]).values()) == 0


def test_an_unknown_status_is_refused():
    with pytest.raises(ConfigError, match="did you mean 'crashed'"):
        status_counts(["ok", "crash"])


def test_causes_are_counted_the_most_frequent_first():
    causes = ["dark", "rotation", "unknown", "rotation"]
    losses = [LossEvent(0, 0, 0.0, 0.0, 0.0, 0.0, "never", LossContext(*[0.0] * 14, cause=cause)) for cause in causes]
    assert list(cause_counts([*losses, loss(1.0, "never")]).items()) == [("rotation", 2), ("dark", 1), ("unknown", 1)]
    assert cause_counts([]) == {}
