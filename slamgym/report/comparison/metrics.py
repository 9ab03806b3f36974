"""What two studies are compared by."""

from dataclasses import dataclass
from typing import Literal

from slamgym.report.wording import percent

SHARES = ("success", "completion")
"""Metrics from 0 to 1."""


@dataclass(frozen=True, slots=True)
class Metric:
    """A column of the table of runs.

    name: of the column. label: with its unit. better: which values are. change: how two values are set against each
    other, by their difference or by their ratio. tolerance: a change for the worse up to here is no regression, in the
    unit of the difference or as a share of the baseline's value; None: the metric is told and never a regression.
    """

    name: str
    label: str
    better: Literal["higher", "lower"]
    change: Literal["difference", "ratio"]
    tolerance: float | None = None

    @property
    def worse_sign(self) -> float:
        """1 where a rise is for the worse, else -1."""
        return 1.0 if self.better == "lower" else -1.0

    @property
    def name_text(self) -> str:
        """The label without its unit."""
        return self.label.partition(" (")[0]

    def value_text(self, value: float) -> str:
        """A value with its unit: "94 %", "0.0297 m"."""
        unit = self.label.partition(" (")[2].removesuffix(")")
        return percent(value) if self.name in SHARES else f"{value:.3g} {unit}".rstrip()

    @property
    def tolerance_text(self) -> str:
        return "none" if self.tolerance is None else f"{100 * self.tolerance:g} {self.unit_text}"

    @property
    def unit_text(self) -> str:
        """What a change is counted in, times 100; "" where it is in the metric's own unit."""
        return "%" if self.change == "ratio" else "points" if self.name in SHARES else ""


SUCCESS = Metric("success", "success rate", "higher", "difference", 0.05)
ATE = Metric("ate_rmse_m", "ATE RMSE (m)", "lower", "ratio", 0.10)
TIME = Metric("timing.track_ms_median", "time for a frame (ms)", "lower", "ratio", 0.20)
# What losses cost is in success and completion, which are judged: more tests would only blunt each of them.
METRICS = (
    SUCCESS,
    ATE,
    Metric("completion", "completion", "higher", "difference", 0.05),
    Metric("losses_per_metre", "losses a metre", "lower", "difference"),
    Metric("losses_per_minute", "losses a minute", "lower", "difference"),
    TIME,
)
