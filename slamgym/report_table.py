"""One table for several episodes: what is shown after a run."""

from collections.abc import Sequence

from rich.table import Table

from slamgym.rollout import Episode
from slamgym.tables import PERCENT, figures_table

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
