"""The formats of recorded sequences, and the reader that fits a folder."""

from importlib import import_module
from pathlib import Path
from types import ModuleType

from slamgym.errors import SequenceError
from slamgym.eval.datasets.sequence import Sequence

FORMATS = {
    "tum": "slamgym.eval.datasets.tum:read_folder",
}
"""Name -> "module:function", which reads (folder: Path, camera: str | None) -> Sequence. Beside it the module has
`recognise(folder: Path) -> bool`, which tells by the names of files whether a folder has the format."""


def read_sequence(folder: Path | str, camera: str | None = None) -> Sequence:
    """The recorded sequence in a folder, whichever of FORMATS it has; images are read when they are asked for.

    camera: a preset of `slamgym.camera.LENSES` or `CAMERAS`, or the path of a camera.yaml; None for the sequence's own
    camera.yaml, or the preset that its folder's name tells (`rgbd_dataset_freiburg1_xyz`).

    A frame has the stamp of its colour image. True poses are interpolated between those of the truth, and held beyond
    its ends; `has_truth` says where the truth has one within 0.02 s. TrajectoryWarning tells what was left out or
    repaired. Raises SequenceError with the file, and the line where there is one.
    """
    folder = Path(folder)
    module, function = _find_reader(folder)
    try:
        sequence: Sequence = getattr(module, function)(folder, camera)
    except OSError as error:
        raise SequenceError(f"cannot read the sequence {folder}: {error.strerror}") from None
    return sequence


def _find_reader(folder: Path) -> tuple[ModuleType, str]:
    try:
        if not folder.is_dir():
            raise SequenceError(f"{folder}: expected the folder of a sequence, got none: is the path right?")
        for entry in FORMATS.values():
            name, _, function = entry.partition(":")
            if (module := import_module(name)).recognise(folder):
                return module, function
    except OSError as error:
        raise SequenceError(f"cannot read the sequence {folder}: {error.strerror}") from None
    raise SequenceError(
        f"{folder}: expected a sequence of one of the formats {', '.join(FORMATS)} (TUM RGB-D: rgb.txt and depth.txt, "
        "or associations.txt), got none of their files: is it the folder inside of it?"
    )
