"""How every picture looks and how it is written: matplotlib's objects only, and no state of pyplot."""

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from slamgym.errors import OutputError

# Okabe and Ito's colours, which colour-blind people can tell apart (jfly.uni-koeln.de/color, 2008); their yellow is
# too pale for lines on white, black is the truth's and vermilion that of losses and failures.
TRUTH, LOST = "#000000", "#D55E00"
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9")
DASHES: tuple[tuple[int, tuple[float, ...] | None], ...] = (
    (0, None),
    (0, (5, 1.5)),
    (0, (1.2, 1.2)),
    (0, (6, 1.5, 1.2, 1.5)),
    (0, (10, 3)),
    (0, (4, 1.2, 1.2, 1.2, 1.2, 1.2)),
)
MARKERS = ("o", "^", "s", "D", "v", "P", "<")
DPI = 120
LEGEND_ROW_IN = 0.21


class Look(NamedTuple):
    """What tells one series from another, in colour and in grey."""

    colour: str
    dash: tuple[int, tuple[float, ...] | None]
    marker: str


def look(i: int) -> Look:
    """The look of series i >= 0. Dash and marker together repeat after 42 series only: enough without any colour."""
    return Look(COLOURS[i % len(COLOURS)], DASHES[i % len(DASHES)], MARKERS[i % len(MARKERS)])


def new_figure(width_in: float, height_in: float) -> Figure:
    """An empty figure, inches, which makes room for what stands beside its axes."""
    return Figure(figsize=(width_in, height_in), dpi=DPI, layout="constrained")


def tidy(axes: Axes, *, grid: bool = True) -> None:
    """Leave out the frame's lines that carry nothing, and draw the grid pale and below the data."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_axisbelow(True)
    if grid:
        axes.grid(color="0.9", linewidth=0.8)


def legend_below(figure: Figure, handles: Sequence[Artist]) -> None:
    """A legend under the axes, never over the data, of the artists' own labels, in as many columns as fit.

    The figure grows by the legend's height, so that the axes keep theirs.
    """
    # Given as they are: matplotlib would leave out a label that it reads itself and that starts with "_".
    labels = [str(handle.get_label()) for handle in handles]
    if labels:
        letters_a_line = 13 * figure.get_figwidth()
        fit = np.clip(letters_a_line // (max(map(len, labels)) + 7), 1, 4)
        rows = np.ceil(len(labels) / fit)
        columns = int(np.ceil(len(labels) / rows))
        figure.set_figheight(figure.get_figheight() + LEGEND_ROW_IN * rows)
        figure.legend(handles, labels, loc="outside lower center", ncols=columns, frameon=False)


def save_figure(figure: Figure, stem: Path) -> tuple[Path, Path]:
    """Write `stem`.svg and `stem`.png, each whole or not at all, and give their paths.

    The same figure gives the same svg byte by byte; its texts are texts, to be searched and edited. Missing folders are
    made. Raises OutputError.
    """
    svg, png = (stem.with_name(f"{stem.name}.{kind}") for kind in ("svg", "png"))
    try:
        stem.parent.mkdir(parents=True, exist_ok=True)
        with TemporaryDirectory(prefix=".figure-", dir=stem.parent) as folder:
            drafts = Path(folder, "draft.svg"), Path(folder, "draft.png")
            # The first drawing moves the axes to their places: without it, the next svg would differ.
            figure.draw_without_rendering()
            with mpl.rc_context({"svg.fonttype": "none", "svg.hashsalt": "slamgym"}):
                figure.savefig(drafts[0], format="svg", metadata={"Date": None})
            figure.savefig(drafts[1], format="png")
            return drafts[0].replace(svg), drafts[1].replace(png)
    except OSError as error:
        reason = error.strerror or str(error)
        raise OutputError(f"picture: writing {svg} and .png failed ({reason}); name another place") from None
