"""A DataRoot as trimesh's loaders want it."""

from pathlib import PurePosixPath
from urllib.parse import unquote

from trimesh.resolvers import Resolver

from slamgym.errors import SceneError
from slamgym.scenes.importing.data_root import DataRoot
from slamgym.scenes.importing.names import LONGEST
from slamgym.scenes.importing.obj_text import without_options
from slamgym.scenes.importing.textures import check_image

IMAGES = (".bmp", ".gif", ".jpeg", ".jpg", ".png", ".tga", ".tif", ".tiff", ".webp")


class RootResolver(Resolver):
    """Reads the files that one file of the folder `base` names, from a DataRoot.

    failures: why files could not be read, one line each; trimesh goes on without them.
    """

    def __init__(self, root: DataRoot, base: str = "") -> None:
        self.root, self.base = root, base
        self.failures: list[str] = []

    def get(self, key: str) -> bytes:
        """The content; raises SceneError. A name may have %20 for a space (glTF) and options before it (.mtl).

        Images are looked at, as trimesh passes over broken ones in silence.
        """
        try:
            data = self._read(without_options(key))
            if key.lower().endswith(IMAGES):
                check_image(data)
        except SceneError as error:
            self.failures.append(f"{key[:LONGEST]!r} left out: {error}")
            raise
        return data

    def _read(self, name: str) -> bytes:
        plain = unquote(name)
        if plain != name and self.root.path_of(plain, self.base).is_file():
            return self.root.read(plain, self.base)
        return self.root.read(name, self.base)

    def keys(self) -> list[str]:
        """None: loaders ask for what their file names, and need no list."""
        return []

    def write(self, name: str, data: bytes) -> None:  # noqa: ARG002 - the interface of trimesh
        """Never: scenes are only read."""
        raise SceneError(f"expected to read from {self.root.folder}, got {name!r} to write; nothing is written there")

    def namespaced(self, namespace: str) -> "RootResolver":
        """The same root, for files named in a subfolder."""
        return RootResolver(self.root, str(PurePosixPath(self.base) / namespace))
