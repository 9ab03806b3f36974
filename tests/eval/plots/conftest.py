"""A drawn figure and what a reader finds in it."""

import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from io import BytesIO

import matplotlib as mpl
import pytest
from matplotlib.figure import Figure

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
def texts_of() -> Callable[[Figure], list[str]]:
    """texts_of(figure) draws the figure as svg and gives all its texts."""

    def texts(figure: Figure) -> list[str]:
        svg = BytesIO()
        with mpl.rc_context({"svg.fonttype": "none"}):
            figure.savefig(svg, format="svg")
        root = ElementTree.fromstring(svg.getvalue())
        return ["".join(element.itertext()) for element in root.iter("{http://www.w3.org/2000/svg}text")]

    return texts
