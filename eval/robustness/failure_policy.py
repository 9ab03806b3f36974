"""Averages over runs of which some failed: what is put in the place of a failed one is part of the number."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from slamgym.errors import ConfigError, TrajectoryError, unknown_word
from slamgym.types import BoolArray, FloatArray

POLICIES = ("drop", "penalise", "hold_last_pose")
STATISTICS: dict[str, Callable[[FloatArray], np.floating]] = {"median": np.median, "mean": np.mean}


@dataclass(frozen=True, slots=True)
class Average:
    """A statistic over runs, with what was done about the failed ones; `print` it whole."""

    value: float
    statistic: str
    policy: str
    runs: int
    failed: int
    penalty: float | None = None

    def __str__(self) -> str:
        if not self.failed:
            return f"{self.value:.3g} ({self.statistic} of {self.runs} runs, none failed)"
        if self.policy == "drop":
            kept = self.runs - self.failed
            return f"{self.value:.3g} ({self.statistic} of {kept} of {self.runs} runs; {self.failed} failed, left out)"
        done = f"penalised with {self.penalty:g}" if self.penalty is not None else "held at their last pose"
        return f"{self.value:.3g} ({self.statistic} of {self.runs} runs, {self.failed} failed; {done})"


def average(
    values: FloatArray,
    failed: BoolArray,
    policy: str,
    *,
    penalty: float | None = None,
    held: FloatArray | None = None,
    statistic: str = "median",
) -> Average:
    """Median or mean of the `values` (R,) of R runs, such as their ATE, of which some `failed`, bool (R,).

    policy: "drop" leaves failed runs out, which flatters a SLAM that fails where it is hard; "penalise" puts `penalty`
    in their place, not below the value of any run that did not fail (infinite ranks them last, for medians only);
    "hold_last_pose" puts their values of `held` (R,) there, see `held_ate`. Values of failed runs never count. NaN when
    no run is left.
    Raises ConfigError for unknown words and options that are missing or contradict each other, TrajectoryError for
    shapes that differ and for values that are not finite.
    """
    _check_options(policy, penalty, held, statistic)
    _check_shapes(values, failed, values if held is None else held)
    good, instead = values[~failed], _instead_of_failed(failed, penalty, held)
    if not (np.isfinite(good).all() and (penalty is not None or np.isfinite(instead).all())):
        raise TrajectoryError(
            "average over runs: expected finite values, got NaN or infinity: mark such runs as failed"
        )
    if penalty is not None and len(good) and penalty < good.max():
        raise ConfigError(
            f"expected a penalty worse than every run that did not fail, got {penalty:g}, below {good.max():.3g}"
        )
    chosen = np.concatenate([good, instead])
    value = float(STATISTICS[statistic](chosen)) if len(chosen) else np.nan
    return Average(value, statistic, policy, len(values), int(failed.sum()), penalty)


def _instead_of_failed(failed: BoolArray, penalty: float | None, held: FloatArray | None) -> FloatArray:
    if penalty is not None:
        return np.full(int(failed.sum()), float(penalty))
    return np.empty(0) if held is None else held[failed]


def _check_options(policy: str, penalty: float | None, held: FloatArray | None, statistic: str) -> None:
    if policy not in POLICIES:
        raise ConfigError(unknown_word("failure policy", policy, POLICIES))
    if statistic not in STATISTICS:
        raise ConfigError(unknown_word("statistic", statistic, STATISTICS))
    if (penalty is not None) != (policy == "penalise"):
        raise ConfigError(
            f"expected `penalty` with the policy 'penalise' and only there, got {penalty} with {policy!r}"
        )
    if (held is not None) != (policy == "hold_last_pose"):
        got = "no" if held is None else "some"
        raise ConfigError(
            f"expected `held` values with the policy 'hold_last_pose' and only there, got {got} with {policy!r}"
        )
    if penalty is not None and not (penalty > 0 and (penalty < np.inf or statistic == "median")):
        raise ConfigError(f"expected a penalty above 0, and finite for a mean, got {penalty}")


def _check_shapes(values: FloatArray, failed: BoolArray, held: FloatArray) -> None:
    if values.ndim != 1 or not values.shape == failed.shape == held.shape or failed.dtype != np.bool_:
        got = f"{values.shape}, {failed.dtype} {failed.shape} and {held.shape}"
        raise TrajectoryError(f"average over runs: expected values, bool `failed` and `held` of shape (R,), got {got}")
