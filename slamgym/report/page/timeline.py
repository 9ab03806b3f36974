"""What happened in a run over time, as strips that a browser draws one below the other."""

from dataclasses import dataclass

import numpy as np

from slamgym.report.page.run_files import RunFiles
from slamgym.report.page.run_map import LINE_POINTS, pieces, svg_points
from slamgym.report.wording import number
from slamgym.types import BoolArray, FloatArray

WIDTH, HEIGHT = 1000, 100
"""Of a strip, in the whole numbers that it is drawn in."""
THINNEST = 4
"""Of what is shown in a strip: a loss of one frame is seen, too."""


@dataclass(frozen=True, slots=True)
class Span:
    """A time in which the SLAM's state was the same."""

    state: str
    x: int
    width: int


@dataclass(frozen=True, slots=True)
class Curve:
    """A figure over time: lines as SVG has their points; the top of the strip is `top`, its bottom `bottom`."""

    label: str
    unit: str
    lines: tuple[str, ...]
    top: float
    bottom: float

    @property
    def range_text(self) -> str:
        return f"{number(self.bottom)} to {number(self.top)} {self.unit}".rstrip()


@dataclass(frozen=True, slots=True)
class Timeline:
    """duration_s: from the strips' left end to their right one."""

    duration_s: float
    spans: tuple[Span, ...]
    curves: tuple[Curve, ...]

    @property
    def states(self) -> set[str]:
        return {span.state for span in self.spans}


def timeline(run: RunFiles) -> Timeline | None:
    """The timeline of a run; None where no frame was fed."""
    if not len(run.fed_s):
        return None
    duration_s = max(float(run.fed_s[-1]), 1e-9)
    tracked_points = np.where(run.tracked, run.tracked_points, np.nan)
    figures = (
        ("tracked points", "", run.fed_s, tracked_points),
        ("speed", "m/s", run.frames_s, run.speed_mps),
        ("turn rate", "°/s", run.frames_s, run.turn_degps),
    )
    curves = (_curve(label, unit, times, values, duration_s) for label, unit, times, values in figures)
    return Timeline(duration_s, _spans(run, duration_s), tuple(curve for curve in curves if curve.lines))


def _spans(run: RunFiles, duration_s: float) -> tuple[Span, ...]:
    """The states in turn, each until the next one begins."""
    states = np.array(run.states)
    starts = np.flatnonzero(np.append(True, states[1:] != states[:-1]))
    x = _x(np.append(run.fed_s[starts], duration_s), duration_s)
    widths = np.maximum(np.diff(x), THINNEST)
    return tuple(
        Span(str(state), int(left), int(width)) for state, left, width in zip(states[starts], x, widths, strict=False)
    )


def _curve(label: str, unit: str, times_s: FloatArray, values: FloatArray, duration_s: float) -> Curve:
    known = np.isfinite(values)
    top, bottom = (max(0.0, float(np.max(values, where=known, initial=0.0))), min(0.0, _lowest(values, known)))
    y = np.rint(HEIGHT * (top - values[known]) / max(top - bottom, 1e-9))
    points = np.zeros((len(values), 2), dtype=np.int64)
    points[known] = np.column_stack([_x(times_s[known], duration_s), y])
    lines = (svg_points(points[_thinned(piece, values, len(values))]) for piece in pieces(known))
    return Curve(label, unit, tuple(lines), top, bottom)


def _lowest(values: FloatArray, known: BoolArray) -> float:
    return float(np.min(values, where=known, initial=0.0))


def _x(times_s: FloatArray, duration_s: float) -> FloatArray:
    return np.rint(WIDTH * times_s / duration_s).astype(np.int64)


def _thinned(piece: slice, values: FloatArray, n: int) -> list[int]:
    """Rows of a piece, of every few neighbours the lowest and the highest: no peak is lost."""
    size = max(1, 2 * n // LINE_POINTS)
    rows: set[int] = {piece.start, piece.stop - 1}
    for start in range(piece.start, piece.stop, size):
        window = values[start : min(start + size, piece.stop)]
        rows |= {start + int(np.argmin(window)), start + int(np.argmax(window))}
    return sorted(rows)
