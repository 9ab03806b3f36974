"""Names in messages."""

from collections.abc import Sequence

MOST = 5
LONGEST = 60


def listed(names: Sequence[str]) -> str:
    """The first names, quoted and cut, and how many more there are.

    >>> listed(["a", "b"])
    "'a', 'b'"
    """
    more = f" and {len(names) - MOST} more" if len(names) > MOST else ""
    return ", ".join(repr(name[:LONGEST]) for name in names[:MOST]) + more
