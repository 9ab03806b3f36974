"""The files that an .obj file names: lists of materials, and textures."""

import os
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from slamgym.scenes.importing import materials
from slamgym.scenes.importing.placed_options import PlacedOptions
from slamgym.scenes.mesh import read_mesh

AS_IT_IS = PlacedOptions(up="z", unit=1.0, floor=0.0)
PRINT = np.arange(12, dtype=np.uint8).reshape(2, 2, 3) * 20


def png():
    content = BytesIO()
    Image.fromarray(PRINT).save(content, "PNG")
    return content.getvalue()


def obj(path, mtl, usemtl="usemtl print"):
    """A textured triangle, and the list of its materials beside it."""
    corners = ["v 0 0 0", "v 4 0 0", "v 4 4 0", "vt 0 0", "vt 1 0", "vt 1 1"]
    path.write_text("\n".join(["mtllib wall.mtl", *corners, usemtl, "f 1/1 2/2 3/3"]) + "\n")
    path.with_name("wall.mtl").write_text(mtl)
    return path


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
@pytest.mark.parametrize("on_disk", ["utf-8", "latin-1"])
def test_obj_files_in_any_encoding(tmp_path, encoding, on_disk):
    path = obj(tmp_path / "wall.obj", "", usemtl="usemtl h\u00f6lzern")
    path.write_bytes(path.read_text().encode(encoding))
    path.with_name("wall.mtl").write_bytes("newmtl h\u00f6lzern\nmap_Kd h\u00f6lzern.png\n".encode(encoding))
    (tmp_path / os.fsdecode("h\u00f6lzern.png".encode(on_disk))).write_bytes(png())
    house = read_mesh(path, AS_IT_IS)
    assert (house.parts[0].material.texture == PRINT).all()
    assert (house.parts[0].material.name, house.defects) == ("h\u00f6lzern", ())


def test_materials_of_several_files(tmp_path):
    path = obj(tmp_path / "wall.obj", "newmtl print\nKd 1 0 0\n")
    path.write_text(path.read_text() + "mtllib more.mtl\nusemtl more\nf 1 2 3\n")
    (tmp_path / "more.mtl").write_text("newmtl more\nKd 0 0 1\n")
    house = read_mesh(path, AS_IT_IS)
    assert {part.material.name: part.material.colour for part in house.parts} == {
        "print": (1.0, 0.0, 0.0),
        "more": (0.0, 0.0, 1.0),
    }


def test_a_texture_named_by_another_machine(tmp_path):
    path = obj(tmp_path / "wall.obj", "newmtl print\nmap_Kd C:\\Users\\me\\print.png\n")
    assert "'C:\\\\Users\\\\me\\\\print.png', which is not there; put it there" in read_mesh(path, AS_IT_IS).defects[0]
    (tmp_path / "print.png").write_bytes(png())
    house = read_mesh(path, AS_IT_IS)
    assert (house.parts[0].material.texture == PRINT).all()
    assert "of another machine: 'print.png' is used for it" in house.assumptions[3]
    assert house.defects == ()


def test_pixels_of_all_textures_are_bounded(tmp_path, monkeypatch):
    monkeypatch.setattr(materials, "MAX_ALL_PIXELS", 7)
    for name in ("a", "b"):
        (tmp_path / f"{name}.png").write_bytes(png())
    path = obj(tmp_path / "wall.obj", "newmtl print\nmap_Kd a.png\nnewmtl more\nmap_Kd b.png\n")
    path.write_text(path.read_text() + "usemtl more\nf 1/1 2/2 3/3\n")
    house = read_mesh(path, AS_IT_IS)
    assert sum(part.material.texture is not None for part in house.parts) == 1
    assert "left out: expected at most 7 pixels in all textures, got more; scale them down" in house.defects[0]
