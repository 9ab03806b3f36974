"""How often a SLAM fails: per time and distance, over one drive or many."""

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from slamgym.errors import ConfigError, unknown_word
from slamgym.eval.robustness.completion import Exposure
from slamgym.eval.robustness.losses import STATUSES
from slamgym.types import LossEvent


class FailureRates(NamedTuple):
    """See `failure_rates`."""

    loss_count: int
    losses_per_minute: float
    losses_per_metre: float
    mean_time_between_losses_s: float
    mean_distance_between_losses_m: float
    relocalized_count: int
    mean_time_to_relocalize_s: float


def failure_rates(losses: Sequence[LossEvent], drive: Exposure) -> FailureRates:
    """Loss events against the length of their drive; of many drives, all events and the `total_exposure`.

    - `losses_per_minute`, `losses_per_metre`: losses / time and true distance of the whole drive. A SLAM that is lost
      cannot get lost: read them beside completion.
    - `mean_time_between_losses_s`, `mean_distance_between_losses_m`: MTBF = operating time / number of failures, and
      the same of the distance; operating is what was tracked. Infinite without a loss: none was seen in `tracked_s`,
      which is all that can be said.
    - `relocalized_count`: losses that ended in the map of before; `mean_time_to_relocalize_s`: mean duration of these,
      NaN when there is none. The others count in `loss_count` only.

    All rates are NaN where nothing was ever tracked and nothing lost: a SLAM that never started has not been free of
    failures. A rate over no time or distance is NaN, too.
    """
    n = len(losses)
    back_s = [loss.duration_s for loss in losses if loss.outcome == "relocalized"]
    operated = n > 0 or drive.tracked_s > 0
    return FailureRates(
        loss_count=n,
        losses_per_minute=60.0 * n / drive.duration_s if operated and drive.duration_s > 0 else np.nan,
        losses_per_metre=n / drive.distance_m if operated and drive.distance_m > 0 else np.nan,
        mean_time_between_losses_s=_between(drive.tracked_s, n),
        mean_distance_between_losses_m=_between(drive.tracked_m, n),
        relocalized_count=len(back_s),
        mean_time_to_relocalize_s=float(np.mean(back_s)) if back_s else np.nan,
    )


def _between(operated: float, failures: int) -> float:
    if failures:
        return operated / failures
    return np.inf if operated > 0 else np.nan


def cause_counts(losses: Iterable[LossEvent]) -> dict[str, int]:
    """How many losses each cause had, the most frequent first, of those losses that have a context."""
    return dict(Counter(loss.context.cause for loss in losses if loss.context is not None).most_common())


def status_counts(statuses: Iterable[str]) -> dict[str, int]:
    """How many runs ended with each status, all five in the order of STATUSES. Raises ConfigError for another word."""
    counts = Counter(statuses)
    for word in counts:
        if word not in STATUSES:
            raise ConfigError(unknown_word("status", word, STATUSES))
    return {word: counts[word] for word in STATUSES}
