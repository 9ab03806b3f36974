"""Wavefront .obj with its .mtl: text from the parts of one model."""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from slamgym.scenes.export.shared import file_name, y_up
from slamgym.scenes.house import Part

Texture = NDArray[np.uint8]


class ObjText(NamedTuple):
    """The two files' content."""

    obj: str
    mtl: str


def obj_text(name: str, parts: Sequence[Part], origin: ArrayLike, texture_file: Callable[[Texture], str]) -> ObjText:
    """The parts as `name`.obj and `name`.mtl, y up, metres from `origin`, which is y up too.

    texture_file: gives the name that the .mtl has for a texture. Colours of vertices become their mean.
    """
    materials: dict[str, str] = {}
    groups = [f"mtllib {name}.mtl"]
    vertices = uvs = 1  # .obj counts from 1, through all parts
    for part in parts:
        look = "\n".join(_look(part, texture_file))
        material = materials.setdefault(look, f"{file_name(part.material.name)}_{len(materials)}")
        groups += _group(part, material, np.asarray(origin), vertices, uvs)
        vertices += len(part.vertices)
        uvs += 0 if part.uv is None else len(part.uv)
    mtl = (f"newmtl {material}\n{look}\n" for look, material in materials.items())
    return ObjText("\n".join(groups) + "\n", "\n".join(mtl))


def _look(part: Part, texture_file: Callable[[Texture], str]) -> Iterator[str]:
    """The lines of a part's material but for its name."""
    mean = 1.0 if part.colour is None else part.colour.mean(axis=0)
    yield "Kd {:.6f} {:.6f} {:.6f}".format(*(np.asarray(part.material.colour) * mean))
    if part.material.texture is not None:
        yield f"map_Kd {texture_file(part.material.texture)}"


def _group(part: Part, material: str, origin: NDArray[np.float64], vertices: int, uvs: int) -> Iterator[str]:
    """The lines of a part. vertices, uvs: numbers of its first."""
    yield f"o {part.name}"
    yield from ("v {:.6f} {:.6f} {:.6f}".format(*row) for row in (y_up(part.vertices) - origin).tolist())
    if part.uv is not None:
        yield from ("vt {:.6f} {:.6f}".format(*row) for row in part.uv.tolist())
    yield f"usemtl {material}"
    for a, b, c in part.faces.tolist():
        if part.uv is None:
            yield f"f {a + vertices} {b + vertices} {c + vertices}"
        else:
            yield f"f {a + vertices}/{a + uvs} {b + vertices}/{b + uvs} {c + vertices}/{c + uvs}"
