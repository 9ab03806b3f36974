"""Do houses look real? Figures of frames along a path through each, beside those of recorded frames."""

from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import tyro
from scipy.stats import wasserstein_distance

from slamgym.agents.planner import plan_path
from slamgym.eval.plots.style import TRUTH, legend_below, look, new_figure, save_figure, tidy
from slamgym.eval.views import brightness, keypoint_count, sharpness
from slamgym.geometry import mast_camera_pose
from slamgym.params import DriveParams
from slamgym.render import Renderer
from slamgym.stage import load_stage

GREYS = np.arange(256)
DARK, BRIGHT = 32, 223
CELL_PX = 80


def main(
    scenes: tuple[str, ...] = ("procedural:0", "procedural:3", "procedural:5"),
    real: Path | None = None,
    seed: int = 0,
    frames: int = 60,
    path_length_m: float = 15.0,
    camera: str = "tum_fr1",
    out: Path | None = None,
) -> None:
    """Print the table, and write it to the folder `out` with histograms. real: folder of a recorded sequence.

    Figures are means over the frames. corners: of FAST, as ORB-SLAM looks for them first. cells: share of the image's
    cells of 80 px with a corner. gradient: grey levels a pixel. dark, bright: share of the pixels below 32, above 223.
    distance: grey levels that the mean histogram has to be moved by to become that of the recorded frames.
    """
    greys = {"real": list(recorded(real, frames))} if real else {}
    for scene in scenes:
        params = DriveParams(scene=scene, path_length_m=path_length_m, camera=camera)
        greys[Path(scene).name] = list(rendered(params, seed, frames))
    table = pd.DataFrame({name: pd.DataFrame(map(figures, images)).mean() for name, images in greys.items()}).T
    histograms = pd.DataFrame({name: histogram(images) for name, images in greys.items()}, index=GREYS)
    if real:
        table["distance"] = [wasserstein_distance(GREYS, GREYS, histograms["real"], histograms[n]) for n in table.index]
    print(table.to_string(float_format="%.3g"))
    print(f"looked at {frames} frames of each")
    if out is not None:
        write(out, table, histograms)


def recorded(folder: Path, count: int) -> Iterator[np.ndarray]:
    """Grey images (H, W) of a sequence, evenly chosen."""
    files = sorted((folder / "rgb").iterdir())
    for index in np.linspace(0, len(files) - 1, count).astype(int):
        image = cv2.imread(str(files[index]), cv2.IMREAD_GRAYSCALE)
        assert image is not None, f"expected an image, got {files[index]}"
        yield image


def rendered(params: DriveParams, seed: int, count: int) -> Iterator[np.ndarray]:
    """Grey images (H, W) along the path that a seed picks."""
    stage = load_stage(params)
    path = plan_path(stage.grid, stage.free, params.path_length_m, np.random.default_rng(seed))
    with Renderer(stage.house, params.camera, params.lighting, params.brightness) as renderer:
        for s in np.linspace(0.0, path.length_m, count):
            x, y = path.point_at(s)
            rgb, _ = renderer.render(mast_camera_pose(x, y, path.heading_at(s), params.camera_height))
            yield cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY)


def figures(grey: np.ndarray) -> dict[str, float]:
    """What a row of the table is the mean of."""
    gradient = np.hypot(*np.gradient(grey.astype(np.float32)))
    return {
        "corners": keypoint_count(grey),
        "cells": cells_with_corners(grey),
        "gradient mean": float(gradient.mean()),
        "gradient median": float(np.median(gradient)),
        "sharpness": sharpness(grey),
        "brightness": brightness(grey),
        "deviation": float(grey.std()),
        "dark": float(np.mean(grey < DARK)),
        "bright": float(np.mean(grey > BRIGHT)),
    }


def cells_with_corners(grey: np.ndarray) -> float:
    rows, columns = (range(0, size - CELL_PX + 1, CELL_PX) for size in grey.shape)
    cells = [grey[y : y + CELL_PX, x : x + CELL_PX] for y in rows for x in columns]
    return float(np.mean([keypoint_count(cell) > 0 for cell in cells]))


def histogram(images: list[np.ndarray]) -> np.ndarray:
    """Share of the pixels (256,) that have each grey level."""
    counts = np.bincount(np.concatenate([image.ravel() for image in images]), minlength=len(GREYS))
    return np.asarray(counts / counts.sum())


def write(out: Path, table: pd.DataFrame, histograms: pd.DataFrame) -> None:
    out.mkdir(parents=True, exist_ok=True)
    table.to_csv(out / "realism.csv", index_label="frames of")
    histograms.to_csv(out / "histograms.csv", index_label="grey level")
    figure = new_figure(7.0, 3.5)
    axes = figure.add_subplot()
    lines = []
    for index, (name, shares) in enumerate(histograms.items()):
        smooth = shares.rolling(5, center=True, min_periods=1).mean()
        colour, dash, _ = look(index)
        style = {"color": TRUTH, "linewidth": 2.0} if name == "real" else {"color": colour, "linestyle": dash}
        lines += axes.plot(GREYS, smooth, label=name, **style)
    axes.set(xlabel="grey level", ylabel="share of the pixels", xlim=(0, 255), ylim=(0, None))
    tidy(axes)
    legend_below(figure, lines)
    save_figure(figure, out / "histograms")


if __name__ == "__main__":
    tyro.cli(main)
