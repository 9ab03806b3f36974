from io import BytesIO

import numpy as np
import pytest
from PIL import Image
from trimesh.visual.material import PBRMaterial

from slamgym.errors import SceneError
from slamgym.scenes.importing.materials import read_surfaces
from slamgym.scenes.importing.textures import MAX_SIDE, decode_texture, texture_of


def encoded(pixels, kind="PNG"):
    content = BytesIO()
    Image.fromarray(pixels).save(content, kind)
    return content.getvalue()


PIXELS = np.arange(24, dtype=np.uint8).reshape(2, 4, 3) * 10


def test_pixels_come_as_they_are():
    texture = decode_texture(encoded(PIXELS))
    assert texture.dtype == np.uint8
    assert (texture == PIXELS).all()


def test_grey_and_palette_images_become_colours():
    assert decode_texture(encoded(PIXELS[..., 0])).shape == (2, 4, 3)
    content = BytesIO()
    Image.fromarray(PIXELS).convert("P", palette=Image.Palette.ADAPTIVE).save(content, "PNG")
    assert np.abs(decode_texture(content.getvalue()).astype(int) - PIXELS).max() <= 4


def test_clear_pixels_take_the_mean_colour_of_the_others():
    clear = np.dstack([PIXELS, [[255, 255, 0, 255], [0, 0, 0, 255]]]).astype(np.uint8)
    opaque = PIXELS[clear[..., 3] == 255]
    texture = decode_texture(encoded(clear))
    assert (texture[0, 2] == opaque.mean(axis=0).round()).all()
    assert (texture[0, 0] == PIXELS[0, 0]).all()
    assert (decode_texture(encoded(clear), opaque=True) == PIXELS).all()


def test_large_images_are_scaled_down():
    assert decode_texture(encoded(np.zeros((30, 3 * MAX_SIDE, 3), np.uint8))).shape == (10, MAX_SIDE, 3)


@pytest.mark.parametrize(
    "content", [b"", b"hello", encoded(PIXELS)[:40], b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n"]
)
def test_broken_images_and_programs_are_refused(content):
    with pytest.raises(SceneError, match="expected an image") as told:
        decode_texture(content)
    assert len(str(told.value).splitlines()) == 1


def test_an_image_that_is_a_program_is_never_run():
    image = Image.open(BytesIO(b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n%%EndComments\n"))
    with pytest.raises(SceneError, match="got EPS"):
        texture_of(image)


def test_a_bomb_of_pixels_is_not_decoded():
    content = bytearray(encoded(PIXELS))
    content[16:24] = (60_000).to_bytes(4, "big") * 2  # the width and height in a PNG's header
    with pytest.raises(SceneError):
        decode_texture(bytes(content))
    with pytest.raises(SceneError, match="expected at most"):
        texture_of(Image.new("1", (12_000, 12_000)))


def test_images_are_closed_after_use():
    image = Image.open(BytesIO(encoded(PIXELS)))
    surfaces, defects = read_surfaces({"wall": PBRMaterial(name="print", baseColorTexture=image)})
    assert (surfaces["wall"].material.texture == PIXELS).all()
    assert defects == []
    with pytest.raises(ValueError, match="closed"):
        image.load()
