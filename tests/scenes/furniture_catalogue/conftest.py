"""Small catalogues of furniture, written as the editor of Sweet Home 3D would."""

import io
import zipfile

import numpy as np
import pytest
from PIL import Image

OBJ = """mtllib thing.mtl
v 0 0 0
v 2 0 0
v 2 5 0
v 0 5 0
v 0 0 4
v 2 0 4
v 2 5 4
v 0 5 4
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl cloth
f 2/1 1/2 4/3 3/4
f 1/1 5/2 8/3 4/4
f 6/1 2/2 3/3 7/4
f 4/1 8/2 7/3 3/4
f 5/1 1/2 2/3 6/4
usemtl front
f 5/1 6/2 7/3 8/4
"""
"""A box 2 wide, 5 high, 4 deep in the format's frame: y up, its front, +z, in a material of its own."""
MTL = """newmtl cloth
Kd 0.5 0.25 0.2
map_Kd cloth.png
newmtl front
Kd 0.2 0.4 0.6
"""
TWO_BY_TWO = np.array([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [255, 255, 255]]], dtype=np.uint8)
"""Rows from the top: red, green; blue, white."""


def png(pixels):
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "PNG")
    return file.getvalue()


@pytest.fixture
def files():
    """A function that gives the files of a model in `folder`; obj, mtl: text that replaces theirs."""

    def of(folder="sofa", obj=OBJ, mtl=MTL):
        names = {"thing.obj": obj.encode(), "thing.mtl": mtl.encode(), "cloth.png": png(TWO_BY_TWO)}
        return {f"{folder}/{name}": data for name, data in names.items()}

    return of


@pytest.fixture
def entry():
    """A function that gives a model's lines: a sofa of 2.0 x 0.9 x 0.8 m; keys that are None are left out."""

    def lines(number=1, **changed):
        values = {
            "id": f"Test#model{number}",
            "name": "Sofa",
            "category": "Living room",
            "model": "/sofa/thing.obj",
            "width": "200",
            "depth": "90.0",
            "height": "80",
            "creator": "Ada",
            **changed,
        }
        return "".join(f"{key}#{number}={value}\n" for key, value in values.items() if value is not None)

    return lines


@pytest.fixture
def write_catalogue(tmp_path, files, entry):
    """A function that writes tmp_path/NAME with models; content: the files beside the list, by default the sofa's."""

    def write(name, *entries, licence="Public domain", content=None):
        text = f"# models\nid=Test\nlicense={licence}\n" + "".join(entries or [entry()])
        with zipfile.ZipFile(tmp_path / name, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("PluginFurnitureCatalog.properties", text.encode("latin-1"))
            for path, data in (files() if content is None else content).items():
                archive.writestr(path, data)
        return tmp_path / name

    return write
