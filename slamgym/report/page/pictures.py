"""The report's pictures: drawn once, kept as files, and put into the page."""

import base64
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure

from slamgym.eval.plots import save_figure
from slamgym.report.content import Picture
from slamgym.report.page.file_names import file_stem

SVG_LIMIT = 150_000
"""Bytes up to which a picture is put into the page as it is drawn: sharp at any size, its texts to be searched."""
PNG_DPI = 200
CSS_DPI = 96
"""What browsers call a pixel, of an inch."""


@dataclass(frozen=True, slots=True)
class PagePicture:
    """url: its data. width, height: on a wide screen, pixels."""

    title: str
    caption: str
    url: str
    width: int
    height: int


def picture_files(picture: Picture) -> list[str]:
    return [f"figures/{file_stem(picture.name)}.{kind}" for kind in ("svg", "png")]


def write_picture(picture: Picture, folder: Path) -> PagePicture:
    """Draw the picture, write its files below `folder`, and give it for the page. Raises OutputError."""
    figure = picture.draw()
    svg, _ = save_figure(figure, folder / "figures" / file_stem(picture.name))
    width, height = (round(CSS_DPI * float(inches)) for inches in figure.get_size_inches())
    return PagePicture(picture.title, picture.caption, _picture_url(svg.read_bytes(), figure), width, height)


def data_url(kind: str, content: bytes) -> str:
    return f"data:image/{kind};base64,{base64.b64encode(content).decode()}"


def _picture_url(svg: bytes, figure: Figure) -> str:
    if len(svg) <= SVG_LIMIT:
        return data_url("svg+xml", svg)
    png = BytesIO()
    figure.savefig(png, format="png", dpi=PNG_DPI)
    return data_url("png", png.getvalue())
