"""`slamgym scene`: a house at a glance, and in other formats."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import tyro
from rich.table import Table

from slamgym.cli.options import option_group
from slamgym.cli.terminal import light_progress, printing, progress_bar, results, say, show_table, told_warnings
from slamgym.errors import ConfigError, unknown_word
from slamgym.files import check_free
from slamgym.params import DriveParams
from slamgym.scene_report import SceneReport, inspect_scene, write_report
from slamgym.scenes.export import write_glb, write_suncg

VIEW_PARAMS = (
    "scene_options", "lighting", "brightness", "multisampling", "camera", "camera_height", "occupancy_map",
    "path_length_m",
)  # fmt: skip
ViewOptions = option_group(DriveParams, VIEW_PARAMS)

EXPORTS = {
    "glb": lambda house, folder: write_glb(house, folder / "house.glb"),
    "suncg": lambda house, folder: write_suncg(house, folder / "suncg"),
}
"""Format -> what writes a house in it into the report's folder."""


@dataclass(kw_only=True)
class Scene:
    """Look at a house: 12 views along a path, its plan, its figures, and what was assumed when it was loaded.

    Example: slamgym scene my_flat.glb --scene-options up z unit 0.01 --out out/my_flat
    """

    scene: Annotated[
        tyro.conf.Positional[str], tyro.conf.arg(metavar="SCENE", help="'procedural:SEED', 'sweethome:SEED', or a file")
    ]
    out: Path
    """Folder to make; it must not exist yet, or be empty."""
    view: tyro.conf.OmitArgPrefixes[ViewOptions]
    seed: Annotated[int, tyro.conf.arg(help="picks the path")] = 0
    export: Annotated[
        tuple[str, ...], tyro.conf.arg(metavar="glb|suncg", help="also write the house in these formats")
    ] = ()

    def __call__(self) -> None:
        params = DriveParams.checked({"scene": self.scene, **vars(self.view)})
        self._check()
        check_free(self.out, "folder")
        with told_warnings(), progress_bar("{task.completed:.0f}") as progress:
            task = progress.add_task("loading", total=None)
            report = inspect_scene(params, self.seed, light_progress(progress, task))
        folder = write_report(report, self.out)
        for name in self.export:
            EXPORTS[name](report.stage.house, folder)
        with printing():
            show_table(_table(report.figures))
            _say_notes(report)
            say(results, f"contact sheet, plan, map: {folder}")

    def _check(self) -> None:
        for name in self.export:
            if name not in EXPORTS:
                raise ConfigError(unknown_word("export", name, EXPORTS))
        if self.seed < 0:
            raise ConfigError(f"expected a seed of at least 0, got {self.seed}")


def _say_notes(report: SceneReport) -> None:
    for kind in ("assumptions", "defects"):
        for note in report.figures[kind]:
            say(results, f"{kind.removesuffix('s')}: {note}")


def _table(figures: dict[str, Any]) -> Table:
    keypoints = np.array(figures["keypoints_a_view"])
    rows = {
        "rooms": len(figures["rooms"]) or "not known",
        "floor": f"{figures['floor_m2']:.1f} m²",
        "free for the robot": f"{figures['free_m2']:.1f} m²",
        "triangles": f"{figures['triangles']:,}",
        "textures": f"{figures['textures']} ({figures['texture_megapixels']} megapixels)",
        "lamps, windows": f"{figures['lamps']}, {figures['windows']}",
        "keypoints a view": f"{keypoints.min()} to {keypoints.max()}, median {np.median(keypoints):.0f}",
        "mean grey level": f"{np.mean(figures['brightness_a_view']):.0f}",
    }
    table = Table(box=None, show_header=False, padding=(0, 2, 0, 0))
    for name, value in rows.items():
        table.add_row(name, str(value))
    return table
