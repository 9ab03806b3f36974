"""A saved figure and what a reader finds in it."""

import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from pathlib import Path

import matplotlib.image
import pytest
from matplotlib.figure import Figure

from slamgym.eval.plots import save_figure

# Names that break pictures: mathematics, markup, labels that matplotlib hides, other scripts, no end.
HOSTILE_NAMES = [
    "_hidden",
    "$x_1$ & <b>",
    "_nolegend_",
    "Größe → é",
    "back\\slash \\$5",
    "{braces} %s",
    "very long " * 30,
]


@pytest.fixture
def hostile_names() -> list[str]:
    return HOSTILE_NAMES


@pytest.fixture
def texts_of(tmp_path: Path) -> Callable[[Figure], list[str]]:
    """texts_of(figure) saves the figure, checks both files, and gives all texts of the svg."""

    def texts(figure: Figure) -> list[str]:
        figure.set_dpi(40)  # quick
        svg, png = save_figure(figure, tmp_path / "figure")
        pixels = matplotlib.image.imread(png)[..., :3]
        assert pixels.std() > 0.0
        root = ElementTree.parse(svg).getroot()
        return ["".join(element.itertext()) for element in root.iter("{http://www.w3.org/2000/svg}text")]

    return texts
