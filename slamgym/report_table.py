"""Tables on the terminal: what is shown after a run."""

from collections.abc import Iterable, Mapping, Sequence
from math import floor, isfinite
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.markup import escape
from rich.table import Table

from slamgym.rollout import Episode

PERCENT = "percent"
"""Format of a share: rounded down, so that "100.0%" means all."""

COLUMNS: dict[str, tuple[str, str]] = {
    "path": ("seed", "{}"),
    "speed\nm/s": ("speed", "{:.2f}"),
    "reached\nm/s": ("speed_p95_mps", "{:.2f}"),
    "status": ("status", "{}"),
    "ATE\nm": ("ate_rmse_m", "{:.4f}"),
    "RPE 1\nm": ("rpe_step_trans_rmse_m", "{:.4f}"),
    "RPE\nall m": ("rpe_trans_rmse_m", "{:.4f}"),
    "RPE\nall °": ("rpe_rot_mean_deg", "{:.2f}"),
    "com-\nplete": ("completion", PERCENT),
    "losses": ("loss_count", "{}"),
    "driven\nm": ("distance_m", "{:.1f}"),
}
"""Heading -> key of the episode's config or summary, and its format. ATE never stands without completion.
RPE 1 is over one fed frame, RPE all over all steps."""


def episode_table(episodes: Sequence[Episode]) -> Table:
    """A table with one row an episode."""
    return figures_table(COLUMNS, [{**episode.config, **episode.summary} for episode in episodes])


def figures_table(columns: Mapping[str, tuple[str, str]], rows: Iterable[Mapping[str, Any]]) -> Table:
    """A table with a line a row; columns: heading -> key in the rows, and the format of its values."""
    table = Table(box=SIMPLE_HEAD, padding=0)
    for heading in columns:
        table.add_column(heading, justify="right", no_wrap=True)
    for row in rows:
        table.add_row(*(_formatted(row[key], style) for key, style in columns.values()))
    return table


def _formatted(value: Any, style: str) -> str:
    if isinstance(value, float) and not isfinite(value):
        return "-"
    if style == PERCENT:
        return f"{floor(1e3 * value + 1e-9) / 10:.1f}%"
    return escape(style.format(value))
