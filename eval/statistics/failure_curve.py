"""At which speed, stride or noise do half of the runs fail?

The model is logistic: P(failure) = 1 / (1 + exp(-slope (x - midpoint))), with a probability that does not fall as the
factor rises (or does not rise, when asked). Each point on the line of midpoints, infinity included, is an angle: with
the factor standardised to z, the exponent is r (z cos(angle) - sin(angle)) with a steepness r >= 0 and an angle in
[-pi/2, pi/2], whose midpoint is tan(angle). The ends of the range are the models without a trend. Likelihoods of
logistic models are concave, so the angles whose likelihood is high enough always make up one interval.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import statsmodels.api as sm
from numpy.typing import ArrayLike
from scipy import optimize, stats
from scipy.special import expit, log_expit

from slamgym.errors import ConfigError
from slamgym.eval.statistics.intervals import Interval, check_confidence, checked_flags
from slamgym.types import BoolArray, FloatArray, IntArray

_RIGHT = math.pi / 2
_LOG_2 = math.log(2)


@dataclass(frozen=True, slots=True)
class FailureCurve:
    """Share of runs that fail as a function of one factor.

    midpoint: the factor at which half of the runs fail, in the factor's unit. The estimate is NaN when failures show no
    trend (all, none, or not in the expected direction); an end is infinite where the data do not bound it.
    slope: change of the log odds of failure per unit of the factor, negative when failures fall with it; infinite when
    one level parts all successes from all failures; NaN without a trend.
    design_effect: how many times wider than for independent runs the variance of the midpoint was taken to be.
    """

    midpoint: Interval
    slope: float
    runs: int
    failures: int
    design_effect: float

    def probability(self, factor: ArrayLike) -> FloatArray:
        """Share of runs that fail at these values of the factor, any shape; without a trend the overall share."""
        offset = np.asarray(factor, dtype=np.float64) - self.midpoint.estimate
        if np.isnan(self.midpoint.estimate):
            return np.full_like(offset, self.failures / self.runs)
        exponent = np.multiply(self.slope, offset, where=offset != 0, out=np.zeros_like(offset))
        return expit(exponent)

    @property
    def verdict(self) -> str:
        """What the data say of the midpoint, in one sentence."""
        share = f"{self.failures} of {self.runs} runs failed"
        level = f"{100 * self.midpoint.confidence:g} % interval"
        if self.midpoint.is_bounded and not np.isnan(self.midpoint.estimate):
            return f"half of the runs fail at {self.midpoint}; {share}"
        if np.isinf([self.midpoint.low, self.midpoint.high]).all():
            return f"the runs do not tell where half of them fail; {share}"
        return f"half of the runs fail at {self.midpoint.range_text} ({level}, one end open); {share}"


def failure_curve(
    factor: ArrayLike,
    failed: ArrayLike,
    groups: ArrayLike | None = None,
    confidence: float = 0.95,
    rising: bool = True,
) -> FailureCurve:
    """Logistic curve through runs at levels `factor` (n,), in any unit, that `failed` (n,) or not.

    groups: the path of each run (n,), any labels. Runs of one path succeed and fail together, so they tell less than as
    many independent runs would. rising: whether failures are expected to become more as the factor rises (speed), not
    fewer (frame rate).

    The interval of the midpoint holds all midpoints that a likelihood ratio test does not refuse, which also works
    when one level parts all successes from all failures, as often happens. With groups the test statistic is divided
    by the design effect, the cluster-robust variance of the midpoint over that of independent runs, at least 1 (Rao
    and Scott, "On chi-squared tests for multiway contingency tables", 1984), and follows F(1, groups - 1); where there
    is no slope to compute it from, it is the mean size of the groups, as if runs of a path were copies of one. At 95 %
    the interval holds 93 to 97 % for 60 independent runs at 6 levels and for 12 paths or more at 6 levels each; with 6
    paths it holds more, and without the groups about 80 %. Raises ConfigError.
    """
    x, failures = _checked(factor, failed, confidence)
    center, spread = float(x.mean()), float(x.std()) or 1.0
    direction = 1.0 if rising else -1.0
    z = direction * (x - center) / spread
    fit = _fit(z, failures)
    labels = None if groups is None else _labels(groups, len(x))
    effect = 1.0 if labels is None else _design_effect(z, failures, labels, fit)
    ends = _angles(z, failures, fit, effect * _quantile(labels, confidence))
    low, high = sorted(_midpoint(angle, center, direction * spread) for angle in ends)
    estimate = _midpoint(fit.angle, center, direction * spread) if fit.has_trend else np.nan
    return FailureCurve(
        midpoint=Interval(estimate, low, high, confidence),
        slope=direction * fit.steepness / spread,
        runs=len(x),
        failures=int(failures.sum()),
        design_effect=effect,
    )


def _midpoint(angle: float, center: float, spread: float) -> float:
    if abs(angle) == _RIGHT:
        return float(np.copysign(np.inf, angle * spread))
    return float(center + spread * np.tan(angle))


class _Fit(NamedTuple):
    """The most likely model: its angle, its slope (infinite where a level parts the outcomes, NaN without a trend)."""

    angle: float
    steepness: float

    @property
    def has_trend(self) -> bool:
        return not np.isnan(self.steepness)

    @property
    def is_regular(self) -> bool:
        return bool(np.isfinite(self.steepness))


def _fit(z: FloatArray, failed: BoolArray) -> _Fit:
    # The likelihood is concave, so its slope at 0 has the sign of the best one. Equal shares leave rounding errors.
    if z @ failed < 1e-9:
        return _Fit(_RIGHT if failed.mean() < 0.5 else -_RIGHT, np.nan)
    gap = z[~failed].max(), z[failed].min()
    if gap[0] <= gap[1]:
        return _Fit(_angle_in_gap(z, failed, *gap), np.inf)
    intercept, slope = _glm(z, failed).fit().params
    return _Fit(float(np.arctan(-intercept / slope)), float(slope))


def _angle_in_gap(z: FloatArray, failed: BoolArray, below: float, above: float) -> float:
    """The middle of the gap; where one level has both outcomes, just beside it, as the share that failed there says."""
    share = failed[z == below].mean() if below == above else 0.5
    return float(np.arctan((below + above) / 2 + 1e-6 * np.sign(0.5 - share)))


def _glm(z: FloatArray, failed: BoolArray) -> sm.GLM:
    return sm.GLM(failed.astype(np.float64), sm.add_constant(z), family=sm.families.Binomial())


def _design_effect(z: FloatArray, failed: BoolArray, labels: IntArray, fit: _Fit) -> float:
    groups = len(np.unique(labels))
    if not fit.is_regular or groups == 1:
        return len(labels) / groups
    model = _glm(z, failed).fit()
    clustered = _glm(z, failed).fit(cov_type="cluster", cov_kwds={"groups": labels})
    intercept, slope = model.params
    gradient = np.array([-1 / slope, intercept / slope**2])  # of the midpoint, -intercept / slope
    ratio = (gradient @ clustered.cov_params() @ gradient) / (gradient @ model.cov_params() @ gradient)
    return max(1.0, float(ratio))


def _quantile(labels: IntArray | None, confidence: float) -> float:
    """What the test statistic exceeds by chance; infinite for one group, which tells nothing of other ones."""
    if labels is None:
        return float(stats.chi2.ppf(confidence, 1))
    groups = len(np.unique(labels))
    return float(stats.f.ppf(confidence, 1, groups - 1)) if groups > 1 else np.inf


def _angles(z: FloatArray, failed: BoolArray, fit: _Fit, allowed: float) -> tuple[float, float]:
    """Ends of the angles whose log-likelihood is at most half of `allowed` below the best."""
    best = _log_likelihood(fit.angle, z, failed)

    def excess(angle: float) -> float:
        return 2 * (best - _log_likelihood(angle, z, failed)) - allowed

    def end(outer: float) -> float:
        return outer if excess(outer) <= 0 else float(optimize.brentq(excess, outer, fit.angle))

    return end(-_RIGHT), end(_RIGHT)


def _log_likelihood(angle: float, z: FloatArray, failed: BoolArray) -> float:
    """Of the best steepness r >= 0 at this angle."""
    towards = np.where(failed, 1.0, -1.0) * (z * np.cos(angle) - np.sin(angle))
    if towards.sum() <= 0:
        return -len(z) * _LOG_2
    if (towards >= 0).all():
        return -np.count_nonzero(towards == 0) * _LOG_2
    steep = 1.0
    while _gradient(steep, towards) > 0:
        steep *= 2
    r = optimize.brentq(_gradient, 0.0, steep, args=(towards,))
    return float(log_expit(r * towards).sum())


def _gradient(r: float, towards: FloatArray) -> float:
    return float(towards @ expit(-r * towards))


def _labels(groups: ArrayLike, n: int) -> IntArray:
    labels = np.asarray(groups)
    if labels.shape != (n,):
        raise ConfigError(f"failure curve: expected one group for each of {n} runs, got shape {labels.shape}")
    return np.unique(labels, return_inverse=True)[1].astype(np.int64)


def _checked(factor: ArrayLike, failed: ArrayLike, confidence: float) -> tuple[FloatArray, BoolArray]:
    check_confidence(confidence)
    x = np.asarray(factor, dtype=np.float64)
    if x.ndim != 1 or not len(x):
        raise ConfigError(f"failure curve: expected levels of a factor (n,), n of 1 or more, got shape {x.shape}")
    failures = checked_flags(failed, len(x))
    if not np.isfinite(x).all():
        raise ConfigError(
            "failure curve: expected finite levels of the factor, got NaN or infinity; leave such runs out"
        )
    return x, failures
