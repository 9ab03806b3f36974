"""One mesh file as pieces. Whatever is wrong with it ends as a SceneError or as a line among the defects."""

from collections.abc import Mapping
from io import BytesIO
from typing import Any

import trimesh
from trimesh.visual.material import PBRMaterial

from slamgym.errors import SceneError
from slamgym.scenes.importing import gltf_plain, obj_text
from slamgym.scenes.importing.data_root import DataRoot
from slamgym.scenes.importing.gltf_check import check_gltf, gltf_header, textured_materials
from slamgym.scenes.importing.pieces import Pieces, pieces_of
from slamgym.scenes.importing.resolver import RootResolver
from slamgym.scenes.importing.texture_transform import with_transforms

GLTF = ("glb", "gltf")


def read_pieces(data: bytes, kind: str, root: DataRoot, base: str = "") -> Pieces:
    """The triangles of a file's content, node by node, in the file's own frame and unit.

    kind: "glb", "gltf", "obj", "ply" or "stl". root, base: where the files that it names are, see DataRoot. Raises
    SceneError, which does not name the file, and MemoryError.
    """
    if not data:
        raise SceneError(f"expected a .{kind} file, got an empty file; export it again")
    try:
        header = gltf_header(data) if kind in GLTF else {}
        check_gltf(header)
        data, header, changed = gltf_plain.prepared(data, header)
        data, libraries = obj_text.prepared(data) if kind == "obj" else (data, [])
        resolver = RootResolver(root, base, libraries, [buffer.get("uri") for buffer in header.get("buffers", ())])
        # trimesh must not merge or drop vertices: their uv and colours would go with them.
        scene = trimesh.load_scene(BytesIO(data), file_type=kind, resolver=resolver, process=False)
        found = pieces_of(scene, linear=kind in GLTF)
        pieces, noted = with_transforms(found.pieces, header)
    except (SceneError, MemoryError):
        raise
    except Exception as error:  # trimesh fails in many ways with a broken file
        why = " ".join(f"{type(error).__name__}: {error}".split())[:200]
        raise SceneError(f"expected a .{kind} file, got one that cannot be read ({why}); export it again") from None
    lost = [f"material {name!r} without its texture, which cannot be read" for name in _lost_textures(scene, header)]
    assumptions = [*noted, *resolver.assumptions, *found.assumptions]
    return Pieces(pieces, assumptions, [*resolver.failures, *lost, *changed, *found.defects], _extras(header))


def _extras(header: Mapping[str, Any]) -> object:
    """The `extras` of the scene that is shown; None where there are none."""
    scenes, shown = header.get("scenes"), header.get("scene", 0)
    scene = scenes[shown] if isinstance(scenes, list) and isinstance(shown, int) and 0 <= shown < len(scenes) else None
    return scene.get("extras") if isinstance(scene, dict) else None


def _lost_textures(scene: trimesh.Scene, header: Mapping[str, Any]) -> list[str]:
    """Names of materials that name a texture in the file and came without."""
    materials = [getattr(mesh.visual, "material", None) for mesh in scene.geometry.values() if hasattr(mesh, "visual")]
    bare = {m.name for m in materials if isinstance(m, PBRMaterial) and m.baseColorTexture is None}
    return sorted(map(str, bare & textured_materials(header))) if header else []
