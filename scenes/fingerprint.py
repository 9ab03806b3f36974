"""What makes two houses the same one: a hash of all that is seen of them and driven in."""

import hashlib

import numpy as np
from numpy.typing import NDArray

from slamgym.scenes.house import House


def house_sha256(house: House) -> str:
    """SHA-256, 64 hex digits, of parts, lamps and windows; names and remarks do not count."""
    digest = hashlib.sha256(repr((house.lamps, house.windows)).encode())
    textures = {id(part.material.texture): part.material.texture for part in house.parts}
    hashes = {key: array_sha256(texture) for key, texture in textures.items()}
    for part in house.parts:
        digest.update(repr((part.solid, tuple(map(float, part.material.colour)))).encode())
        digest.update(hashes[id(part.material.texture)])
        for array in (part.vertices, part.faces, part.uv, part.colour, part.light):
            digest.update(array_sha256(array))
    return digest.hexdigest()


def array_sha256(array: NDArray[np.generic] | None) -> bytes:
    """32 bytes: the hash of type, shape and values; of None another one than of any array."""
    if array is None:
        return hashlib.sha256(b"none").digest()
    digest = hashlib.sha256(repr((array.dtype.str, array.shape)).encode())
    digest.update(np.ascontiguousarray(array).data)
    return digest.digest()
