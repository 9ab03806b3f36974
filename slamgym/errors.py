"""Errors that slamgym raises on purpose. Every message says what was expected, what came, and what to do."""

from collections.abc import Iterable
from difflib import get_close_matches


class SlamgymError(Exception):
    """Root of all errors that slamgym raises on purpose."""


class ConfigError(SlamgymError, ValueError):
    """A parameter has an unknown name or a value outside its range."""


class SceneError(SlamgymError):
    """A scene cannot be loaded, or the robot cannot drive in it."""


class SceneWarning(UserWarning):
    """Something in a scene's files was repaired or left out; which file and node."""


class RenderError(SlamgymError):
    """No image can be rendered on this machine, for example because EGL is missing."""


class SlamError(SlamgymError):
    """A SLAM cannot do its work: a library, program or vocabulary is missing, unreadable or cannot be downloaded, or a
    program failed or wrote a trajectory that cannot be used.
    """


class TrajectoryError(SlamgymError, ValueError):
    """A trajectory, or a file of one, is malformed or cannot be evaluated."""


class TrajectoryWarning(UserWarning):
    """Something about a trajectory or a sequence was repaired, or looks wrong, or was left out: images without depth;
    what was done about it.
    """


class SequenceError(SlamgymError):
    """A recorded sequence is malformed, or a file of it is missing or unreadable."""


class OutputError(SlamgymError):
    """Results cannot be written where they should go."""


def unknown_word(kind: str, got: str, valid: Iterable[str]) -> str:
    """Message for a word that is not one of `valid`, naming the closest one.

    >>> unknown_word("slam backend", "orbslam", ["groundtruth", "orbslam3"])
    "unknown slam backend 'orbslam'; did you mean 'orbslam3'? Valid: groundtruth, orbslam3"
    """
    valid = sorted(valid)
    close = get_close_matches(got.lower(), valid, n=1, cutoff=0.4)
    hint = f"; did you mean {close[0]!r}?" if close else "."
    return f"unknown {kind} {got!r}{hint} Valid: {', '.join(valid)}"
