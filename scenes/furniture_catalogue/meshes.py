"""Meshes of a catalogue's models, ready to be stretched to a size."""

from functools import lru_cache
from io import BytesIO
from typing import NamedTuple

import numpy as np
import trimesh
from trimesh import Scene, Trimesh
from trimesh.visual import TextureVisuals

from slamgym.errors import SceneError
from slamgym.scenes.furniture_catalogue.archive import open_archive, read_entry
from slamgym.scenes.furniture_catalogue.catalogue import Model
from slamgym.scenes.furniture_catalogue.resolver import MATERIALS, ArchiveResolver
from slamgym.scenes.home.colours import DARKEST
from slamgym.scenes.home.furniture.piece import Component
from slamgym.scenes.home.palette import Finish
from slamgym.scenes.home.solids import Mesh
from slamgym.scenes.house import Material
from slamgym.scenes.importing.obj_text import as_utf8
from slamgym.scenes.importing.pieces import Piece, pieces_of
from slamgym.types import FloatArray

MAX_MESH_BYTES = 4_000_000
MAX_TRIANGLES = 40_000
_CACHED = 256
_CLEAR_SHARE = 0.3
_CUT_SHARE = 0.02
_HALF_CLEAR = 128
_LIGHTEST = 0.93
"""Of plain colours: models have pure white, homes do not."""
_Z_UP = np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
"""From a model's frame (y up, front to +z) to a piece's (z up, front to +y)."""


class Shape(NamedTuple):
    """components: one for each material, in the box x -0.5 to 0.5, y 0 to 1 (front), z 0 to 1 (up).

    missing: textures that are not in the archive, or broken; plain colours are there instead.
    """

    components: tuple[Component, ...]
    missing: int


@lru_cache(maxsize=_CACHED)
def shape_of(model: Model) -> Shape:
    """What a model looks like.

    Raises SceneError where it is broken or too large, or would not look as it should: much of it is glass, or cut out
    by the clear parts of a texture.
    """
    try:
        scene, missing = _read(model)
        meshes = [mesh for mesh in scene.geometry.values() if isinstance(mesh, Trimesh)]
        cut_out = any(_is_cut_out(mesh) for mesh in meshes)  # pieces_of closes the images
        found = pieces_of(scene, linear=False)
        _check(meshes, found.pieces, found.defects, cut_out)
        A, low, extent = _box(model, np.concatenate([mesh.vertices for mesh in meshes]))
        components = tuple(
            _component(f"{number}", piece, (piece.vertices @ A.T - low) / extent)
            for number, piece in enumerate(found.pieces, start=1)
        )
        return Shape(components, missing)
    except MemoryError:
        raise
    except Exception as error:  # a broken file may fail in any way
        why = str(error) if isinstance(error, SceneError) else f"expected a mesh, got {type(error).__name__}: {error}"
        raise SceneError(f"{model.archive.name}: {model.id} left out: {' '.join(why.split())[:300]}") from None


def _read(model: Model) -> tuple[Scene, int]:
    with open_archive(model.archive) as archive:
        resolver = ArchiveResolver(archive, model.path)
        data = BytesIO(as_utf8(read_entry(archive, model.path, MAX_MESH_BYTES)))
        scene = trimesh.load_scene(data, file_type="obj", resolver=resolver, process=False, group_material=True)
    if without := [why for why in resolver.missing if MATERIALS in why]:
        raise SceneError(without[0])
    return scene, len(resolver.missing)


def _check(meshes: list[Trimesh], pieces: list[Piece], defects: list[str], cut_out: bool) -> None:
    if defects:
        raise SceneError(defects[0])
    triangles = sum(len(mesh.faces) for mesh in meshes)
    if not 0 < triangles <= MAX_TRIANGLES:
        raise SceneError(f"expected 1 to {MAX_TRIANGLES} triangles, got {triangles}; simplify it")
    if any(mesh.faces.min() < 0 or mesh.faces.max() >= len(mesh.vertices) for mesh in meshes if len(mesh.faces)):
        raise SceneError("expected faces of the file's vertices, got others; save it again")
    if not all(np.isfinite(mesh.vertices).all() for mesh in meshes):
        raise SceneError("expected vertices with numbers, got others; save it again")
    area = sum(mesh.area for mesh in meshes)
    if sum(_area(piece) for piece in pieces) < (1.0 - _CLEAR_SHARE) * area:
        raise SceneError("expected a model that hides what is behind it, got one of glass; choose another")
    if cut_out:
        raise SceneError("expected textures without holes, got one with clear parts; choose another")


def _area(piece: Piece) -> float:
    return float(Trimesh(piece.vertices, piece.faces, process=False).area)


def _is_cut_out(mesh: Trimesh) -> bool:
    """Whether a share of the texture is clear: leaves on cards, or a mesh of wire."""
    image = getattr(mesh.visual.material, "image", None) if isinstance(mesh.visual, TextureVisuals) else None
    if image is None or not image.has_transparency_data:
        return False
    return bool((np.asarray(image.convert("RGBA"))[..., 3] < _HALF_CLEAR).mean() > _CUT_SHARE)


def _box(model: Model, vertices: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """A, low and extent so that (A p - low) / extent lies in the unit box, x and y centred."""
    turn = np.eye(3) if model.rotation is None else np.array(model.rotation).reshape(3, 3)
    A = _Z_UP @ turn
    turned = vertices @ A.T
    low, high = turned.min(axis=0), turned.max(axis=0)
    extent = high - low
    if not (extent > 1e-6 * extent.max()).all():
        raise SceneError("expected a model with a volume, got a flat one; choose another")
    return A, low + np.array([extent[0] / 2.0, 0.0, 0.0]), extent


def _component(number: str, piece: Piece, vertices: FloatArray) -> Component:
    name, texture = piece.material.name, piece.material.texture
    # The pictures in the catalogues show textures as they are, whatever colour their materials have.
    colour = np.ones(3) if texture is not None else np.clip(piece.material.colour, DARKEST, _LIGHTEST)
    material = Material(name, (float(colour[0]), float(colour[1]), float(colour[2])), texture)
    uv = np.zeros((len(vertices), 2)) if piece.uv is None else piece.uv.astype(np.float64)
    return Component(number, Finish(material), Mesh(vertices, piece.faces, uv))
