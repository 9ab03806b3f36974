"""Meshes as trimesh reads them, node by node, as pieces: a house's parts before they are cleaned and placed."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, TypeGuard

import numpy as np
from numpy.typing import NDArray
from trimesh import Scene, Trimesh
from trimesh.parent import Geometry
from trimesh.transformations import transform_points
from trimesh.visual import ColorVisuals, TextureVisuals

from slamgym.errors import SceneError
from slamgym.scenes.house import Material, Part
from slamgym.scenes.importing.gltf_plain import SOLID
from slamgym.scenes.importing.materials import PLAIN, Surface, read_surfaces
from slamgym.scenes.importing.names import listed
from slamgym.scenes.srgb import srgb_of_linear
from slamgym.types import FloatArray, IntArray

MAX_TRIANGLES = 5_000_000


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """A Part whose vertices, float64 (V, 3), are still in the file's frame and unit; nothing in it is checked.

    faces: int64 (F, 3). uv: float32 (V, 2) or None. colour: float32 (V, 3) or None. shines: whether it needs no light.
    solid: as in Part.
    """

    name: str
    material: Material
    vertices: FloatArray
    faces: IntArray
    uv: NDArray[np.float32] | None = None
    colour: NDArray[np.float32] | None = None
    shines: bool = False
    solid: bool = True

    def part(self, T_world_file: FloatArray) -> Part:
        """The piece in the world; T_world_file (4, 4) may scale and mirror."""
        vertices = transform_points(self.vertices, T_world_file).astype(np.float32)
        return Part(
            name=self.name,
            material=self.material,
            vertices=vertices,
            faces=_wound(self.faces, T_world_file).astype(np.int32),
            uv=self.uv,
            light=np.ones_like(vertices) if self.shines else None,
            colour=self.colour,
            solid=self.solid,
        )


class Pieces(NamedTuple):
    """pieces; assumptions and defects: as in House, but without the file's name. extras: of a glTF file's scene."""

    pieces: list[Piece]
    assumptions: list[str]
    defects: list[str]
    extras: object = None


def pieces_of(scene: Scene, linear: bool) -> Pieces:
    """One piece for each node of `scene` that has triangles, in the scene's frame.

    linear: whether the file's vertex colours are linear, as in glTF, and not sRGB. Raises SceneError for too many
    triangles.
    """
    _check_size(scene)
    meshes = {name: mesh for name, mesh in scene.geometry.items() if _has_triangles(mesh)}
    surfaces, defects = read_surfaces({name: _material(mesh) for name, mesh in meshes.items()})
    clear = sorted(name for name, surface in surfaces.items() if surface.clear)
    defects += [f"{name!r} left out: expected triangles" for name in scene.geometry if name not in meshes]
    pieces = [
        _piece(name, meshes[geometry], surfaces[geometry], T, linear)
        for name, geometry, T in _nodes(scene)
        if geometry in meshes and geometry not in clear
    ]
    assumptions = [f"left out as clear: {listed(clear)}"] if clear else []
    return Pieces(pieces, assumptions, defects)


def _check_size(scene: Scene) -> None:
    triangles = sum(
        len(scene.geometry[name].faces) * len(where)
        for name, where in scene.graph.geometry_nodes.items()
        if isinstance(scene.geometry.get(name), Trimesh)
    )
    if triangles > MAX_TRIANGLES:
        raise SceneError(f"expected at most {MAX_TRIANGLES} triangles, got {triangles}; simplify the mesh")


def _nodes(scene: Scene) -> Iterator[tuple[str, str, FloatArray]]:
    """Name, geometry and T_scene_geometry of each node; the name is the node's, then, when it differs, the geometry's.

    What a glTF node of several geometries has as children, one for each, has random names and goes by the node's.
    """
    parents = scene.graph.transforms.parents
    for node in scene.graph.nodes_geometry:
        T, geometry = scene.graph[node]
        made_up = str(node) != geometry and str(node).startswith(f"{parents.get(node)}_")
        words = dict.fromkeys((str(parents[node] if made_up else node), str(geometry)))
        yield "/".join(word.replace("/", "_") for word in words), str(geometry), T


def _has_triangles(geometry: Geometry) -> TypeGuard[Trimesh]:
    """Whether it is a mesh: lines and points are not, and what is left of a truncated file may be anything."""
    return (
        isinstance(geometry, Trimesh)
        and np.shape(geometry.faces)[1:] == (3,)
        and np.shape(geometry.vertices)[1:] == (3,)
    )


def _material(mesh: Trimesh) -> object:
    return mesh.visual.material if isinstance(mesh.visual, TextureVisuals) else None


def _piece(name: str, mesh: Trimesh, surface: Surface, T: FloatArray, linear: bool) -> Piece:
    vertices, faces = transform_points(mesh.vertices, T), _wound(np.asarray(mesh.faces), T)
    uv, colour = _uv(mesh), _colour(mesh, linear)
    if colour is not None and len(colour) != len(vertices):  # of the faces
        vertices, colour = vertices[faces].reshape(-1, 3), np.repeat(colour, 3, axis=0)
        uv, faces = None, np.arange(len(vertices)).reshape(-1, 3)
    material = surface.material
    if uv is None and material.texture is not None:
        material = _without_texture(material)
    if colour is not None and surface is PLAIN:
        material = Material("vertex colours")
    uv = None if material.texture is None else uv
    solid = mesh.metadata.get(SOLID) is not False
    return Piece(name, material, vertices, faces, uv, colour, surface.shines, solid)


def _without_texture(material: Material) -> Material:
    """The material in its texture's mean colour: there is no telling where on the surface the texture lies."""
    assert material.texture is not None
    r, g, b = material.texture.reshape(-1, 3).mean(axis=0) / 255.0 * material.colour
    return Material(material.name, (float(r), float(g), float(b)))


def _wound(faces: IntArray, T: FloatArray) -> IntArray:
    """Faces (F, 3) that are counter-clockwise from outside after T, which may mirror."""
    return faces[:, ::-1] if np.linalg.det(T[:3, :3]) < 0.0 else faces


def _uv(mesh: Trimesh) -> NDArray[np.float32] | None:
    """Texture coordinates (V, 2), (0, 0) at the lower left: trimesh turns those of glTF over; None without usable."""
    uv = mesh.visual.uv if isinstance(mesh.visual, TextureVisuals) else None
    if uv is None or np.shape(uv) != (len(mesh.vertices), 2):
        return None
    return np.nan_to_num(np.asarray(uv, dtype=np.float32), nan=0.0, posinf=0.0, neginf=0.0)


def _colour(mesh: Trimesh, linear: bool) -> NDArray[np.float32] | None:
    """Colour factors, sRGB, of the vertices (V, 3) or of the faces (F, 3), whatever the file has; None without."""
    visual, colours = mesh.visual, None
    if isinstance(visual, ColorVisuals) and visual.kind in ("vertex", "face"):
        colours = visual.vertex_colors if visual.kind == "vertex" else visual.face_colors
    elif isinstance(visual, TextureVisuals):
        colours = visual.vertex_attributes.get("color")
    if colours is None or np.ndim(colours) != 2 or np.shape(colours)[1] < 3:
        return None
    if len(colours) not in (len(mesh.vertices), len(mesh.faces)):
        return None
    values = np.asarray(colours)[:, :3]
    scale = np.iinfo(values.dtype).max if values.dtype.kind in "iu" else 1
    factors = np.clip(np.nan_to_num(values.astype(np.float64) / scale), 0.0, 1.0)
    return (srgb_of_linear(factors) if linear else factors).astype(np.float32)
