"""The command line of a user's program, with places for what only a run knows."""

import os
import shlex
import shutil
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from string import Formatter
from typing import Self

from slamgym.errors import ConfigError, unknown_word

PLACEHOLDERS = ("vocabulary", "settings", "sequence", "associations", "trajectory", "loop_closure")
"""What the command may hold in braces: paths, all absolute, and 1 or 0."""


@dataclass(frozen=True, slots=True)
class Template:
    """The words of a command, and the placeholders in them."""

    words: tuple[str, ...]
    placeholders: frozenset[str]

    @classmethod
    def parse(cls, command: str) -> Self:
        """Split as a shell does; raises ConfigError for an unknown placeholder, or unbalanced quotes or braces."""
        try:
            words = shlex.split(command)
            fields = [field for word in words for field in Formatter().parse(word)]
        except ValueError as error:
            raise ConfigError(
                f"slam option 'command': expected words as in a shell, braces as {{{{ }}}}, got {command!r} ({error})"
            ) from None
        if not words:
            raise ConfigError("slam option 'command': expected a program and its arguments, got nothing")
        names = {f"{name}{conversion or ''}{spec}" for _, name, spec, conversion in fields if name is not None}
        for name in sorted(names - set(PLACEHOLDERS)):
            raise ConfigError(unknown_word("placeholder of the slam option 'command':", name, PLACEHOLDERS))
        return cls(tuple(words), frozenset(names))

    def program(self) -> str | None:
        """Absolute path of the program, None when it is not found or not executable."""
        found = shutil.which(os.path.expanduser(self.words[0]))  # noqa: PTH111  a Path would lose the "./"
        # Links are kept: from its name Python knows which environment it belongs to.
        return None if found is None else str(Path(found).absolute())

    def filled(self, values: Mapping[str, object]) -> list[str]:
        """The words with values in place of the placeholders; what names a file from here is an absolute path."""
        arguments = [word.format_map(values) for word in self.words[1:]]
        return [self.program() or self.words[0], *(str(_path(word) or word) for word in arguments)]

    def files(self) -> dict[str, Path]:
        """The program, if it is found, and the files of the user's among its arguments, by the words that name them."""
        paths = map(_path, self.filled(dict.fromkeys(PLACEHOLDERS, "")))
        named = zip(self.words, paths, strict=True)
        return {word: path for word, path in named if path is not None and path.is_file()}


def _path(word: str) -> Path | None:
    """Absolute path of the file that a word names from here, or of the folder, if there is a slash in the word."""
    with suppress(OSError, RuntimeError):  # too long for a file's name, such as a script for `sh -c`; unknown "~"
        path = Path(word).expanduser()
        if path.is_file() or ("/" in word and path.is_dir()):
            return path.absolute()
    return None
