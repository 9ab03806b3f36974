"""`slamgym scene`: a house at a glance, and in other formats."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import tyro
from rich.table import Table

from slamgym.cli.options import option_group
from slamgym.cli.terminal import light_progress, printing, progress_bar, results, say, show_table, told_warnings
from slamgym.errors import ConfigError
from slamgym.files import check_free
from slamgym.params import DriveParams
from slamgym.scene_report import EXPORTS, SceneReport, check_exports, inspect_scene, write_report

VIEW_PARAMS = (
    "scene_options", "lighting", "brightness", "multisampling", "camera", "camera_height", "occupancy_map",
    "path_length_m",
)  # fmt: skip
ViewOptions = option_group(DriveParams, VIEW_PARAMS, "How the house is loaded, lit and looked at.")

SCENE_HELP = "'procedural:SEED', 'sweethome:SEED', a .glb, .gltf, .obj, .ply or .stl file, or SUNCG's house.json"
OPEN_SHARE_TOLD = 0.01


@dataclass(kw_only=True)
class Scene:
    """Look at a house: 12 views along a path, its plan, its figures, and what was assumed when it was loaded.

    Example: slamgym scene my_flat.glb --scene-options up z unit 0.01 --out out/my_flat
    """

    scene: Annotated[tyro.conf.Positional[str], tyro.conf.arg(metavar="SCENE", help=SCENE_HELP)]
    out: Path
    """Folder to make; it must not exist yet, or be empty."""
    view: tyro.conf.OmitArgPrefixes[ViewOptions]
    seed: Annotated[int, tyro.conf.arg(help="picks the path")] = 0
    export: Annotated[
        tuple[str, ...],
        tyro.conf.arg(
            metavar="|".join(EXPORTS),
            help="also write the house in these formats: house.glb, suncg/",
            help_behavior_hint="(default: none)",
        ),
    ] = ()

    def __call__(self) -> None:
        params = DriveParams.checked({"scene": self.scene, **vars(self.view)})
        self._check()
        check_free(self.out, "folder")
        with told_warnings(), progress_bar("{task.completed:.0f}") as progress:
            task = progress.add_task("loading", total=None)
            report = inspect_scene(params, self.seed, light_progress(progress, task))
        folder = write_report(report, self.out, self.export)
        with printing():
            show_table(_table(report.figures))
            _say_notes(report)
            say(results, f"contact sheet, plan, map: {folder}")

    def _check(self) -> None:
        check_exports(self.export)
        if self.seed < 0:
            raise ConfigError(f"expected a seed of at least 0, got {self.seed}")


def _say_notes(report: SceneReport) -> None:
    for kind in ("assumptions", "defects"):
        for note in report.figures[kind]:
            say(results, f"{kind.removesuffix('s')}: {note}")


def _table(figures: dict[str, Any]) -> Table:
    keypoints = np.array(figures["keypoints_a_view"])
    rooms, rooms_m2, open_share = (figures[name] for name in ("rooms", "rooms_m2", "open_share"))
    rows = {
        "rooms": "not known" if rooms_m2 is None else f"{len(rooms)}, {rooms_m2:.1f} m²",
        "unobstructed floor": f"{figures['unobstructed_m2']:.1f} m²",
        "free for the robot": f"{figures['free_m2']:.1f} m²",
        "triangles": f"{figures['triangles']:,}",
        "textures": f"{figures['textures']} ({figures['texture_megapixels']} megapixels)",
        "lamps, windows": f"{figures['lamps']}, {figures['windows']}",
        "keypoints a view": f"{keypoints.min()} to {keypoints.max()}, median {np.median(keypoints):.0f}",
        "mean grey level": f"{np.mean(figures['brightness_a_view']):.0f}",
    }
    if open_share > OPEN_SHARE_TOLD:
        rows["nothing behind"] = f"{100 * open_share:.0f} % of the pixels: they are black"
    table = Table(box=None, show_header=False, padding=(0, 2, 0, 0))
    for name, value in rows.items():
        table.add_row(name, str(value))
    return table
