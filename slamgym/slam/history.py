"""What a SLAM was fed lately: from it a loss is explained. A live SLAM's frames are measured only when there is one."""

from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from slamgym.camera import PinholeCamera
from slamgym.eval.robustness import explain
from slamgym.eval.trajectories import step_sizes
from slamgym.eval.views import brightness, keypoint_count, median_depth_m, overlap, sharpness, valid_depth
from slamgym.types import BoolArray, FloatArray, Frame, LossContext, TrackingState, TrackResult

WINDOW_S = 1.0
"""So long before the last fed frame counts as usual."""

MIN_SPACING_S = 0.03
"""Views kept in memory are at least so far apart, but for the last two. Motion is measured over at least as long: over
less, the noise of poses from motion capture would pass for motion."""

DEPTH_STEP = 4
"""Every fourth pixel of the depth, in rows and columns, is enough for its share, its median and the overlap."""


class View(NamedTuple):
    """Measures of one frame's images, see `slamgym.eval.views`."""

    keypoints: float
    sharpness: float
    brightness: float
    valid_depth: float
    median_depth_m: float


class Moment(NamedTuple):
    """One fed frame in numbers. gap_s: since the frame fed before, NaN for the first one. T_world_cam: (4, 4), may be
    NaN. tracked_points: NaN where the SLAM does not tell.
    """

    stamp_ns: int
    gap_s: float
    T_world_cam: FloatArray
    view: View
    tracked: bool
    tracked_points: float


class FrameHistory:
    """The last second of a run, thinned to some 30 frames: its memory is bounded whatever the frame rate."""

    def __init__(self, camera: PinholeCamera) -> None:
        self._camera = camera
        self._seen: list[_Seen] = []
        self._results: list[TrackResult] = []

    def add(self, frame: Frame, result: TrackResult) -> None:
        """Note the next fed frame and what the SLAM said about it; what is needed of the images is copied."""
        self._seen.append(_Seen(frame, self._seen[-1] if self._seen else None))
        self._results.append(result)
        if len(self._seen) > 3 and _seconds(self._seen[-4], self._seen[-3]) < MIN_SPACING_S:
            self._forget(-3)
        while len(self._seen) > 2 and _seconds(self._seen[0], self._seen[-2]) > WINDOW_S:
            self._forget(0)

    def context(self) -> LossContext:
        """What was seen at the frame that was added last, the first of a loss, and what explains the loss."""
        moments = [
            seen.moment(result.state is TrackingState.OK, result.tracked_points)
            for seen, result in zip(self._seen, self._results, strict=True)
        ]
        return loss_context(moments, _overlap(self._seen, self._camera))

    def _forget(self, index: int) -> None:
        del self._seen[index], self._results[index]


class WholeHistory:
    """All frames of a run, in numbers: for a SLAM whose states are known only at the end."""

    def __init__(self, camera: PinholeCamera) -> None:
        self._camera = camera
        self._last: list[_Seen] = []
        self._moments: list[Moment] = []
        self._overlaps: list[float] = []

    def add(self, frame: Frame) -> None:
        """Measure the next fed frame."""
        self._last = [*self._last[-1:], _Seen(frame, self._last[-1] if self._last else None)]
        self._moments.append(self._last[-1].moment(tracked=False, tracked_points=np.nan))
        self._overlaps.append(_overlap(self._last, self._camera))

    def context(self, k: int, tracked: BoolArray) -> LossContext:
        """What was seen at frame k, the first of a loss, had the states been these: bool (N,), for all frames added."""
        since_ns = self._moments[max(k - 1, 0)].stamp_ns - round(WINDOW_S * 1e9)
        recent = [i for i in range(k + 1) if self._moments[i].stamp_ns >= since_ns]
        return loss_context([self._moments[i]._replace(tracked=bool(tracked[i])) for i in recent], self._overlaps[k])


class _Seen:
    """Copies of what is needed of a fed frame's images, measured once, if ever."""

    def __init__(self, frame: Frame, before: "_Seen | None") -> None:
        self.stamp_ns = frame.stamp_ns
        self.gap_s = np.nan if before is None else (frame.stamp_ns - before.stamp_ns) * 1e-9
        self.T_world_cam = frame.T_world_cam.copy()
        self.grey: NDArray[np.uint8] = np.asarray(cv2.cvtColor(frame.rgb, cv2.COLOR_RGB2GRAY), dtype=np.uint8)
        self.depth = frame.depth[::DEPTH_STEP, ::DEPTH_STEP].copy()

    def moment(self, tracked: bool, tracked_points: float) -> Moment:
        return Moment(self.stamp_ns, self.gap_s, self.T_world_cam, self._view, tracked, tracked_points)

    @cached_property
    def _view(self) -> View:
        return View(
            keypoint_count(self.grey),
            sharpness(self.grey),
            brightness(self.grey),
            valid_depth(self.depth),
            median_depth_m(self.depth),
        )


def loss_context(moments: Sequence[Moment], overlap: float) -> LossContext:
    """What was seen at the last of the moments, the first of a loss, beside what the tracked ones before it were like.

    moments: those of the second before, in order; overlap: of the last two fed frames.
    """
    *before, now = moments
    tracked = [moment for moment in before if moment.tracked]
    speed_mps, rotation_rate_degps = _motion(moments)
    return explain(
        LossContext(
            speed_mps=speed_mps,
            rotation_rate_degps=rotation_rate_degps,
            frame_gap_s=now.gap_s,
            usual_frame_gap_s=_median(moment.gap_s for moment in tracked),
            overlap=overlap,
            keypoints=now.view.keypoints,
            usual_keypoints=_median(moment.view.keypoints for moment in tracked),
            sharpness=now.view.sharpness,
            usual_sharpness=_median(moment.view.sharpness for moment in tracked),
            brightness=now.view.brightness,
            valid_depth=now.view.valid_depth,
            median_depth_m=now.view.median_depth_m,
            tracked_points=tracked[-1].tracked_points if tracked else np.nan,
            tracked_points_slope=_slope(tracked),
        )
    )


def _motion(moments: Sequence[Moment]) -> tuple[float, float]:
    """Speed, m/s, and rate of rotation, degrees a second, up to the last moment; NaN where a pose is not known."""
    now = moments[-1]
    before = [moment for moment in moments if _seconds(moment, now) >= MIN_SPACING_S] or moments[:1]
    T = np.array([before[-1].T_world_cam, now.T_world_cam])
    duration_s = _seconds(before[-1], now)
    if not (duration_s > 0 and np.isfinite(T).all()):
        return np.nan, np.nan
    (step_m,), (step_rad,) = step_sizes(T)
    return float(step_m) / duration_s, float(np.rad2deg(step_rad)) / duration_s


def _slope(tracked: Sequence[Moment]) -> float:
    """Least-squares slope of the tracked points, 1/s; NaN below three tracked frames."""
    if len(tracked) < 3:
        return np.nan
    times_s = [_seconds(tracked[-1], moment) for moment in tracked]
    return float(np.polyfit(times_s, [moment.tracked_points for moment in tracked], 1)[0])


def _overlap(seen: Sequence[_Seen], camera: PinholeCamera) -> float:
    """Of the last two frames; NaN with fewer."""
    if len(seen) < 2:
        return np.nan
    before, now = seen[-2:]
    return overlap(before.depth, before.T_world_cam, now.T_world_cam, camera, DEPTH_STEP)


def _median(values: Iterable[float]) -> float:
    """Of those that are known, NaN without any."""
    known = [value for value in values if not np.isnan(value)]
    return float(np.median(known)) if known else np.nan


def _seconds(first: Moment | _Seen, last: Moment | _Seen) -> float:
    return (last.stamp_ns - first.stamp_ns) * 1e-9
