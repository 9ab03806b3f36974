"""Numbers as a person would write them."""

import math
from collections.abc import Sequence

from slamgym.eval.plots.names import percent as percent  # of pictures, too: all of a report round alike
from slamgym.eval.statistics import Interval


def number(value: float) -> str:
    """Two significant digits, three from 100 on, "0.034", "1.1", "12", "340", and a dash for NaN."""
    if not math.isfinite(value):
        return "-" if math.isnan(value) else "infinity" if value > 0 else "-infinity"
    if value == 0:
        return "0"
    size = math.floor(math.log10(abs(value)))
    if size < -6:
        return f"{value:.1g}"
    rounded = round(value, (1 if size < 2 else 2) - size)
    decimals = max(1 - math.floor(math.log10(abs(rounded))), 0)
    return f"{rounded:.{decimals}f}"


def percent_range(interval: Interval) -> str:
    """The ends of an interval of shares or of their differences: "12 to 40 %"; "0.3 to 40 %": it does not hold 0."""
    return f"{_percent_end(interval.low)} to {_percent_end(interval.high)} %"


def _percent_end(end: float) -> str:
    rounded = round(100 * end) + 0
    return f"{rounded}" if rounded or abs(end) < 5e-4 else f"{100 * end:.1f}"


def ratio_range(interval: Interval) -> str:
    """The ends of an interval of ratios, to see whether they hold 1: "0.93 to 1.08"."""
    return f"{interval.low:.2f} to {interval.high:.2f}"


def number_range(interval: Interval) -> str:
    """The ends of an interval: "0.8 to 1.1"; "0.8 or more" or "1.1 or less" where one is open."""
    if math.isinf(interval.low):
        return f"{number(interval.high)} or less"
    if math.isinf(interval.high):
        return f"{number(interval.low)} or more"
    return f"{number(interval.low)} to {number(interval.high)}"


def confidence(interval: Interval) -> str:
    """What the interval holds with: "95 % interval", "98.3 % interval" for one of three that hold together."""
    return f"{100 * interval.confidence:.3g} % interval"


def count(n: int, noun: str) -> str:
    """How many there are of what, as "1 run" and "31,000 runs"."""
    return f"{n:,} {noun}" if n == 1 else f"{n:,} {noun}s"


def listed(words: Sequence[str]) -> str:
    """The words of a list: "a, b and c"."""
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def sentence(text: str) -> str:
    """With a capital letter at its start and a full stop at its end."""
    return f"{text[:1].upper()}{text[1:]}."
