"""Names for what is planned: the same for the same, on every computer, and fit for folders."""

import hashlib
import json
import re
from collections.abc import Mapping
from typing import Any

SLUG_LETTERS = 40
HASH_DIGITS = 8

_UNFIT = re.compile(r"[^A-Za-z0-9._]+")


def canonical(value: Any) -> str:
    """JSON that is the same whatever the order of keys, for 1 and 1.0, and for lists and tuples.

    >>> canonical({"b": 1.0, "a": (True, None)})
    '{"a":[true,null],"b":1}'
    """
    return json.dumps(_plain(value), sort_keys=True, separators=(",", ":"), default=str)


def name_for_folder(slug: str, planned: Any) -> str:
    """A name that tells a person what is in the folder, and is as unique as what is planned."""
    return f"{slug}_{hashlib.sha256(canonical(planned).encode()).hexdigest()[:HASH_DIGITS]}"


def slug_of(first: str, levels: Mapping[str, Any]) -> str:
    """A text and levels in at most 40 letters, digits, ".", "-" and "_" that start with none of these three.

    >>> slug_of("procedural:1 #7", {"speed": 0.4, "scene_options.texture": 2})
    'procedural-1-7_speed-0.4_texture-2'
    """
    words = [_fit(first), *(f"{_fit(name.rpartition('.')[2])}-{_fit(_word(level))}" for name, level in levels.items())]
    return "_".join(word for word in words if word)[:SLUG_LETTERS].strip("._-") or "x"


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    return int(value) if isinstance(value, float) and value.is_integer() else value


def _fit(text: str) -> str:
    return _UNFIT.sub("-", text).strip(".-")


def _word(level: Any) -> str:
    """As a person writes it; of a path its last part."""
    if isinstance(level, bool):
        return "on" if level else "off"
    return f"{level:g}" if isinstance(level, float) else str(level).rpartition("/")[2]
