import os
import subprocess
import sys
import time
import zipfile
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
import trimesh

from slamgym.scenes.house import House, Lamp, Material, Part, Window
from slamgym.scenes.light import cache as light_cache
from slamgym.scenes.light.cache import baked

CHECKED = np.arange(12, dtype=np.uint8).reshape(2, 2, 3)


def house(lamp: Lamp = Lamp((0.0, 0.0, 1.0))) -> House:  # noqa: B008  frozen
    mesh = trimesh.creation.box(extents=(4, 4, 2.5))
    vertices, faces = np.asarray(mesh.vertices, np.float32), np.asarray(mesh.faces[:, ::-1], np.int32)
    material = Material("tiles", (0.8, 0.8, 0.8), CHECKED)
    walls = Part("walls", material, vertices, faces, uv=vertices[:, :2].copy(), colour=np.ones_like(vertices))
    bulb = Part("bulb", Material("b"), vertices * np.float32(0.02), faces, light=np.ones_like(vertices))
    return House("room", (walls, bulb), lamps=(lamp,), windows=(Window((2.0, 0, 0), (0, 0.5, 0), (0, 0, -0.5)),))


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("SLAMGYM_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache" / "light"


@pytest.fixture
def bakes(monkeypatch):
    """Names of the houses that were really baked."""
    names: list[str] = []
    bake = light_cache.bake_light

    def counting(house, on_progress=None):
        names.append(house.name)
        return bake(house, on_progress)

    monkeypatch.setattr(light_cache, "bake_light", counting)
    return names


def assert_same(a: House, b: House) -> None:
    for one, other in zip(a.parts, b.parts, strict=True):
        for name in ("vertices", "faces", "uv", "colour", "light"):
            mine, its = getattr(one, name), getattr(other, name)
            assert (mine is None) == (its is None)
            if mine is not None:
                assert mine.dtype == its.dtype
                np.testing.assert_array_equal(mine, its)
        assert (one.name, one.solid, one.material.name) == (other.name, other.solid, other.material.name)
    assert a.assumptions == b.assumptions
    assert a.lamps == b.lamps


def test_the_second_time_it_comes_from_the_cache(bakes, folder) -> None:
    whole = house()
    shares: list[float] = []
    first, second = baked(whole), baked(replace(whole, name="copy"), shares.append)
    assert bakes == ["room"]
    assert shares == [1.0]
    assert second.name == "copy"
    assert len(first.parts[0].vertices) > len(whole.parts[0].vertices)
    assert_same(first, second)
    assert len(list(folder.glob("*.npz"))) == 1


def test_what_was_assumed_comes_from_the_cache_too(bakes) -> None:
    dark = replace(house(), lamps=(), windows=())
    first, second = baked(dark), baked(replace(dark, assumptions=("unit: metre",)))
    assert len(bakes) == 1
    assert len(first.assumptions) == 1
    assert second.assumptions == ("unit: metre", *first.assumptions)


def _with(**changes) -> House:
    return replace(house(), parts=(replace(house().parts[0], **changes), *house().parts[1:]))


OTHERS = {
    "vertex": lambda: _with(vertices=house().parts[0].vertices + np.float32(1e-6)),
    "faces": lambda: _with(faces=house().parts[0].faces[::-1].copy()),
    "uv": lambda: _with(uv=house().parts[0].vertices[:, 1:].copy()),
    "colour": lambda: _with(colour=None),
    "light": lambda: _with(light=np.ones_like(house().parts[0].vertices)),
    "material": lambda: _with(material=Material("tiles", (0.8, 0.8, 0.7), CHECKED)),
    "texture": lambda: _with(material=Material("tiles", (0.8, 0.8, 0.8), CHECKED[::-1])),
    "no texture": lambda: _with(material=Material("tiles", (0.8, 0.8, 0.8))),
    "lamp": lambda: house(Lamp((0.0, 0.0, 1.0), 1.5)),
    "window": lambda: replace(house(), windows=()),
    "parts": lambda: replace(house(), parts=house().parts[:1]),
}


@pytest.mark.parametrize("other", OTHERS.values(), ids=OTHERS.keys())
def test_another_house_is_baked_anew(bakes, other) -> None:
    baked(house())
    baked(other())
    assert len(bakes) == 2


def test_another_version_of_the_algorithm_bakes_anew(bakes, monkeypatch) -> None:
    baked(house())
    monkeypatch.setattr(light_cache, "VERSION", light_cache.VERSION + 1)
    baked(house())
    assert len(bakes) == 2


def _flip_a_byte(content: bytes) -> bytes:
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]


SPOILT = {
    "truncated": lambda content: content[: len(content) // 2],
    "empty": lambda content: content[:0],
    "nonsense": lambda content: b"nonsense" * len(content),
    "one bit": _flip_a_byte,
    "start missing": lambda content: content[100:],
    "huge": lambda content: _huge(content),
}


@pytest.mark.parametrize("spoil", SPOILT.values(), ids=SPOILT.keys())
def test_a_broken_file_is_baked_anew_and_mended(bakes, folder, spoil) -> None:
    first = baked(house())
    (file,) = folder.glob("*.npz")
    file.write_bytes(spoil(file.read_bytes()))
    assert_same(first, baked(house()))
    assert_same(first, baked(house()))
    assert len(bakes) == 2


def _stored(content: bytes) -> dict[str, np.ndarray]:
    with np.load(BytesIO(content)) as stored:
        return dict(stored)


def _of(arrays: dict[str, np.ndarray]) -> bytes:
    file = BytesIO()
    np.savez(file, **arrays)  # type: ignore[arg-type]
    return file.getvalue()


def _put(array: np.ndarray, value: float) -> np.ndarray:
    changed = array.copy()
    changed.flat[0] = value
    return changed


def _huge(content: bytes) -> bytes:
    """The first array says that it has a hundred million million rows."""
    changed = BytesIO()
    with zipfile.ZipFile(BytesIO(content)) as old, zipfile.ZipFile(changed, "w") as new:
        for name in old.namelist():
            data = old.read(name)
            if name == "vertices.npy":
                header = BytesIO()
                shape = {"descr": "<f4", "fortran_order": False, "shape": (10**14, 3)}
                np.lib.format.write_array_header_1_0(header, shape)
                data = header.getvalue()
            new.writestr(name, data)
    return changed.getvalue()


CHANGES = {
    "missing": lambda a: {name: array for name, array in a.items() if name != "light"},
    "fewer parts": lambda a: {**a, "light_ends": a["light_ends"][:1]},
    "ends of no list": lambda a: {**a, "vertices_ends": np.array(7)},
    "no ends": lambda a: {**a, "faces_ends": a["faces_ends"][:0]},
    "ends as text": lambda a: {**a, "uv_ends": a["uv_ends"].astype(str)},
    "ends that fall": lambda a: {**a, "faces_ends": np.array([2 * len(a["faces"]), len(a["faces"])])},
    "ends below 0": lambda a: {**a, "light_ends": _put(a["light_ends"], -1)},
    "assumptions of no list": lambda a: {**a, "assumptions": np.array("light")},
    "assumptions of numbers": lambda a: {**a, "assumptions": np.arange(2)},
    "faces beyond the vertices": lambda a: {**a, "faces": _put(a["faces"], len(a["vertices"]))},
    "faces before the vertices": lambda a: {**a, "faces": _put(a["faces"], -1)},
    "faces of fractions": lambda a: {**a, "faces": a["faces"].astype(np.float32)},
    "no light that is a number": lambda a: {**a, "light": _put(a["light"], np.nan)},
    "vertices far away": lambda a: {**a, "vertices": _put(a["vertices"], np.inf)},
    "light of 64 bits": lambda a: {**a, "light": a["light"].astype(np.float64)},
    "two colours": lambda a: {**a, "colour": a["colour"][:, :2]},
    "fewer uv": lambda a: {**a, "uv": a["uv"][1:], "uv_ends": a["uv_ends"] - 1},
    "light in one row": lambda a: {**a, "light": a["light"].ravel()},
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES.keys())
def test_a_file_with_missing_or_other_arrays_is_baked_anew(bakes, folder, change) -> None:
    first = baked(house())
    (file,) = folder.glob("*.npz")
    file.write_bytes(_of(_stored(file.read_bytes())))
    baked(house())
    assert len(bakes) == 1
    file.write_bytes(_of(change(_stored(file.read_bytes()))))
    assert_same(first, baked(house()))
    assert len(bakes) == 2


@pytest.mark.parametrize("kind", ["pipe", "folder"])
def test_what_is_no_plain_file_is_baked_anew(bakes, folder, kind) -> None:
    folder.mkdir(parents=True)
    place = folder / f"{light_cache._key(house())}.npz"
    os.mkfifo(place) if kind == "pipe" else place.mkdir()
    assert baked(house()).parts[0].light is not None
    assert len(bakes) == 1


def test_a_folder_that_cannot_be_made_is_no_error(bakes, tmp_path, monkeypatch) -> None:
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("SLAMGYM_CACHE", str(tmp_path / "file"))
    assert baked(house()).parts[0].light is not None
    assert len(bakes) == 1


def test_the_oldest_files_are_removed_when_there_is_too_much(monkeypatch, folder) -> None:
    baked(house())
    size = next(folder.glob("*.npz")).stat().st_size
    monkeypatch.setattr(light_cache, "MOST_BYTES", int(2.5 * size))
    for k in range(3):
        time.sleep(0.01)
        baked(house(Lamp((0.0, 0.0, 1.0), 2.0 + k)))
        baked(house())  # used each time, so never the oldest
    kept = {file.name for file in folder.glob("*.npz")}
    assert len(kept) == 2
    assert f"{light_cache._key(house())}.npz" in kept


@pytest.mark.parametrize(
    ("variables", "expected"),
    [
        ({"SLAMGYM_CACHE": "/a", "XDG_CACHE_HOME": "/b"}, "/a/light"),
        ({"SLAMGYM_CACHE": "", "XDG_CACHE_HOME": "/b"}, "/b/slamgym/light"),
        ({"XDG_CACHE_HOME": "relative"}, "/home/me/.cache/slamgym/light"),
        ({}, "/home/me/.cache/slamgym/light"),
    ],
)
def test_the_cache_folder(variables, expected, monkeypatch) -> None:
    for name in ("SLAMGYM_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    for name, value in {"HOME": "/home/me", **variables}.items():
        monkeypatch.setenv(name, value)
    assert light_cache._folder() == Path(expected)


BAKE = """
import sys
sys.path.insert(0, {here!r})
import test_cache as t
from slamgym.scenes.light import cache as light_cache
bake = light_cache.bake_light
def telling(house, on_progress):
    print("baked", flush=True)
    return bake(house, on_progress)
light_cache.bake_light = telling
print(len(light_cache.baked(t.house()).parts[0].light))
"""


def test_of_several_processes_one_bakes(folder) -> None:
    command = [sys.executable, "-c", BAKE.format(here=str(Path(__file__).parent))]
    processes = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    answers = [process.communicate(timeout=60)[0].split() for process in processes]
    assert sorted(len(answer) for answer in answers) == [1, 2]
    assert len({answer[-1] for answer in answers}) == 1
    assert [path.suffix for path in sorted(folder.iterdir(), key=lambda path: path.suffix)] == [".lock", ".npz"]
    assert all(process.returncode == 0 for process in processes)


def test_who_waits_too_long_bakes_too(bakes, monkeypatch, folder) -> None:
    monkeypatch.setattr(light_cache, "WAIT_S", 0.1)
    file = folder / f"{light_cache._key(house())}.npz"
    with light_cache._alone(file):
        assert baked(house()).parts[0].light is not None
    assert len(bakes) == 1
