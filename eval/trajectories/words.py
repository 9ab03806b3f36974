"""The words of one line of numbers; whatever is wrong with them is a ValueError, to which the caller adds the line."""


def columns(line: str, separator: str | None = None) -> list[str]:
    """The words of a line of numbers. Python reads 1_000 and all scripts' digits as numbers; no other tool does."""
    if "_" in line or not line.isascii():
        raise ValueError(f"expected plain numbers, got {quoted(line)}")
    return line.split(separator)


def numbers(words: list[str]) -> list[float]:
    """Floats of the words; NaN and infinity are numbers here."""
    try:
        return list(map(float, words))
    except ValueError:
        raise ValueError(f"expected a number, got {quoted(next(w for w in words if not is_number(w)))}") from None


def is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def format_of(line: str) -> str | None:
    """Name of the format that a line looks like by its separators and columns, None for none of them."""
    if "," in line:
        return "euroc"
    return {8: "tum", 12: "kitti"}.get(len(line.split()))


def wrong_columns(own_format: str, expected: str, line: str, got: int) -> ValueError:
    """The error for a line with another number of columns; it names the other format that the line looks like."""
    look = format_of(line)
    hint = "" if look in (None, own_format) else f"is it in the format {look}, or "
    return ValueError(f"expected {expected}, got {got} columns; {hint}is the line cut off?")


def quoted(word: str) -> str:
    """The word in quotes, shortened for a message of one line."""
    return repr(word if len(word) <= 40 else word[:37] + "...")
