"""Names of other people's systems, sequences and attributes, as text in a picture or on a terminal."""

import math
from collections import Counter
from collections.abc import Iterable

MAX_LETTERS = 32


def plain(text: str, max_letters: int = MAX_LETTERS) -> str:
    """`text` so that matplotlib draws it letter by letter: in one line, without mathematics between dollar signs, the
    middle left out where it is longer than `max_letters`.
    """
    return shorten(printable(text), max_letters).replace("$", r"\$")


def plain_names(names: Iterable[str], max_letters: int = MAX_LETTERS) -> list[str]:
    """`plain` for names side by side: those that look the same once shortened are numbered."""
    short = [shorten(printable(name), max_letters) for name in names]
    total, seen, unique = Counter(short), Counter[str](), []
    for name in short:
        seen[name] += 1
        unique.append(f"{name} #{seen[name]}" if total[name] > 1 else name)
    return [name.replace("$", r"\$") for name in unique]


def percent(share: float) -> str:
    """A share, 0 to 1, in whole percent; with one digit below 1 %, and neither 0 nor 100 % for what is not quite."""
    if math.isnan(share):
        return "-"
    size = abs(100 * share)
    digits = 1 if 0 < size < 0.95 or 99.5 <= size < 100 else 0
    return f"{max(min(size, 99.9), 0.1) * (1 if share > 0 else -1):.1f} %" if digits else f"{100 * share + 0.0:.0f} %"


def shorten(text: str, max_letters: int) -> str:
    """`text` with its middle left out: names of sequences mostly differ at their ends."""
    if len(text) <= max_letters:
        return text
    head = (max_letters - 1) // 2
    return f"{text[:head]}…{text[len(text) - (max_letters - 1 - head) :]}"


def printable(text: str) -> str:
    """`text` in one line, for a picture or a terminal: each white space becomes one blank; what neither can show, such
    as control characters, which XML forbids and a terminal obeys, becomes U+FFFD, a question mark in a lozenge.
    """
    return "".join(letter if letter.isprintable() else "\N{REPLACEMENT CHARACTER}" for letter in " ".join(text.split()))
