"""One table for several episodes: what the terminal shows after a run."""

from collections.abc import Sequence
from math import isfinite

from rich.box import SIMPLE_HEAD
from rich.table import Table

from slamgym.rollout import Episode

COLUMNS: dict[str, tuple[str, str]] = {
    "path": ("seed", "{}"),
    "speed\nm/s": ("speed", "{:.2f}"),
    "reached\nm/s": ("speed_p95_mps", "{:.2f}"),
    "status": ("status", "{}"),
    "ATE\nm": ("ate_rmse_m", "{:.4f}"),
    "RPE 1\nm": ("rpe_step_trans_rmse_m", "{:.4f}"),
    "RPE\nall m": ("rpe_trans_rmse_m", "{:.4f}"),
    "RPE\nall °": ("rpe_rot_mean_deg", "{:.2f}"),
    "com-\nplete": ("completion", "{:.1%}"),
    "losses": ("loss_count", "{}"),
    "driven\nm": ("distance_m", "{:.1f}"),
}
"""Heading -> key of the episode's config or summary, and its format. ATE never stands without completion.
RPE 1 is over one fed frame, RPE all over all steps."""


def episode_table(episodes: Sequence[Episode]) -> Table:
    """A table with one row an episode."""
    table = Table(box=SIMPLE_HEAD, padding=0)
    for heading in COLUMNS:
        table.add_column(heading, justify="right", no_wrap=True)
    for episode in episodes:
        values = {**episode.config, **episode.summary}
        table.add_row(*(_formatted(values[key], style) for key, style in COLUMNS.values()))
    return table


def _formatted(value: object, style: str) -> str:
    if isinstance(value, float) and not isfinite(value):
        return "-"
    return style.format(value)
