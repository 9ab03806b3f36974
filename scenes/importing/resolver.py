"""A DataRoot as trimesh's loaders want it."""

import os
from collections.abc import Collection, Iterator
from pathlib import PurePosixPath, PureWindowsPath
from urllib.parse import unquote

from trimesh.resolvers import Resolver

from slamgym.errors import SceneError
from slamgym.scenes.importing.data_root import DataRoot
from slamgym.scenes.importing.names import LONGEST
from slamgym.scenes.importing.obj_text import LIBRARIES, as_utf8, without_options
from slamgym.scenes.importing.textures import check_image


class RootResolver(Resolver):
    """Reads the files that one file of the folder `base` names, from a DataRoot.

    libraries: the .mtl files that LIBRARIES stands for. buffers: names of files that are neither those nor images.
    failures, assumptions: why files could not be read, and where others were found instead, one line each; trimesh
    goes on without them.
    """

    def __init__(
        self, root: DataRoot, base: str = "", libraries: Collection[str] = (), buffers: Collection[object] = ()
    ) -> None:
        self.root, self.base = root, base
        self.libraries, self.buffers = libraries, buffers
        self.failures: list[str] = []
        self.assumptions: list[str] = []

    def get(self, key: str) -> bytes:
        """The content; raises SceneError. A name may have %20 for a space (glTF) and options before it (.mtl).

        Images are looked at, as trimesh passes over broken ones in silence. Of LIBRARIES, what can be read.
        """
        if key == LIBRARIES:
            return b"\n".join(self._library(name) for name in self.libraries)
        try:
            data = self._read(without_options(key))
            if key not in self.buffers:
                check_image(data)
        except SceneError as error:
            self._failed(key, error)
            raise
        return data

    def _library(self, name: str) -> bytes:
        try:
            return as_utf8(self._read(name), ".mtl")
        except SceneError as error:
            self._failed(name, error)
            return b""

    def _failed(self, name: str, error: SceneError) -> None:
        self.failures.append(f"{name[:LONGEST]!r} left out: {error}")

    def _read(self, name: str) -> bytes:
        for other in self._otherwise(name):
            if self.root.path_of(other, self.base).is_file():
                return self.root.read(other, self.base)
        beside = PureWindowsPath(name)
        if beside.drive and self.root.path_of(beside.name, self.base).is_file():
            self.assumptions.append(f"{name[:LONGEST]!r} of another machine: {beside.name[:LONGEST]!r} is used for it")
            return self.root.read(beside.name, self.base)
        return self.root.read(name, self.base)

    def _otherwise(self, name: str) -> Iterator[str]:
        """What the file may be called when its name is written in another way."""
        plain = unquote(name)
        if plain != name:
            yield plain
        if not name.isascii():  # an old archive's names, as they were unpacked
            yield os.fsdecode(name.encode("cp1252", "ignore"))

    def keys(self) -> list[str]:
        """None: loaders ask for what their file names, and need no list."""
        return []

    def write(self, name: str, data: bytes) -> None:  # noqa: ARG002 - the interface of trimesh
        """Never: scenes are only read."""
        raise SceneError(f"expected to read from {self.root.folder}, got {name!r} to write; nothing is written there")

    def namespaced(self, namespace: str) -> "RootResolver":
        """The same root, for files named in a subfolder."""
        return RootResolver(self.root, str(PurePosixPath(self.base) / namespace))
