"""What a scene loader is: a class that makes a house of a seed, or of a file."""

from pathlib import Path
from typing import ClassVar, Protocol

from slamgym.checked_params import Params
from slamgym.scenes.house import House


class SceneOptions(Params):
    """The base of each loader's own options, and those of a loader that has none. On the command line they are text."""

    kind: ClassVar[str] = "scene option"

    @classmethod
    def _label(cls, name: str) -> str:
        return f"{cls.kind} {name!r}"


class SceneLoader(Protocol):
    """Makes houses. Its module must import quickly and without optional libraries; `load` may need them."""

    Options: ClassVar[type[SceneOptions]]
    """Accepted `scene_options`, each with a default; an unknown key is an error."""
    suffixes: ClassVar[tuple[str, ...]]
    """How the names of the files end that it reads, as ".glb" or "house.json"; none when it takes a seed."""

    @staticmethod
    def load(source: int | Path, options: SceneOptions) -> House:
        """The house of a seed, 0 or more, or of a file that exists; raises SceneError.

        Light need not be baked, but in parts that shine by themselves. What the loader assumed, repaired and left out
        is in the house's `assumptions` and `defects`.
        """
        ...
