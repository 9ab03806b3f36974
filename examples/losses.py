"""Why was it lost? Drives are disturbed in known ways: does the SLAM lose track, and is the cause told?

Each drive is rendered once. First the SLAM gets it as it is, to see how far the figures of a loss's context go where
all is well, then once for each disturbance.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace

import cv2
import numpy as np
import pandas as pd
import tyro

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.eval.datasets import Sequence
from slamgym.eval.episode import summarize_slam
from slamgym.eval.robustness import explain
from slamgym.params import SlamParams
from slamgym.recording import recorded_drive
from slamgym.slam.history import FrameHistory
from slamgym.slam.record import SlamRun, run_sequence
from slamgym.types import Frame, LossContext, TrackingState

FROM, TO = 60, 72
"""Frames that images are disturbed in."""

DISTURBANCES: dict[str, Callable[[Sequence], Iterator[Frame]]] = {
    "dark": lambda seq: _disturbed(seq, lambda f: replace(f, rgb=(f.rgb * 0.03).astype(np.uint8))),
    "blur": lambda seq: _disturbed(seq, lambda f: replace(f, rgb=np.asarray(cv2.GaussianBlur(f.rgb, (0, 0), 12)))),
    "bare": lambda seq: _disturbed(seq, lambda f: replace(f, rgb=_covered(f.rgb))),
    "no depth": lambda seq: _disturbed(seq, lambda f: replace(f, depth=0 * f.depth), FROM, len(seq)),
    "gap": lambda seq: map(seq.frame, [*range(FROM), *range(min(FROM + 60, len(seq) - 30), len(seq))]),
    "jumps": lambda seq: map(seq.frame, [*range(FROM), *range(FROM, len(seq), 12)]),
}


def main(
    scenes: tuple[str, ...] = ("procedural:0", "procedural:3", "procedural:5"),
    seeds: tuple[int, ...] = (7, 1, 3),
    slam: str = "orbslam3",
    speed: float = 0.5,
    path_length_m: float = 4.0,
    camera: str = "default",
) -> None:
    """Print what a calm drive looks like, and each disturbance with what was told of it; a scene goes with a seed."""
    params = SlamParams.checked({"slam": slam})
    calm: list[LossContext] = []
    rows = []
    for scene, seed in zip(scenes, seeds, strict=True):
        drive = {"scene": scene, "speed": speed, "path_length_m": path_length_m, "camera": camera}
        with recorded_drive(PathFollower(), seed, **drive) as sequence:
            calm += watched(sequence, params)
            for name, disturb in DISTURBANCES.items():
                rows.append({"scene": scene, "disturbance": name, **told(sequence, params, disturb(sequence))})
    print_calm(calm)
    print(pd.DataFrame(rows).to_string(index=False, max_colwidth=70))


def watched(sequence: Sequence, params: SlamParams) -> list[LossContext]:
    """What would have been told of each frame that was tracked, but for the first second."""
    contexts = []
    with params.session(params.config(sequence.camera, sequence.fps)) as session:
        history = FrameHistory(sequence.camera)
        for frame in sequence.frames():
            result = session.track(frame)
            history.add(frame, result)
            if result.state is TrackingState.OK and frame.stamp_ns > 1e9:
                contexts.append(explain(history.context()))
    return contexts


def told(sequence: Sequence, params: SlamParams, frames: Iterator[Frame]) -> dict[str, str]:
    """Whether a disturbed drive was lost, and what was told of the first loss."""
    with params.session(params.config(sequence.camera, sequence.fps)) as session:
        summary = summarize_slam(run_sequence(SlamRun(session), frames))
    row = {"lost": "no", "status": summary["status"], "cause": "", "explanation": ""}
    if losses := summary["losses"]:
        context = losses[0]["context"]
        told_of_it = {"cause": context["cause"], "explanation": context["explanation"]}
        row |= {"lost": f"frame {losses[0]['start_frame']}", **told_of_it}
    return row


def print_calm(contexts: list[LossContext]) -> None:
    """How far the figures went in frames that were tracked, and which causes would have been told of them."""
    table = pd.DataFrame([{name: getattr(c, name) for name in LossContext.__dataclass_fields__} for c in contexts])
    figures = table.drop(columns=["cause", "explanation"]).astype(float)
    print(f"{len(table)} tracked frames of calm drives:")
    print(figures.describe(percentiles=[]).loc[["min", "max"]].T.to_string(float_format="%.2f"))
    print(table["cause"].value_counts().to_string())


def _disturbed(
    sequence: Sequence, change: Callable[[Frame], Frame], first: int = FROM, end: int = TO
) -> Iterator[Frame]:
    return (change(frame) if first <= k < end else frame for k, frame in enumerate(sequence.frames()))


def _covered(rgb: np.ndarray) -> np.ndarray:
    """All but the right 5 % of the image plain."""
    plain = rgb.copy()
    plain[:, : round(0.95 * rgb.shape[1])] = 150
    return plain


if __name__ == "__main__":
    tyro.cli(main)
