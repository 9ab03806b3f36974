"""Procedural homes with furniture that people modelled: Debian's package sweethome3d-furniture, or other catalogues."""

import os
from dataclasses import replace
from pathlib import Path
from typing import ClassVar

from pydantic import field_validator

from slamgym.errors import unknown_word
from slamgym.scenes.furniture_catalogue.licences import LICENCES
from slamgym.scenes.house import House
from slamgym.scenes.loader import SceneOptions
from slamgym.scenes.procedural import HomeOptions, furnished_house


class SweetHomeOptions(HomeOptions):
    """catalogue: a folder of .sh3f files. licences: which may be used, of CC0, CC-BY and other, with commas between."""

    catalogue: str = "/usr/share/sweethome3d/furniture"
    licences: str = ",".join(LICENCES)

    @field_validator("licences")
    @classmethod
    def _known(cls, text: str) -> str:
        if not _words(text):
            raise ValueError(
                f"licences: expected one or more of {', '.join(LICENCES)}, got {text!r}; name those allowed"
            )
        for word in _words(text):
            if word not in LICENCES:
                raise ValueError(unknown_word("licence", word, LICENCES))
        return text


class SweetHome:
    """Homes made by code as to rooms, doors and lamps, and furnished from a catalogue as far as it goes."""

    Options: ClassVar[type[SceneOptions]] = SweetHomeOptions
    suffixes: ClassVar[tuple[str, ...]] = ()

    @staticmethod
    def load(source: int | Path, options: SceneOptions) -> House:
        """The home of a seed, the same for the same options and catalogue.

        Raises SceneError for a negative seed, and where no catalogue is installed. Whose models stand in it is in the
        house's assumptions, as their licences ask for.
        """
        # trimesh and javaproperties take a while to import, and every loader is asked for its suffixes.
        from slamgym.scenes.furniture_catalogue.catalogue import read_catalogue
        from slamgym.scenes.furniture_catalogue.showroom import Showroom

        assert isinstance(source, int)
        assert isinstance(options, SweetHomeOptions)
        catalogue = read_catalogue(Path(os.path.expanduser(options.catalogue)))  # noqa: PTH111  pathlib's raises for nobody's home
        allowed = _words(options.licences)
        showroom = Showroom([model for model in catalogue.models if model.licence.split()[0].strip(":") in allowed])
        house = furnished_house(f"sweethome:{source}", source, options, showroom.made)
        return replace(
            house,
            assumptions=(*house.assumptions, *showroom.credits(house)),
            defects=(*house.defects, *catalogue.defects, *showroom.defects),
        )


def _words(text: str) -> list[str]:
    return [word.strip() for word in text.split(",") if word.strip()]
