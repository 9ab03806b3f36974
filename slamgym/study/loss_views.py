"""What the SLAM saw around each loss: strips of frames, for a person to look at."""

from pathlib import Path

import numpy as np

from slamgym.eval.datasets import Sequence
from slamgym.eval.plots.contact_sheet import Image, jpg
from slamgym.eval.plots.film_strip import film_strip
from slamgym.eval.robustness import find_losses
from slamgym.types import IntArray, SlamRecord, TrackingState

LOSSES = "losses"
MOST_LOSSES = 6
AROUND_NS = (-1_000_000_000, -300_000_000, 300_000_000, 1_000_000_000)
"""Beside the last tracked frame and the first lost one, those so long before and after the loss began."""


def write_loss_views(folder: Path, sequence: Sequence, record: SlamRecord) -> None:
    """Write `folder`/losses/N.jpg for loss N, from 1, of the first ones; no folder without a loss.

    Raises OSError, and SequenceError for a frame that cannot be read.
    """
    for number, loss in enumerate(find_losses(record)[:MOST_LOSSES], start=1):
        (folder / LOSSES).mkdir(exist_ok=True)
        (folder / LOSSES / f"{number}.jpg").write_bytes(jpg(loss_strip(sequence, record, loss.start_frame)))


def loss_strip(sequence: Sequence, record: SlamRecord, start_frame: int) -> Image:
    """Frames around the loss that begins with the fed frame `start_frame`, each with its time and the SLAM's state."""
    rows = frames_around(sequence.stamps_ns, *record.stamps_ns[[start_frame - 1, start_frame]].tolist())
    # Frames in between were not fed: there the state is still that of the last one that was.
    fed = np.searchsorted(record.stamps_ns, sequence.stamps_ns[rows], side="right") - 1
    states = [TrackingState(state) for state in record.states[fed]]
    since_start_s = (sequence.stamps_ns[rows] - record.stamps_ns[0]) * 1e-9
    captions = [f"{at_s:.2f} s  {state.label}" for at_s, state in zip(since_start_s, states, strict=True)]
    views = [sequence.frame(row).rgb for row in rows]
    return film_strip(views, captions, [state is TrackingState.OK for state in states])


def frames_around(stamps_ns: IntArray, last_tracked_ns: int, first_lost_ns: int) -> list[int]:
    """Rows of the frames to show for a loss, increasing, each once; none for a time outside the sequence.

    stamps_ns: of all frames, int64 (N,), increasing.
    """
    wanted = [last_tracked_ns, first_lost_ns, *(first_lost_ns + after_ns for after_ns in AROUND_NS)]
    return sorted(
        {
            int(np.abs(stamps_ns - wanted_ns).argmin())
            for wanted_ns in wanted
            if stamps_ns[0] <= wanted_ns <= stamps_ns[-1]
        }
    )
