"""The camera of a recorded sequence: its camera.yaml, or a preset that a name stands for."""

import re
from dataclasses import asdict
from pathlib import Path

import yaml
from pydantic import PositiveFloat

from slamgym.camera import CAMERAS, LENSES, PinholeCamera
from slamgym.checked_params import Params
from slamgym.errors import ConfigError, SequenceError, unknown_word

CAMERA_FILE = "camera.yaml"
TUM_DEPTH_SCALE = 5000.0
PRESETS = CAMERAS | LENSES
"""A real lens, with its distortion, before the camera to render with that bears its name."""

_LARGEST_FILE = 1 << 14
# All keys, and the list of the distortion.
_MOST_COLLECTIONS = 2
_FREIBURG = re.compile(r"(?:freiburg|tum_fr)([123])_")


class CameraFile(Params):
    """The keys of a camera.yaml: those of `PinholeCamera`, how many units of a depth image are a metre, and the frames
    a second if it tells them. Numbers may be words: YAML's reader takes 1e-5, without a point, for one.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, ...] = ()
    depth_scale: PositiveFloat = TUM_DEPTH_SCALE
    fps: PositiveFloat | None = None

    @property
    def pinhole(self) -> PinholeCamera:
        """Raises ConfigError for values that no camera has."""
        return PinholeCamera(**self.model_dump(exclude={"depth_scale", "fps"}))


_KEYS = ", ".join(CameraFile.model_fields)


def find_camera(folder: Path, given: str | None = None) -> CameraFile:
    """The camera of the sequence in `folder`.

    given: a preset of LENSES or CAMERAS, which takes only the depth scale and the rate from the folder's camera.yaml,
    or the path of another camera.yaml. None: the folder's camera.yaml; else the preset that the name of the folder
    tells (`rgbd_dataset_freiburg1_xyz`). Raises SequenceError.
    """
    if given is not None and given not in PRESETS:
        return _read_given(given)
    own_path = folder / CAMERA_FILE
    own = read_camera(own_path) if own_path.exists() else None
    if given is not None:
        return _from_preset(given, own)
    if own is not None:
        return own
    if told := _FREIBURG.search(folder.resolve().name):
        return _from_preset(f"tum_fr{told[1]}", None)
    raise SequenceError(
        f"{folder}: expected to know the camera, got no {CAMERA_FILE}: give --camera {'|'.join(LENSES)}, or write a "
        f"{CAMERA_FILE} there with the keys {_KEYS} (the last three are optional)"
    )


def read_camera(path: Path) -> CameraFile:
    """Read a camera.yaml; raises SequenceError that names the file and what is wrong with it."""
    try:
        camera = CameraFile.checked(_mapping(path))
        _ = camera.pinhole
    except (OSError, ValueError, OverflowError, RecursionError, yaml.YAMLError) as error:
        reason = error.strerror if isinstance(error, OSError) else " ".join(str(error).split())
        raise SequenceError(f"{path}: expected the keys {_KEYS}, got: {str(reason)[:300]}; correct the file") from None
    return camera


def write_camera(path: Path, camera: PinholeCamera, fps: float) -> None:
    """Write a camera.yaml for depth images of TUM's scale, as `read_camera` reads it back; raises OSError."""
    values = {**asdict(camera), "distortion": list(camera.distortion)}
    values |= {"depth_scale": TUM_DEPTH_SCALE, "fps": float(fps)}
    path.write_text(yaml.safe_dump(values, sort_keys=False), encoding="utf-8")


def _from_preset(name: str, own: CameraFile | None) -> CameraFile:
    values = asdict(PRESETS[name])
    return CameraFile(**values) if own is None else own.model_copy(update=values)


def _read_given(given: str) -> CameraFile:
    path = Path(given)
    if not path.exists():
        raise SequenceError(f"{unknown_word('camera', given, PRESETS)}; or the path of a {CAMERA_FILE}")
    return read_camera(path)


def _mapping(path: Path) -> dict[str, object]:
    """The keys and values of a YAML file. Raises OSError, ValueError, RecursionError, YAMLError."""
    if not path.is_file() or path.stat().st_size > _LARGEST_FILE:
        raise ConfigError(f"no file of at most {_LARGEST_FILE} bytes")
    text = path.read_text(encoding="utf-8")
    _check_flat(text)
    values = yaml.safe_load(text)
    if not isinstance(values, dict):
        raise ConfigError("no keys")
    return {str(key): value for key, value in values.items()}


def _check_flat(text: str) -> None:
    """Refuse what would unfold to more than the memory holds, or nest too deep to be read: a camera needs neither."""
    collections = 0
    for event in yaml.parse(text, Loader=yaml.SafeLoader):
        collections += isinstance(event, yaml.CollectionStartEvent)
        if collections > _MOST_COLLECTIONS or isinstance(event, yaml.AliasEvent):
            raise ConfigError("an alias, or more lists than the one of the distortion")
