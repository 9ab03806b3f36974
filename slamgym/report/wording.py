"""Numbers as a person would write them."""

import math
from collections.abc import Sequence

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


def percent(share: float) -> str:
    """A share, 0 to 1, in whole percent; with one digit below 1 %, and neither 0 nor 100 % for what is not quite."""
    if math.isnan(share):
        return "-"
    size = abs(100 * share)
    digits = 1 if 0 < size < 0.95 or 99.5 <= size < 100 else 0
    return f"{max(min(size, 99.9), 0.1) * (1 if share > 0 else -1):.1f} %" if digits else f"{100 * share + 0.0:.0f} %"


def percent_range(interval: Interval) -> str:
    """The ends of an interval of shares: "12 to 40 %"."""
    low, high = (round(100 * end) + 0 for end in (interval.low, interval.high))
    return f"{low} to {high} %"


def ratio_range(interval: Interval) -> str:
    """The ends of an interval of ratios, to see whether they hold 1: "0.93 to 1.08"."""
    return f"{interval.low:.2f} to {interval.high:.2f}"


def number_range(interval: Interval) -> str:
    """The ends of an interval: "0.8 to 1.1"; "0.8 or more" where one is open."""
    if math.isinf(interval.high):
        return f"{number(interval.low)} or more"
    return f"{number(interval.low)} to {number(interval.high)}"


def count(n: int, noun: str) -> str:
    """How many there are of what, as "1 run" and "31,000 runs"."""
    return f"{n:,} {noun}" if n == 1 else f"{n:,} {noun}s"


def listed(words: Sequence[str]) -> str:
    """The words of a list: "a, b and c"."""
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def sentence(text: str) -> str:
    """With a capital letter at its start and a full stop at its end."""
    return f"{text[:1].upper()}{text[1:]}."
