"""The sequence that estimates are compared with: the truth at its frames, and how the comparison is made."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from pydantic import Field

from slamgym.checked_params import Params
from slamgym.errors import ConfigError, TrajectoryError
from slamgym.eval import doubts
from slamgym.eval.trajectories import Trajectory, fill_holes, find_holes, interpolate, match_stamps
from slamgym.types import BoolArray, IntArray

MAX_GAP_S = 1.0
USUAL_STEPS = 5
"""Where the frames are not known, gaps of up to so many usual steps of the estimate count as tracked, but none of more
than MAX_GAP_S."""


class EvalParams(Params):
    """How an estimate is compared with the truth."""

    alignment: Literal["se3", "sim3", "first_pose", "none"] = Field(
        "se3", description="of the estimate to the truth; sim3 also corrects the scale, which hides an error of RGB-D"
    )
    association: Literal["tum", "evo"] = Field("tum", description="by whose rule poses belong together")
    max_difference_s: float = Field(0.02, gt=0, le=3600, description="longest time between two such poses, s")
    max_gap_s: float | None = Field(
        None,
        ge=0,
        le=3600,
        description=f"longest time without a pose that counts as tracked, s; None: {USUAL_STEPS} usual steps of the "
        f"estimate, 0.1 to {MAX_GAP_S:g} s; not with frames, which tell",
    )

    @property
    def max_difference_ns(self) -> int:
        return round(self.max_difference_s * 1e9)


@dataclass(frozen=True, slots=True, eq=False)
class Reference:
    """A sequence to judge estimates of, made by `prepare`.

    truth: the true poses. whole: true poses at the N frames, interpolated where the truth has none. real: bool (N,),
    where it has one. frames_known: whether the frames were given.
    """

    truth: Trajectory
    whole: Trajectory
    real: BoolArray
    frames_known: bool


def prepare(ref: Trajectory, params: EvalParams, frames_ns: IntArray | None = None) -> Reference:
    """The truth for `evaluate_at`; arguments, errors and warnings as for `evaluate`."""
    if not len(ref):
        raise TrajectoryError("expected a truth with poses, got none")
    if frames_ns is None:
        whole = fill_holes(ref, MAX_GAP_S)
        reference = Reference(ref, whole, np.isin(whole.stamps_ns, ref.stamps_ns), False)
    elif params.max_gap_s is None:
        reference = _at_frames(ref, np.asarray(frames_ns, dtype=np.int64), params)
    else:
        raise ConfigError(f"expected no max_gap_s with frames, which tell every gap; got {params.max_gap_s:g} s")
    doubts.tell(doubts.of_holes(ref, find_holes(ref, MAX_GAP_S), int((~reference.real).sum()), len(reference.whole)))
    return reference


def _at_frames(ref: Trajectory, frames_ns: IntArray, params: EvalParams) -> Reference:
    whole = Trajectory(frames_ns, interpolate(ref, frames_ns))
    real = np.zeros(len(whole), dtype=np.bool_)
    real[match_stamps(ref.stamps_ns, frames_ns, params.max_difference_ns)[1]] = True
    if not real.any():
        raise TrajectoryError(
            f"expected frames with a true pose within {params.max_difference_s:g} s, got {len(frames_ns)} without: "
            "are frames and truth of the same sequence?"
        )
    return Reference(ref, whole, real, True)


def max_gap_s(truth: Trajectory, est: Trajectory, params: EvalParams) -> float:
    """What was asked for, or what the estimate's own rate tells, up to MAX_GAP_S; not below the truth's rate."""
    est_s, true_s = (float(np.median(np.diff(t.stamps_ns))) * 1e-9 if len(t) > 1 else 0.0 for t in (est, truth))
    wanted_s = min(MAX_GAP_S, max(0.1, USUAL_STEPS * est_s)) if params.max_gap_s is None else params.max_gap_s
    return max(wanted_s, 2 * true_s)
