"""Materials of trimesh as ours: a colour, a texture, and whether they shine or are clear.

Only what a flat picture needs is read: base colour and its texture (glTF), Kd, map_Kd, d and Tr (.mtl).
"""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL.Image import Image
from trimesh.visual.material import PBRMaterial, SimpleMaterial

from slamgym.errors import SceneError
from slamgym.scenes.house import Material
from slamgym.scenes.importing.textures import texture_of
from slamgym.types import FloatArray

PLAIN_COLOUR = (0.8, 0.8, 0.8)
CLEAR_ALPHA = 0.5
SHINING = 0.5
"""Emissive factor from which on a surface is its own light: a bulb or a screen, not a glow."""
DECODERS = 2


class Surface(NamedTuple):
    """clear: nearly transparent, as a window pane. shines: it needs no light."""

    material: Material
    clear: bool = False
    shines: bool = False


PLAIN = Surface(Material("plain", PLAIN_COLOUR))
"""What has no material."""


class _Look(NamedTuple):
    """What a material says. colour: sRGB factors, None where it says nothing. blended: its alpha counts."""

    name: str
    colour: FloatArray | None
    alpha: float
    image: Image | None
    blended: bool
    emissive: float


def read_surfaces(materials: Mapping[str, object]) -> tuple[dict[str, Surface], list[str]]:
    """The surface of each geometry that has one of trimesh's materials, or None; and a line for each bad texture.

    Geometries with one image have one texture array: what merges them by it may look at its identity.
    """
    looks = {id(material): _look(material) for material in materials.values()}
    images = {id(look.image): look for look in looks.values() if look and look.image is not None}
    with ThreadPoolExecutor(DECODERS) as pool:
        textures = dict(zip(images, pool.map(_texture, images.values()), strict=True))
    defects = [
        f"texture of material {images[key].name!r} left out: {error}"
        for key, error in textures.items()
        if isinstance(error, SceneError)
    ]
    found = {key: PLAIN if look is None else _surface(look, textures) for key, look in looks.items()}
    return {name: found[id(material)] for name, material in materials.items()}, defects


def srgb_of_linear(linear: FloatArray) -> FloatArray:
    """SRGB values in [0, 1] of linear ones (IEC 61966-2-1)."""
    curve = 1.055 * np.maximum(linear, 0.0031308) ** (1.0 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, 12.92 * linear, curve)


def _texture(look: _Look) -> NDArray[np.uint8] | SceneError:
    assert look.image is not None
    try:
        return texture_of(look.image, opaque=not look.blended)
    except SceneError as error:
        return error


def _surface(look: _Look, textures: Mapping[int, NDArray[np.uint8] | SceneError]) -> Surface:
    read = textures.get(id(look.image))
    texture = read if isinstance(read, np.ndarray) else None
    colour = np.ones(3) if texture is not None else np.array(PLAIN_COLOUR)
    if look.colour is not None and not (texture is not None and look.colour.max() == 0.0):
        # Exporters write a black Kd beside a texture and mean the texture.
        colour = np.clip(look.colour, 0.0, 1.0)
    material = Material(look.name, (float(colour[0]), float(colour[1]), float(colour[2])), texture)
    return Surface(material, clear=_is_clear(look, texture), shines=look.emissive >= SHINING)


def _is_clear(look: _Look, texture: NDArray[np.uint8] | None) -> bool:
    if not look.blended:
        return False
    if texture is None or look.image is None or "A" not in look.image.getbands():
        return look.alpha < CLEAR_ALPHA
    strongest = np.asarray(look.image.getchannel("A")).max() / 255.0
    return bool(strongest * look.alpha < CLEAR_ALPHA)


def _look(material: object) -> _Look | None:
    if isinstance(material, PBRMaterial):
        return _look_of_gltf(material)
    return _look_of_mtl(material) if isinstance(material, SimpleMaterial) else None


def _look_of_gltf(material: PBRMaterial) -> _Look:
    given = material.baseColorFactor
    factor = np.ones(4) if given is None else np.asarray(given, dtype=np.float64) / 255.0
    # Factors are linear and textures sRGB; as the curve between them is nearly a power, the product of a texture and
    # the factor's sRGB value is nearly the sRGB value of their linear product.
    colour = srgb_of_linear(factor[:3])
    emissive = 0.0 if material.emissiveFactor is None else float(material.emissiveFactor.max())
    if emissive >= SHINING and material.baseColorTexture is None:
        colour = srgb_of_linear(np.clip(factor[:3] + material.emissiveFactor, 0.0, 1.0))
    shining = emissive if material.emissiveTexture is None else 0.0
    blended = material.alphaMode in ("BLEND", "MASK")
    return _Look(str(material.name), colour, float(factor[3]), material.baseColorTexture, blended, shining)


def _look_of_mtl(material: SimpleMaterial) -> _Look | None:
    """None for the material that trimesh gives to what has texture coordinates only; its image is of no file."""
    words = material.kwargs
    if material.image is not None and material.image.format is None:
        return None
    colour = np.asarray(material.diffuse, dtype=np.float64).ravel()[:3] / 255.0 if "kd" in words else None
    alpha = _number(words.get("d"), 1.0) if "d" in words else 1.0 - _number(words.get("tr"), 0.0)
    return _Look(str(material.name), colour, alpha, material.image, True, 0.0)


def _number(words: object, otherwise: float) -> float:
    try:
        value = float(words[-1]) if isinstance(words, list) else otherwise
    except ValueError:
        return otherwise
    return value if np.isfinite(value) else otherwise
