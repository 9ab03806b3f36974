"""The licences of models, by their short names."""

import re

LICENCES = ("CC0", "CC-BY", "other")
"""What a short name begins with."""


def short_name(text: str) -> str:
    """A licence's short name.

    >>> short_name("Creative Commons Attribution 3.0 Unported license")
    'CC-BY 3.0'
    """
    if re.search(r"public domain|cc-?0", text, re.IGNORECASE):
        return "CC0"
    attribution = re.search(r"attribution( \d\.\d)?", text, re.IGNORECASE)
    if attribution and not re.search(r"non.?commercial|no.?deriv|share.?alike", text, re.IGNORECASE):
        return f"CC-BY{attribution[1] or ''}"
    return f"other: {' '.join(text.split())[:60]}" if text else "other"
