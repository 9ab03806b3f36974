"""Where the scenes and files are that a study names: relative to its own file."""

import os
from pathlib import Path

from slamgym.errors import SlamgymError
from slamgym.plugins import named_targets
from slamgym.scenes.registry import ENTRY_POINTS, SCENES, find_scene


def located_file(text: str, base: Path) -> str:
    """The absolute path of a file named relative to the folder `base`; "~" is the user's home."""
    # Not resolve(): what a link is called may tell more than what it leads to. As Path.expanduser, which raises when
    # there is no such user.
    return os.path.normpath(base.absolute() / os.path.expanduser(text))  # noqa: PTH111


def located_scene(text: str, base: Path) -> str:
    """The scene by a name that holds everywhere: "procedural:0" for "procedural", the absolute path of a file.

    What is neither stays as it is.
    """
    name, _, rest = text.partition(":")
    if (seed := _seed(text)) is not None:
        return f"{name}:{seed}"
    if name in named_targets(SCENES, ENTRY_POINTS):
        return f"{name}:{located_file(rest, base)}" if _is_like_file(rest) else text
    return located_file(text, base) if _is_like_file(text) or os.path.lexists(base / text) else text


def _seed(text: str) -> int | None:
    try:
        source = find_scene(text).source
    except SlamgymError:
        return None
    return source if isinstance(source, int) else None


def _is_like_file(text: str) -> bool:
    return bool(Path(text).suffix) or "/" in text
