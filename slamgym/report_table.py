"""One table for several runs, and lines about them: what is shown after a command."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from rich.table import Table

from slamgym.eval.plots.names import printable, shorten
from slamgym.eval.robustness import average
from slamgym.rollout import Episode
from slamgym.tables import PERCENT, figures_table

EPISODE_COLUMNS: dict[str, tuple[str, str]] = {
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

REPLAY_COLUMNS: dict[str, tuple[str, str]] = {
    "sequence": ("name", "{}"),
    "run": ("run", "{}"),
    "status": ("status", "{}"),
    "ATE\nm": ("ate_rmse_m", "{:.4f}"),
    "pub-\nlished": ("published_ate_rmse_m", "{:.3f}"),
    "com-\nplete": ("completion", PERCENT),
    "losses": ("loss_count", "{}"),
    "fed": ("frames_fed", "{}"),
    "drop-\nped": ("frames_dropped", "{}"),
    "ms a\nframe": ("track_ms", "{:.1f}"),
}
"""Heading -> key of the run's row, and its format."""

LONGEST_NAME = 18
LINES_OF_LOSSES = 10

ENDED = {
    "relocalized": "then found again",
    "new_map": "then in a new map",
    "map_reset": "its map thrown away",
    "never": "to the end",
}
"""Outcome of a loss -> how it is told."""


def episode_table(episodes: Sequence[Episode]) -> Table:
    """A table with one row an episode."""
    return figures_table(EPISODE_COLUMNS, [{**episode.config, **episode.summary} for episode in episodes])


def replay_table(rows: Sequence[Mapping[str, Any]]) -> Table:
    """A table with one row a run."""
    return figures_table(REPLAY_COLUMNS, [{**row, "name": _short(row["sequence"])} for row in rows])


def _short(sequence: str) -> str:
    """Names of TUM RGB-D differ only after what they have in common."""
    return shorten(printable(sequence.removeprefix("rgbd_dataset_")), LONGEST_NAME)


def spread_line(name: str, rows: Sequence[Mapping[str, Any]]) -> str:
    """How far the runs of one sequence lie apart; the median counts one that failed as worse than any other."""
    ate = np.array([row["ate_rmse_m"] for row in rows])
    succeeded = np.array([row["success"] for row in rows])
    known = np.isfinite(ate)
    ending = f"{succeeded.sum()} of {len(rows)} runs without a failure"
    if not known.any():
        return f"{name}: no ATE; {ending}"
    median = average(ate, ~(succeeded & known), "penalise", penalty=np.inf).value
    typical = f"{median:.4f} m" if np.isfinite(median) else "none, since half of the runs or more failed"
    return f"{name}: ATE {ate[known].min():.4f} to {ate[known].max():.4f} m, median {typical}; {ending}"


def remarks(summary: Mapping[str, Any]) -> Iterator[str]:
    """When a run was lost, for how long and why; why it ended early; whether lock-step had to give up."""
    for loss in summary["losses"][:LINES_OF_LOSSES]:
        context = loss["context"]
        why = f": {context['explanation']}" if context else ""
        yield f"lost at {loss['start_s']:.2f} s for {loss['duration_s']:.2f} s, {ENDED[loss['outcome']]}{why}"
    if (more := len(summary["losses"]) - LINES_OF_LOSSES) > 0:
        yield f"and {more} more losses, see episode.json"
    causes = [loss["context"]["cause"] for loss in summary["losses"] if loss["context"]]
    if summary["failure"] and summary["status"] not in causes:
        yield f"{summary['status']}: {summary['failure']}"
    if overruns := summary["lockstep_overruns"]:
        yield (
            f"the SLAM's threads never came to rest after {overruns} frames: lock-step went on without them; if they "
            "always work, feed it with --slam-sync realtime or free"
        )
