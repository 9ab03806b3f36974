"""Baked light kept in the user's cache folder: $SLAMGYM_CACHE, else slamgym in $XDG_CACHE_HOME or in ~/.cache."""

import fcntl
import hashlib
import os
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from slamgym.errors import OutputError
from slamgym.files import draft
from slamgym.scenes.fingerprint import house_sha256
from slamgym.scenes.house import House, Part
from slamgym.scenes.importing.data_root import read_plain
from slamgym.scenes.light.bake import bake_light

VERSION = 3
"""Goes up when `bake_light` gives other light for the same house."""
MOST_BYTES = 2_000_000_000
WAIT_S = 120.0
"""So long a process waits for another one that bakes the same house; then it bakes too."""

STORED = {
    "vertices": (3, np.float32), "faces": (3, np.int32), "uv": (2, np.float32), "colour": (3, np.float32),
    "light": (3, np.float32),
}  # fmt: skip
"""Arrays of a part that are kept, their columns and what these hold; none are kept as no rows."""

Array = NDArray[Any]


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
    """SHA-256 of the house and of what gives the light, in hex."""
    return hashlib.sha256(f"{VERSION} {house_sha256(house)}".encode()).hexdigest()


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
        with np.load(BytesIO(read_plain(file)), allow_pickle=False) as stored:
            pieces = [_split(name, stored[name], stored[f"{name}_ends"]) for name in STORED]
            assumptions = _texts(stored["assumptions"])
        lit = tuple(_stored(part, *arrays) for part, *arrays in zip(parts, *pieces, strict=True))
    except Exception:  # a damaged file may fail in any way, for want of memory too
        return None
    with suppress(OSError):
        os.utime(file)  # what is used is not removed as the oldest
    return replace(house, parts=lit, assumptions=(*house.assumptions, *assumptions))


def _split(name: str, rows: Array, ends: Array) -> list[Array]:
    """The array of each part; raises ValueError for one that was not written so."""
    columns, dtype = STORED[name]
    if rows.dtype != dtype or rows.ndim != 2 or rows.shape[1] != columns or not np.isfinite(rows).all():
        raise ValueError(f"expected finite {name} (N, {columns}) of {dtype}, got {rows.shape} of {rows.dtype}")
    if ends.dtype.kind != "i" or ends.ndim != 1 or (np.diff(ends, prepend=0) < 0).any() or ends[-1] != len(rows):
        raise ValueError(f"expected ends of parts that rise to {len(rows)}, got {ends}")
    return np.split(rows, ends[:-1])


def _texts(array: Array) -> tuple[str, ...]:
    if array.dtype.kind != "U" or array.ndim != 1:
        raise ValueError(f"expected a list of texts, got {array.shape} of {array.dtype}")
    return tuple(array.tolist())


def _stored(part: Part, vertices: Array, faces: Array, uv: Array, colour: Array, light: Array) -> Part:
    n = len(vertices)
    if len(light) != n or not {len(uv), len(colour)} <= {0, n} or faces.min() < 0 or faces.max() >= n:
        raise ValueError(f"expected light of {n} vertices, and faces of them, got others")
    uv_or_none, colour_or_none = (array if len(array) else None for array in (uv, colour))
    return replace(part, vertices=vertices, faces=faces, uv=uv_or_none, colour=colour_or_none, light=light)


def _write(file: Path, lit: House, new_assumptions: Sequence[str]) -> None:
    """Keep the light, and remove the oldest files where there is too much."""
    arrays: dict[str, Any] = {"assumptions": np.array(new_assumptions, dtype=np.str_)}
    for name, (columns, dtype) in STORED.items():
        rows = [getattr(part, name) for part in lit.parts]
        rows = [np.zeros((0, columns), dtype) if array is None else array for array in rows]
        arrays[name] = np.concatenate(rows).astype(dtype, copy=False)
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
