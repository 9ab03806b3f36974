"""A run seen from above, as lines that a browser draws."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np

from slamgym.errors import SequenceError
from slamgym.eval.accuracy import align, is_determined
from slamgym.eval.plots.top_view import from_above, upward_axis
from slamgym.eval.robustness import frames_by_policy
from slamgym.report.page.pictures import data_url
from slamgym.report.page.run_files import RunFiles
from slamgym.study.drive_work import read_facts
from slamgym.types import BoolArray, FloatArray, IntArray

WIDTH = 1000
"""Of the map, in the whole numbers that it is drawn in."""
TALLEST = 1000
LINE_POINTS = 150
"""About so many of a line: more cannot be seen."""
MARGIN, WALLS_M = 0.05, 0.7
"""Shown around what is drawn: a share of its size, and metres where there are walls to be seen."""
SMALLEST_M = 0.5
WALL_RGBA = (128, 128, 128, 110)


class Ground(NamedTuple):
    """What is known of where a drive went: planned path (P, 2), occupied bool (ny, nx) and the rest of the grid."""

    path_xy: FloatArray
    occupied: BoolArray
    origin_xy: FloatArray
    resolution_m: float


@dataclass(frozen=True, slots=True)
class Line:
    """kind: "planned", "truth", "estimate", "other" or "lost". points: as SVG has them."""

    kind: str
    points: str


@dataclass(frozen=True, slots=True)
class Cross:
    """Where loss `number` began."""

    number: int
    x: int
    y: int


@dataclass(frozen=True, slots=True)
class Image:
    """An image in the map, its upper left corner at x, y."""

    url: str
    x: int
    y: int
    width: int
    height: int


@dataclass(frozen=True, slots=True)
class RunMap:
    """metre: its length. kinds: of the lines that there are, for the legend."""

    width: int
    height: int
    metre: int
    walls: Image | None
    lines: tuple[Line, ...]
    crosses: tuple[Cross, ...]
    start: tuple[int, int] | None

    @property
    def kinds(self) -> set[str]:
        return {line.kind for line in self.lines}


class _Frame(NamedTuple):
    """Metres (N, 2) to the map's numbers: y upwards there, downwards here."""

    left: float
    top: float
    scale: float

    def __call__(self, xy: FloatArray) -> IntArray:
        return np.rint((xy - [self.left, self.top]) * [self.scale, -self.scale]).astype(np.int64)


def run_map(run: RunFiles, drive_folder: Path) -> RunMap | None:
    """The map of a run; None where there is nothing to draw. drive_folder: with what is known of the drive, or none."""
    ground = _ground(drive_folder) if run.flat else None
    estimates = list(_estimates(run))
    positions = [run.truth, *(xyz for _, xyz in estimates)]
    known = np.vstack([xyz[_known(xyz)] for xyz in positions])
    if not len(known):
        return None
    upwards = "y" if run.flat else upward_axis(known)
    frame, width, height = _frame(from_above(known, upwards), ground)
    truth = from_above(run.truth, upwards)
    drawn = [("truth", truth), *((kind, from_above(xyz, upwards)) for kind, xyz in estimates)]
    losses = [(loss["start_frame"], loss["end_frame"]) for loss in run.summary.get("losses", ())]
    lost = [("lost", _during(truth, start, end)) for start, end in losses]
    planned = [] if ground is None else [("planned", ground.path_xy)]
    starts = frame(truth[_known(truth)][:1])
    return RunMap(
        width=width,
        height=height,
        metre=round(frame.scale),
        walls=None if ground is None else _walls(ground, frame),
        lines=tuple(line for kind, xy in (*lost, *planned, *drawn) for line in _lines(kind, xy, frame)),
        crosses=tuple(_crosses(truth, [start for start, _ in losses], frame)),
        start=tuple(starts[0].tolist()) if len(starts) else None,
    )


@lru_cache(maxsize=64)
def _ground(drive_folder: Path) -> Ground | None:
    """Runs over the same drive follow each other."""
    try:
        drive = read_facts(drive_folder).episode
    except SequenceError:
        return None
    if drive is None:
        return None
    return Ground(drive.path_xy, drive.grid.occupied, drive.grid.origin_xy, drive.grid.resolution_m)


def _estimates(run: RunFiles) -> Iterator[tuple[str, FloatArray]]:
    """Positions (N, 3) of each map, NaN where it has none, aligned on its own; evaluated maps are an "estimate"."""
    evaluated = frames_by_policy(run.map_ids, run.summary.get("map_policy", "largest"))
    maps = [map_id for map_id in dict.fromkeys(run.map_ids.tolist()) if map_id >= 0]
    if not np.isfinite(run.truth).any():
        # Nothing tells how two maps lie to each other.
        maps = [map_id for map_id in maps if evaluated[run.map_ids == map_id].any()][:1]
    for map_id in maps:
        frames = run.map_ids == map_id
        yield "estimate" if evaluated[frames].any() else "other", _aligned(run, frames)


def _aligned(run: RunFiles, frames: BoolArray) -> FloatArray:
    """Positions (N, 3) in the world; as they are where no true position is known; NaN where too few are."""
    positions = np.where(frames[:, None], run.estimate, np.nan)
    known = _known(run.truth)
    judged = frames & known & _known(run.estimate)
    if not known.any():
        return positions
    ref_T, est_T = _poses(run.truth[judged]), _poses(run.estimate[judged])
    if not is_determined(ref_T, est_T, "se3"):
        return np.full_like(positions, np.nan)
    return align(ref_T, est_T).apply(_poses(positions))[:, :3, 3]


def _known(positions: FloatArray) -> BoolArray:
    """Whether each position (N, d) is known."""
    return np.asarray(np.isfinite(positions).all(axis=1))


def _poses(positions: FloatArray) -> FloatArray:
    """Poses (N, 4, 4) at positions (N, 3): rigid alignment looks at nothing else."""
    T = np.tile(np.eye(4), (len(positions), 1, 1))
    T[:, :3, 3] = positions
    return T


def _frame(known_xy: FloatArray, ground: Ground | None) -> tuple[_Frame, int, int]:
    """What is shown: all positions (K, 2), and the planned path, in a margin; its width and height."""
    shown = known_xy if ground is None else np.vstack([known_xy, ground.path_xy])
    low, high = shown.min(axis=0), shown.max(axis=0)
    size = np.maximum(high - low, SMALLEST_M)
    margin_m = MARGIN * size.max() + (0.0 if ground is None else WALLS_M)
    centre, size = (low + high) / 2.0, size + 2.0 * margin_m
    scale = min(WIDTH / size[0], TALLEST / size[1])
    frame = _Frame(centre[0] - size[0] / 2.0, centre[1] + size[1] / 2.0, float(scale))
    return frame, round(size[0] * scale), round(size[1] * scale)


def _during(xy: FloatArray, start: int, end: int) -> FloatArray:
    """The path (N, 2) from the last frame before a loss to the first one after it."""
    return xy[max(start - 1, 0) : end + 2]


def _lines(kind: str, xy: FloatArray, frame: _Frame) -> Iterator[Line]:
    """A path (N, 2) in pieces between its gaps, each thinned out."""
    step = max(1, len(xy) // LINE_POINTS)
    for piece in pieces(_known(xy)):
        thin = np.unique(np.append(np.arange(piece.start, piece.stop, step), piece.stop - 1))
        yield Line(kind, svg_points(frame(xy[thin])))


def pieces(known: BoolArray) -> list[slice]:
    """Runs of True in bool (N,)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]])))
    return [slice(int(start), int(stop)) for start, stop in zip(edges[::2], edges[1::2], strict=True)]


def svg_points(points: IntArray) -> str:
    """Points (N, 2) as the attribute `points` has them."""
    return " ".join(f"{x},{y}" for x, y in points.tolist())


def _crosses(truth_xy: FloatArray, starts: list[int], frame: _Frame) -> Iterator[Cross]:
    """Where each loss began, where that is known."""
    for number, start in enumerate(starts, start=1):
        if start < len(truth_xy) and np.isfinite(truth_xy[start]).all():
            x, y = frame(truth_xy[start : start + 1])[0].tolist()
            yield Cross(number, x, y)


def _walls(ground: Ground, frame: _Frame) -> Image:
    """The occupied cells as an image, row 0 at the top."""
    ny, nx = ground.occupied.shape
    rgba = np.zeros((ny, nx, 4), dtype=np.uint8)
    rgba[ground.occupied] = WALL_RGBA
    png = cv2.imencode(".png", rgba[::-1])[1].tobytes()
    size_m = np.array([nx, ny]) * ground.resolution_m
    corner = ground.origin_xy + np.array([0.0, size_m[1]])
    x, y = frame(corner[None])[0].tolist()
    width, height = np.rint(size_m * frame.scale).astype(int).tolist()
    return Image(data_url("png", png), x, y, width, height)
