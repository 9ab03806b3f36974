"""Stamps as they are written: decimal words to integer nanoseconds, exactly; a float rounds a Unix time to 200 ns."""

from decimal import Context, Decimal, DecimalException

from slamgym.eval.trajectories.words import quoted

# No number of seconds that the stamps can hold is as large: it can only be nanoseconds (1e14 ns are a day).
SMALLEST_NANOSECONDS = 10**14

# Differences of two stamps below it (the year 2115) fit into 64 bits.
_MAX_STAMP_S = 4_600_000_000
MAX_NANOSECONDS = _MAX_STAMP_S * 10**9
# Bounds exponents and digits, so that a stamp like 1e999999999 is refused and not worked out.
_DECIMAL = Context(prec=40)


def seconds_to_ns(word: str) -> int:
    """Nanoseconds of a decimal number of seconds, rounded half to even below the nanosecond. Raises ValueError."""
    seconds = _decimal(word, "seconds")
    if _DECIMAL.abs(seconds) >= SMALLEST_NANOSECONDS:
        raise ValueError(f"expected a stamp in seconds, got {quoted(word)}: that is in nanoseconds, divide it by 1e9")
    if _DECIMAL.abs(seconds) >= _MAX_STAMP_S:
        raise ValueError(f"expected a stamp in seconds below {_MAX_STAMP_S}, got {quoted(word)}")
    return round(seconds.scaleb(9, _DECIMAL))


def whole_ns(word: str) -> int:
    """Nanoseconds of a whole number of nanoseconds, with or without decimals that are 0. Raises ValueError."""
    stamp = _decimal(word, "nanoseconds")
    if _DECIMAL.abs(stamp) >= MAX_NANOSECONDS:
        raise ValueError(f"expected a stamp in nanoseconds below {MAX_NANOSECONDS}, got {quoted(word)}")
    if stamp != round(stamp):
        raise ValueError(f"expected a stamp in whole nanoseconds, got {quoted(word)}: is it in seconds?")
    return round(stamp)


def seconds_word(stamp_ns: int) -> str:
    """The stamp in seconds with nine decimals, exactly; `seconds_to_ns` reads it back."""
    return f"{_DECIMAL.scaleb(Decimal(stamp_ns), -9):.9f}"


def _decimal(word: str, unit: str) -> Decimal:
    try:
        value = _DECIMAL.create_decimal(word.strip())
    except DecimalException:
        raise ValueError(f"expected a stamp in {unit}, got {quoted(word)}") from None
    if not value.is_finite():
        raise ValueError(f"expected a stamp in {unit}, got {quoted(word)}")
    return value
