"""What the page tells of a single run, as long as there is room."""

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
from markupsafe import Markup

from slamgym.eval.plots.names import percent
from slamgym.report.causes import told
from slamgym.report.page.pictures import data_url
from slamgym.report.page.repeat import replay_line
from slamgym.report.page.run_files import RunFiles, read_run
from slamgym.report.page.run_map import run_map
from slamgym.report.page.tables import shown_value
from slamgym.report.page.templates import filled
from slamgym.report.page.timeline import timeline
from slamgym.study.loss_views import LOSSES
from slamgym.study.results import StudyResults
from slamgym.study.table import succeeded

ROOM = 15_000_000
"""Bytes of the page that runs may take."""
KEPT_ROOM = 5_000_000
"""Of these, what strips of frames leave: better many runs without them than few with."""
MOST_RUNS = 1000
"""Runs that the page tells of: reading one takes some hundredths of a second."""

SHARE = "share"

FIGURES = {
    "ATE": ("ate_rmse_m", "{:.4f} m"),
    "ATE, last pose held": ("ate_held_rmse_m", "{:.4f} m"),
    "RPE over 1 s": ("rpe_second_trans_rmse_m", "{:.4f} m"),
    "rotation over 1 s": ("rpe_second_rot_mean_deg", "{:.2f}°"),
    "completion": ("completion", SHARE),
    "frames fed": ("frames_fed", "{:,}"),
    "frames dropped": ("frames_dropped", "{:,}"),
    "maps": ("maps", "{}"),
    "loops closed": ("loops_closed", "{}"),
    "tracked points, median": ("tracked_points_median", "{:.0f}"),
    "path driven": ("progress_m", "{:.2f} m"),
    "frames with a collision": ("collision_steps", "{}"),
    "time a frame, median": ("timing.track_ms_median", "{:.1f} ms"),
}
"""Label -> key in `episode.json`, dots for what is within another, and the format of its value."""


@dataclass(frozen=True, slots=True)
class Strip:
    """Frames around a loss: in the page, or where their file is."""

    url: str
    embedded: bool


@dataclass(frozen=True, slots=True)
class Detail:
    """What the page tells of the run in this row of the table, as HTML."""

    row: int
    html: Markup


def details(results: StudyResults, page_folder: Path) -> Iterator[Detail]:
    """Of as many runs as there is room for, those that failed first; the table has all of them."""
    room = ROOM
    failed_first = np.argsort(succeeded(results.runs).to_numpy(), kind="stable")[:MOST_RUNS].tolist()
    run_ids, drive_ids = (results.runs[name].astype(str).tolist() for name in ("run_id", "drive_id"))
    for row in failed_first:
        folder = results.folder / "runs" / run_ids[row]
        run = read_run(folder)
        if run is None:
            continue
        losses = list(_losses(run, folder, runs_url(results, page_folder) + quote(run_ids[row]), room - KEPT_ROOM))
        html = _html(run, losses, results.folder / "drives" / drive_ids[row], replay_line(folder))
        if len(html) > room:
            return
        room -= len(html)
        yield Detail(row, html)


def runs_url(results: StudyResults, page_folder: Path) -> str:
    """From the page to the run folders."""
    return quote(os.path.relpath(results.folder / "runs", page_folder)) + "/"


def _html(run: RunFiles, losses: list[dict[str, Any]], drive_folder: Path, repeat: str | None) -> Markup:
    return filled(
        "run.html",
        failure=run.summary.get("failure", ""),
        map=run_map(run, drive_folder),
        timeline=timeline(run),
        figures=_figures(run.summary),
        losses=losses,
        repeat=repeat,
    )


def _figures(summary: Mapping[str, Any]) -> dict[str, str]:
    """Those of FIGURES that the run has, as text."""
    known = {label: (_at(summary, key), style) for label, (key, style) in FIGURES.items()}
    return {
        label: percent(value) if style == SHARE else shown_value(value, style)
        for label, (value, style) in known.items()
        if value is not None
    }


def _at(summary: Mapping[str, Any], key: str) -> Any:
    """The value at "a.b", None where it is not there."""
    value: Any = summary
    for name in key.split("."):
        value = value.get(name) if isinstance(value, Mapping) else None
    return value


def _losses(run: RunFiles, folder: Path, url: str, room: int) -> Iterator[dict[str, Any]]:
    """The run's losses, as in its `episode.json`, each with the strip of frames around it; room: for all strips.

    url: of the run's folder.
    """
    for number, loss in enumerate(run.summary.get("losses", ()), start=1):
        strip = _strip(folder / LOSSES / f"{number}.jpg", f"{url}/{LOSSES}/{number}.jpg", room)
        if strip is not None and strip.embedded:
            room -= len(strip.url)
        context = loss.get("context") or {}
        yield {**loss, "context": context, "cause": told(str(context.get("cause") or "unknown")), "strip": strip}


def _strip(file: Path, url: str, room: int) -> Strip | None:
    """None where there is no file: not of every loss is one kept."""
    if not file.is_file():
        return None
    embedded = data_url("jpeg", file.read_bytes())
    return Strip(embedded, True) if len(embedded) <= room else Strip(url, False)
