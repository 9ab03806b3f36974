"""Names of other people's systems, sequences and attributes, as text in a picture."""

import math
from collections import Counter
from collections.abc import Iterable

MAX_LETTERS = 32


def plain(text: str, max_letters: int = MAX_LETTERS) -> str:
    """`text` so that matplotlib draws it letter by letter: in one line, without mathematics between dollar signs, the
    middle left out where it is longer than `max_letters`.
    """
    return shorten(_printable(text), max_letters).replace("$", r"\$")


def plain_names(names: Iterable[str], max_letters: int = MAX_LETTERS) -> list[str]:
    """`plain` for names side by side: those that look the same once shortened are numbered."""
    short = [shorten(_printable(name), max_letters) for name in names]
    total, seen, unique = Counter(short), Counter[str](), []
    for name in short:
        seen[name] += 1
        unique.append(f"{name} #{seen[name]}" if total[name] > 1 else name)
    return [name.replace("$", r"\$") for name in unique]


def percent(share: float) -> str:
    """A share in words, rounded down: never "100 %" while a frame or a run is missing."""
    return f"{math.floor(100.0 * share + 1e-9)} %"


def shorten(text: str, max_letters: int) -> str:
    """`text` with its middle left out: names of sequences mostly differ at their ends."""
    if len(text) <= max_letters:
        return text
    head = (max_letters - 1) // 2
    return f"{text[:head]}…{text[len(text) - (max_letters - 1 - head) :]}"


def _printable(text: str) -> str:
    """In one line; what no picture can show, such as control characters, which XML forbids, becomes a question mark."""
    return "".join(letter if letter.isprintable() else "\N{REPLACEMENT CHARACTER}" for letter in " ".join(text.split()))
