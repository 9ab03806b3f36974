"""Which frames of an estimate count as tracked, for the pictures of trajectories."""

from collections.abc import Mapping

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.eval.plots.names import percent
from slamgym.types import BoolArray, FloatArray


def posed_frames(values: FloatArray) -> BoolArray:
    """Whether a frame's pose or position is there, for each frame (N,) of arrays (N, ...)."""
    return np.asarray(np.isfinite(values).all(axis=tuple(range(1, values.ndim))))


def tracked_frames(
    estimates: Mapping[str, FloatArray], tracked: Mapping[str, BoolArray] | None
) -> dict[str, BoolArray]:
    """The frames of each estimate that count as tracked, bool (N,), in the estimates' order: those given, or else those
    with a pose.

    Raises TrajectoryError for those of other estimates, or of other frames.
    """
    if tracked is None:
        return {name: posed_frames(values) for name, values in estimates.items()}
    check_names("tracked frames", estimates, tracked)
    for name, flags in tracked.items():
        if flags.dtype != np.bool_ or flags.shape != (len(estimates[name]),):
            raise TrajectoryError(
                f"plot of trajectories: expected tracked frames of {name!r} as bool ({len(estimates[name])},), one a "
                f"frame, got {flags.dtype} {flags.shape}"
            )
    return {name: tracked[name] for name in estimates}


def check_names(what: str, estimates: Mapping[str, object], given: Mapping[str, object]) -> None:
    """Raise TrajectoryError unless `given` is of just these estimates."""
    if set(given) != set(estimates):
        raise TrajectoryError(
            f"plot of trajectories: expected {what} of {sorted(estimates)}, got those of {sorted(given)}; "
            "give every estimate's"
        )


def marked_frames(drawn: BoolArray, first: int = 0) -> list[int]:
    """Frames of a line that bear its marker: a dozen of those that are drawn (N,), from the one numbered `first` on,
    and those without a neighbour, of which a line shows nothing.
    """
    frames = np.flatnonzero(drawn)
    every = max(len(frames) // 12, 1)
    padded = np.pad(drawn, 1)
    alone = np.flatnonzero(drawn & ~padded[:-2] & ~padded[2:])
    return sorted({*frames[first % every :: every].tolist(), *alone.tolist()})


def tracked_share(tracked: BoolArray) -> str:
    """How much of the frames (N,) was tracked, in words."""
    return f"{percent(float(np.mean(tracked)) if len(tracked) else 0.0)} tracked"
