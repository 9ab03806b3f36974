"""Houses of SUNCG, a dataset of indoor scenes (Song et al. 2017) that is not given out any more, and of its layout.

The data root holds house/ID/house.json, room/ID/*.obj, object/ID/*.obj and texture/*; nothing outside it is read.
"""

from pathlib import Path
from typing import ClassVar, Literal, cast

from pydantic import Field

from slamgym.scenes.house import House
from slamgym.scenes.loader import SceneOptions


class SuncgOptions(SceneOptions):
    """How a house.json is read.

    level: the storey, 0 being the first in the file. doors: "open" leaves doors out, as SUNCG's are shut; it tells them
    by metadata/ModelCategoryMapping.csv in the data root, where there is one.
    """

    level: int = Field(0, ge=0)
    doors: Literal["open", "kept"] = "open"


class Suncg:
    """The registry's loader of SUNCG's house.json."""

    Options: ClassVar[type[SceneOptions]] = SuncgOptions
    suffixes: ClassVar[tuple[str, ...]] = ("house.json",)

    @staticmethod
    def load(source: int | Path, options: SceneOptions) -> House:
        """The house of ROOT/house/ID/house.json, its floor at z = 0; without light, see `slamgym.scenes.light`.

        Nodes that cannot be used are left out and told in `defects`. The files are read by a process of its own, with
        bounded memory and time. Raises SceneError.
        """
        from slamgym.scenes.importing.bounded import call_bounded
        from slamgym.scenes.suncg.reader import read_suncg

        return call_bounded(str(source), read_suncg)(cast(Path, source), cast(SuncgOptions, options))
