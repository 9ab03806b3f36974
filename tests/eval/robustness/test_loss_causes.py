from dataclasses import fields, replace

import numpy as np
import pytest

from slamgym.eval.robustness import CAUSES, explain
from slamgym.types import LossContext

# A frame of a calm drive at 30 Hz.
CALM = LossContext(
    speed_mps=0.5,
    rotation_rate_degps=20.0,
    frame_gap_s=0.033,
    usual_frame_gap_s=0.033,
    overlap=0.97,
    keypoints=500,
    usual_keypoints=600,
    sharpness=0.18,
    usual_sharpness=0.2,
    brightness=120,
    valid_depth=0.8,
    median_depth_m=1.8,
    tracked_points=300,
    tracked_points_slope=-50,
)
UNKNOWN = LossContext(**dict.fromkeys([f.name for f in fields(LossContext)][:14], np.nan))  # type: ignore[arg-type]


@pytest.mark.parametrize("context", [CALM, UNKNOWN])
def test_where_nothing_stands_out_the_cause_is_unknown(context):
    explained = explain(context)
    assert (explained.cause, explained.explanation) == ("unknown", "nothing stands out in what the SLAM was given")


CHANGES = {
    "dark": (
        {"brightness": 3.2, "keypoints": 0},
        "the image is dark (brightness 3 of 255); few keypoints (0, usually 600)",
    ),
    "frame_gap": (
        {"frame_gap_s": 1.0, "overlap": 0.85, "speed_mps": 0.05, "rotation_rate_degps": 5.0},
        "1.00 s since the last frame, usually 0.03 s",
    ),
    "no_depth": ({"valid_depth": 0.02}, "hardly any depth (2% of the pixels)"),
    "blur": ({"sharpness": 0.008}, "the image is blurred (sharpness 4% of the usual)"),
    "few_keypoints": ({"keypoints": 119}, "few keypoints (119, usually 600)"),  # below a fifth
    "fast_turn": (
        {"rotation_rate_degps": 180.0, "frame_gap_s": 0.1, "usual_frame_gap_s": 0.1, "speed_mps": 0.0},
        "the camera turned by 18 deg in one frame (180 deg/s)",
    ),
    "fast_motion": (
        {"speed_mps": 6.0, "frame_gap_s": 0.05},
        "the camera moved by 0.30 m in one frame, seeing what is 1.80 m away",
    ),
    "low_overlap": ({"overlap": 0.53}, "only 53% of the view before was still in view"),
    "fading": (
        {"tracked_points": 118, "tracked_points_slope": -368},
        "tracked points were fading (118 left, 368 fewer a second)",
    ),
}


@pytest.mark.parametrize("cause", CHANGES)
def test_each_cause_in_words(cause):
    changes, explanation = CHANGES[cause]
    explained = explain(replace(CALM, **changes))
    assert explained == replace(CALM, **changes, cause=cause, explanation=explanation)


@pytest.mark.parametrize("cause", CHANGES)
def test_each_cause_is_told_from_few_figures(cause):
    """Where poses, or depth, or the second before are not known, the others still speak."""
    changes, _ = CHANGES[cause]
    known = {**changes, "usual_sharpness": 0.2, "usual_keypoints": 600, "usual_frame_gap_s": 0.033}
    known |= {"frame_gap_s": 0.033} if cause == "fast_turn" else {}
    known |= {"median_depth_m": 1.8} if cause == "fast_motion" else {}
    assert explain(replace(UNKNOWN, **known)).cause == cause


def test_every_cause_can_be_told():
    assert {*CHANGES, "unknown"} == set(CAUSES)
    assert len(CAUSES) == len(set(CAUSES))


@pytest.mark.parametrize(
    ("changes", "cause"),
    [
        ({"brightness": 10, "keypoints": 500}, "unknown"),  # dark, but full of corners all the same
        # It stood still.
        ({"frame_gap_s": 1.0, "overlap": 0.95, "speed_mps": 0.05, "rotation_rate_degps": 5.0}, "unknown"),
        ({"frame_gap_s": 1.0, "overlap": np.nan, "speed_mps": np.nan, "rotation_rate_degps": np.nan}, "frame_gap"),
        ({"rotation_rate_degps": 80.0, "frame_gap_s": 0.3, "usual_frame_gap_s": 0.3}, "fast_turn"),  # 24 deg
        ({"keypoints": 130, "usual_keypoints": np.nan}, "unknown"),
        ({"keypoints": 90, "usual_keypoints": np.nan}, "few_keypoints"),
        ({"keypoints": 90, "usual_keypoints": 95}, "few_keypoints"),
        ({"tracked_points": 300, "tracked_points_slope": -400}, "unknown"),  # as just after the start of a map
        ({"tracked_points": 100, "tracked_points_slope": np.nan}, "unknown"),
    ],
)
def test_what_tips_the_scales(changes, cause):
    assert explain(replace(CALM, **changes)).cause == cause


def test_a_cause_is_the_most_telling_and_three_are_said():
    changes = {"sharpness": 0.01, "keypoints": 20, "rotation_rate_degps": 400.0, "overlap": 0.3, "tracked_points": 40}
    explained = explain(replace(CALM, **changes))
    assert explained.cause == "blur"
    assert explained.explanation == (
        "the image is blurred (sharpness 5% of the usual); few keypoints (20, usually 600); "
        "the camera turned by 13 deg in one frame (400 deg/s)"
    )


def test_the_figures_stay_as_they_are():
    explained = explain(CALM)
    assert all(getattr(explained, f.name) == getattr(CALM, f.name) for f in fields(CALM)[:14])
