"""Baked light kept in the user's cache folder: $SLAMGYM_CACHE, else slamgym in $XDG_CACHE_HOME or in ~/.cache."""

import fcntl
import hashlib
import os
import time
import zipfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from slamgym.errors import OutputError
from slamgym.files import draft
from slamgym.scenes.house import House, Part
from slamgym.scenes.light.bake import bake_light

VERSION = 2
"""Goes up when `bake_light` gives other light for the same house."""
MOST_BYTES = 2_000_000_000
WAIT_S = 120.0
"""So long a process waits for another one that bakes the same house; then it bakes too."""

STORED = {"vertices": 3, "faces": 3, "uv": 2, "colour": 3, "light": 3}
"""Arrays of a part that are kept, and their columns; none are kept as no rows."""

Array = NDArray[np.generic]


def baked(house: House, on_progress: Callable[[float], None] | None = None) -> House:
    """`bake_light` of the house, taken from the cache folder when it was baked before, by any process.

    Several processes may ask for the same house: one bakes it, the others wait. A file that cannot be read is baked
    anew; a folder that cannot be written is no error, but then nothing is kept.
    """
    file = _folder() / f"{_key(house)}.npz"
    with _alone(file):
        if lit := _read(file, house):
            if on_progress is not None:
                on_progress(1.0)
            return lit
        lit = bake_light(house, on_progress)
        if lit.parts:
            _write(file, lit, lit.assumptions[len(house.assumptions) :])
        return lit


def _folder() -> Path:
    if chosen := os.environ.get("SLAMGYM_CACHE"):
        return Path(chosen) / "light"
    caches = Path(os.environ.get("XDG_CACHE_HOME", ""))
    try:
        return (caches if caches.is_absolute() else Path.home() / ".cache") / "slamgym" / "light"
    except RuntimeError:  # a user without a home
        return Path(os.devnull)


def _key(house: House) -> str:
    """SHA-256 of all that the light depends on, in hex."""
    digest = hashlib.sha256(repr((VERSION, house.lamps, house.windows)).encode())
    textures = {id(part.material.texture): part.material.texture for part in house.parts}
    hashes = {key: _of_array(texture) for key, texture in textures.items()}
    for part in house.parts:
        digest.update(repr(tuple(map(float, part.material.colour))).encode() + hashes[id(part.material.texture)])
        for array in (part.vertices, part.faces, part.uv, part.colour, part.light):
            digest.update(_of_array(array))
    return digest.hexdigest()


def _of_array(array: Array | None) -> bytes:
    if array is None:
        return b"none"
    digest = hashlib.sha256(repr((array.dtype.str, array.shape)).encode())
    digest.update(np.ascontiguousarray(array).data)
    return digest.digest()


@contextmanager
def _alone(file: Path) -> Iterator[None]:
    """No other process is in here with the same file, unless that one takes too long or the folder is read-only.

    The lock is the system's: it goes with the process that holds it.
    """
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        lock = (file.parent / f"{file.name[:2]}.lock").open("a")
    except OSError:
        yield
        return
    with lock:
        end = time.monotonic() + WAIT_S
        while not _locked(lock.fileno()) and time.monotonic() < end:
            time.sleep(0.05)
        yield


def _locked(descriptor: int) -> bool:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks
        return True
    return True


def _read(file: Path, house: House) -> House | None:
    """The house with the light of the file, or None when there is none that can be read."""
    parts = [part for part in house.parts if len(part.faces)]
    try:
        with np.load(file, allow_pickle=False) as stored:
            pieces = [_split(stored[name], stored[f"{name}_ends"]) for name in STORED]
            assumptions = tuple(stored["assumptions"].tolist())
        lit = tuple(_stored(part, *arrays) for part, *arrays in zip(parts, *pieces, strict=True))
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None
    with suppress(OSError):
        os.utime(file)  # what is used is not removed as the oldest
    return replace(house, parts=lit, assumptions=(*house.assumptions, *assumptions))


def _split(rows: Array, ends: Array) -> list[Array]:
    if len(rows) != ends[-1]:
        raise ValueError(f"expected {ends[-1]} rows, got {len(rows)}")
    return np.split(rows, ends[:-1])


def _stored(part: Part, vertices: Array, faces: Array, uv: Array, colour: Array, light: Array) -> Part:
    return replace(
        part,
        vertices=vertices.astype(np.float32, copy=False),
        faces=faces.astype(np.int32, copy=False),
        uv=uv.astype(np.float32, copy=False) if len(uv) else None,
        colour=colour.astype(np.float32, copy=False) if len(colour) else None,
        light=light.astype(np.float32, copy=False),
    )


def _write(file: Path, lit: House, new_assumptions: Sequence[str]) -> None:
    """Keep the light, and remove the oldest files where there is too much."""
    arrays: dict[str, Any] = {"assumptions": np.array(new_assumptions, dtype=np.str_)}
    for name, columns in STORED.items():
        rows = [getattr(part, name) for part in lit.parts]
        rows = [np.zeros((0, columns), np.float32) if array is None else array for array in rows]
        arrays[name] = np.concatenate(rows)
        arrays[f"{name}_ends"] = np.cumsum([len(array) for array in rows])
    with suppress(OSError, OutputError):
        with draft(file) as place:
            np.savez(place, **arrays)
        _prune(file.parent)


def _prune(folder: Path) -> None:
    states = sorted(((path.stat(), path) for path in folder.glob("*.npz")), key=lambda state: -state[0].st_mtime_ns)
    kept = 0
    for state, path in states:
        kept += state.st_size
        if kept > MOST_BYTES:
            path.unlink(missing_ok=True)
