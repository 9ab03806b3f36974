"""Why was it lost? Rules that name what stood out in the first lost image and in the step to it.

The thresholds lie between what ORB-SLAM3 was seen to get lost with, in real and in rendered frames, and what frames
look like that it tracks in a calm drive; `examples/losses.py` shows both.
"""

from collections.abc import Callable
from dataclasses import replace
from math import atan2, degrees, isnan
from typing import NamedTuple

from slamgym.types import LossContext

FEW_KEYPOINTS = 100
FEW_KEYPOINTS_OF_USUAL = 0.2
DARK = 30.0
"""Grey levels; counts only where keypoints are few. A bright image without them may well be a white wall."""
BLURRED_OF_USUAL = 0.3
LITTLE_DEPTH = 0.1
LONG_GAP_OF_USUAL = 2.5
SAME_VIEW = 0.9
"""With so much overlap a gap in time has not changed the view."""
FAST_TURN_DEG = 15.0
"""From one frame to the next; FAST_TURN_DEGPS a second is fast, too."""
FAST_TURN_DEGPS = 130.0
FAST_MOTION_DEG = 6.0
"""The angle that the step from one frame to the next takes up, seen from the median depth."""
LOW_OVERLAP = 0.72
FEW_TRACKED = 150
"""They fade when at their pace none is left a second later."""

MAX_PHRASES = 3


def explain(context: LossContext) -> LossContext:
    """The context with its cause, the most telling of CAUSES that holds, and with up to MAX_PHRASES of them in words.

    A figure that is NaN speaks for no cause.
    """
    holding = [rule for rule in _RULES if rule.holds(context)]
    if not holding:
        return replace(context, cause="unknown", explanation="nothing stands out in what the SLAM was given")
    phrases = [rule.phrase(context) for rule in holding[:MAX_PHRASES]]
    return replace(context, cause=holding[0].cause, explanation="; ".join(phrases))


class _Rule(NamedTuple):
    cause: str
    holds: Callable[[LossContext], bool]
    phrase: Callable[[LossContext], str]


def _few_keypoints(c: LossContext) -> bool:
    return c.keypoints < FEW_KEYPOINTS or c.keypoints < FEW_KEYPOINTS_OF_USUAL * c.usual_keypoints


def _long_gap(c: LossContext) -> bool:
    return c.frame_gap_s > LONG_GAP_OF_USUAL * c.usual_frame_gap_s and not c.overlap > SAME_VIEW


def _fast_turn(c: LossContext) -> bool:
    return _turn_deg(c) > FAST_TURN_DEG or c.rotation_rate_degps > FAST_TURN_DEGPS


def _fast_motion(c: LossContext) -> bool:
    return degrees(atan2(_step_m(c), c.median_depth_m)) > FAST_MOTION_DEG


def _fading(c: LossContext) -> bool:
    return c.tracked_points < FEW_TRACKED and c.tracked_points + c.tracked_points_slope < 0


def _turn_deg(c: LossContext) -> float:
    return c.rotation_rate_degps * c.frame_gap_s


def _step_m(c: LossContext) -> float:
    return c.speed_mps * c.frame_gap_s


def _keypoints_phrase(c: LossContext) -> str:
    usual = "" if isnan(c.usual_keypoints) else f", usually {c.usual_keypoints:.0f}"
    return f"few keypoints ({c.keypoints:.0f}{usual})"


_RULES = (
    _Rule(
        "dark",
        lambda c: c.brightness < DARK and _few_keypoints(c),
        lambda c: f"the image is dark (brightness {c.brightness:.0f} of 255)",
    ),
    _Rule(
        "frame_gap",
        _long_gap,
        lambda c: f"{c.frame_gap_s:.2f} s since the last frame, usually {c.usual_frame_gap_s:.2f} s",
    ),
    _Rule(
        "no_depth",
        lambda c: c.valid_depth < LITTLE_DEPTH,
        lambda c: f"hardly any depth ({c.valid_depth:.0%} of the pixels)",
    ),
    _Rule(
        "blur",
        lambda c: c.sharpness < BLURRED_OF_USUAL * c.usual_sharpness,
        lambda c: f"the image is blurred (sharpness {c.sharpness / c.usual_sharpness:.0%} of the usual)",
    ),
    _Rule("few_keypoints", _few_keypoints, _keypoints_phrase),
    _Rule(
        "fast_turn",
        _fast_turn,
        lambda c: f"the camera turned by {_turn_deg(c):.0f} deg in one frame ({c.rotation_rate_degps:.0f} deg/s)",
    ),
    _Rule(
        "fast_motion",
        _fast_motion,
        lambda c: f"the camera moved by {_step_m(c):.2f} m in one frame, seeing what is {c.median_depth_m:.2f} m away",
    ),
    _Rule(
        "low_overlap",
        lambda c: c.overlap < LOW_OVERLAP,
        lambda c: f"only {c.overlap:.0%} of the view before was still in view",
    ),
    _Rule(
        "fading",
        _fading,
        lambda c: (
            f"tracked points were fading ({c.tracked_points:.0f} left, {-c.tracked_points_slope:.0f} fewer a second)"
        ),
    ),
)

CAUSES = (*(rule.cause for rule in _RULES), "unknown")
"""All that `explain` may say, the most telling first."""
