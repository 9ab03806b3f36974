"""The files that a model names, its materials and textures, from the archive that it lies in."""

from posixpath import dirname, join, normpath
from zipfile import ZipFile

from trimesh.resolvers import Resolver

from slamgym.errors import SceneError
from slamgym.scenes.furniture_catalogue.archive import read_entry
from slamgym.scenes.importing.obj_text import as_utf8
from slamgym.scenes.importing.textures import decode_texture

MATERIALS = ".mtl"


class ArchiveResolver(Resolver):
    """An archive as trimesh's loaders want it, for the file at `path` in it.

    missing: why files could not be read, one line each; trimesh goes on without them.
    """

    def __init__(self, archive: ZipFile, path: str) -> None:
        self.archive, self.folder = archive, dirname(path)
        self.missing: list[str] = []

    def get(self, key: str) -> bytes:
        """The content of a list of materials, or of an image that can be decoded; raises SceneError.

        A name that leaves the archive is that of no entry.
        """
        try:
            data = read_entry(self.archive, normpath(join(self.folder, key.strip().replace("\\", "/"))))
            if key.lower().endswith(MATERIALS):
                return as_utf8(data, MATERIALS)
            decode_texture(data)
        except SceneError as error:
            self.missing.append(str(error))
            raise
        return data

    def keys(self) -> list[str]:
        """None: loaders ask for what their file names, and need no list."""
        return []

    def write(self, name: str, data: bytes) -> None:  # noqa: ARG002 - the interface of trimesh
        """Never: catalogues are only read."""
        raise SceneError(
            f"expected to read from {self.archive.filename}, got {name!r} to write; nothing is written there"
        )

    def namespaced(self, namespace: str) -> "ArchiveResolver":
        """The same archive, for files named in a subfolder."""
        return ArchiveResolver(self.archive, join(self.folder, namespace, ""))
