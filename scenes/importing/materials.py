"""Materials of trimesh as ours: a colour, a texture, and whether they shine or are clear.

Only what a flat picture needs is read: base colour and its texture (glTF), Kd, map_Kd, d and Tr (.mtl).
"""

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import accumulate
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL.Image import Image
from trimesh.visual.material import PBRMaterial, SimpleMaterial

from slamgym.errors import SceneError
from slamgym.scenes.house import Material
from slamgym.scenes.importing.textures import MAX_PIXELS, texture_of
from slamgym.scenes.srgb import srgb_of_linear
from slamgym.types import FloatArray

PLAIN_COLOUR = (0.8, 0.8, 0.8)
CLEAR_ALPHA = 0.5
DECODERS = 2
MAX_ALL_PIXELS = 400_000_000
"""Of all textures of a file together, before they are scaled down."""


class Surface(NamedTuple):
    """clear: nearly transparent, as a window pane. shines: it needs no light."""

    material: Material
    clear: bool = False
    shines: bool = False


PLAIN = Surface(Material("plain", PLAIN_COLOUR))
"""What has no material."""


class _Texture(NamedTuple):
    """pixels: as texture_of gives them. strongest: the largest alpha, in [0, 1]; None for an image without alpha."""

    pixels: NDArray[np.uint8]
    strongest: float | None


class _Look(NamedTuple):
    """What a material says. colour: sRGB factors, None where it says nothing. blended: its alpha counts."""

    name: str
    colour: FloatArray | None
    alpha: float
    image: Image | None
    blended: bool
    shines: bool


def read_surfaces(materials: Mapping[str, object]) -> tuple[dict[str, Surface], list[str]]:
    """The surface of each geometry that has one of trimesh's materials, or None; and a line for each bad texture.

    Geometries with one image have one texture array: what merges them by it may look at its identity. The images are
    closed, as large ones would stay in memory.
    """
    looks = {id(material): _look(material) for material in materials.values()}
    images = {id(look.image): look for look in looks.values() if look and look.image is not None}
    with ThreadPoolExecutor(DECODERS) as pool:
        decoded = pool.map(_texture, images.values(), _affordable([look.image for look in images.values()]))
        textures = dict(zip(images, decoded, strict=True))
    defects = [
        f"texture of material {images[key].name!r} left out: {error}"
        for key, error in textures.items()
        if isinstance(error, SceneError)
    ]
    found = {key: PLAIN if look is None else _surface(look, textures) for key, look in looks.items()}
    return {name: found[id(material)] for name, material in materials.items()}, defects


def _affordable(images: Sequence[Image | None]) -> list[bool]:
    """Which of a file's images can be decoded without more than MAX_ALL_PIXELS; too large ones are refused anyhow."""
    sizes = [image.width * image.height for image in images if image is not None]
    total = accumulate(size if size <= MAX_PIXELS else 0 for size in sizes)
    return [pixels <= MAX_ALL_PIXELS for pixels in total]


def _texture(look: _Look, affordable: bool) -> _Texture | SceneError:
    assert look.image is not None
    if not affordable:
        return SceneError(f"expected at most {MAX_ALL_PIXELS} pixels in all textures, got more; scale them down")
    try:
        pixels = texture_of(look.image, opaque=not look.blended)
        has_alpha = look.blended and "A" in look.image.getbands()
        return _Texture(pixels, float(np.asarray(look.image.getchannel("A")).max()) / 255.0 if has_alpha else None)
    except SceneError as error:
        return error
    finally:
        look.image.close()


def _surface(look: _Look, textures: Mapping[int, _Texture | SceneError]) -> Surface:
    read = textures.get(id(look.image))
    texture, strongest = read if isinstance(read, _Texture) else (None, None)
    colour = np.ones(3) if texture is not None else np.array(PLAIN_COLOUR)
    if look.colour is not None and not (texture is not None and look.colour.max() == 0.0):
        # Exporters write a black Kd beside a texture and mean the texture.
        colour = np.clip(look.colour, 0.0, 1.0)
    material = Material(look.name, (float(colour[0]), float(colour[1]), float(colour[2])), texture)
    return Surface(material, clear=_is_clear(look, strongest), shines=look.shines)


def _is_clear(look: _Look, strongest: float | None) -> bool:
    return look.blended and look.alpha * (1.0 if strongest is None else strongest) < CLEAR_ALPHA


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
    blended = material.alphaMode in ("BLEND", "MASK")
    shines = material.emissiveFactor is not None  # see SHINES of gltf_plain
    return _Look(str(material.name), colour, float(factor[3]), material.baseColorTexture, blended, shines)


def _look_of_mtl(material: SimpleMaterial) -> _Look | None:
    """None for the material that trimesh gives to what has texture coordinates only; its image is of no file."""
    words = material.kwargs
    if material.image is not None and material.image.format is None:
        return None
    colour = np.asarray(material.diffuse, dtype=np.float64).ravel()[:3] / 255.0 if "kd" in words else None
    alpha = _number(words.get("d"), 1.0) if "d" in words else 1.0 - _number(words.get("tr"), 0.0)
    return _Look(str(material.name), colour, alpha, material.image, True, False)


def _number(words: object, otherwise: float) -> float:
    try:
        value = float(words[-1]) if isinstance(words, list) else otherwise
    except ValueError:
        return otherwise
    return value if np.isfinite(value) else otherwise
