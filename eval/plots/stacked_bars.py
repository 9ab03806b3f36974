"""What a number is made up of, level by level: losses by their cause."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from slamgym.errors import ConfigError
from slamgym.eval.plots.names import plain, plain_names
from slamgym.eval.plots.style import COLOURS, legend_below, new_figure, tidy

HATCHES = ("", "////", "....", "xxxx", "----", "oooo", "\\\\\\\\", "++++", "****", "||||")


def plot_stacked_bars(
    parts: Mapping[str, ArrayLike], levels: Sequence[str], *, quantity: str = "losses a run", by: str = ""
) -> Figure:
    """A horizontal bar for each level, from the first at the top, of the parts (L,) one after another.

    parts: name -> its amount at each level, 0 or more; the first stands at the left. by: what the levels are of, for
    example "speed (m/s)". Colour and hatching tell the parts apart. Raises ConfigError.
    """
    amounts = {name: np.asarray(numbers, dtype=np.float64) for name, numbers in parts.items()}
    for name, numbers in amounts.items():
        if numbers.shape != (len(levels),) or not (numbers >= 0).all():
            raise ConfigError(
                f"plot_stacked_bars: expected {len(levels)} amounts of 0 or more of {name!r}, got {numbers.tolist()}"
            )
    figure = new_figure(8.0, float(np.clip(1.2 + 0.45 * len(levels), 2.2, 14)))
    axes = figure.add_subplot()
    left, handles = np.zeros(len(levels)), list[Artist]()
    for i, (label, numbers) in enumerate(zip(plain_names(amounts), amounts.values(), strict=True)):
        bars = axes.barh(
            np.arange(len(levels)), numbers, left=left, height=0.7, label=label, color=COLOURS[i % len(COLOURS)],
            hatch=HATCHES[i % len(HATCHES)], edgecolor="white", linewidth=0.8,
        )  # fmt: skip
        handles.append(bars)  # type: ignore[arg-type]  # a container of artists, which a legend takes as one
        left += numbers
    axes.set_yticks(np.arange(len(levels)), plain_names(levels, 24))
    axes.invert_yaxis()
    axes.set(xlabel=plain(quantity, 60), ylabel=plain(by, 40))
    tidy(axes)
    axes.yaxis.grid(visible=False)
    legend_below(figure, handles)
    return figure
