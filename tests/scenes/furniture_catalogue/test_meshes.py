"""Models as shapes: turned upright, stretched, coloured; and those that would look wrong."""

import io

import numpy as np
import pytest
from PIL import Image

from slamgym.errors import SceneError
from slamgym.scenes.furniture_catalogue.catalogue import read_catalogue
from slamgym.scenes.furniture_catalogue.meshes import shape_of
from slamgym.scenes.home.furniture.piece import Piece


def corners(component):
    return {tuple(vertex) for vertex in component.mesh.vertices.round(6).tolist()}


def by_material(shape):
    return {component.finish.material.name: component for component in shape.components}


@pytest.fixture
def shape(tmp_path, write_catalogue, entry):
    """A function that gives the shape of one model with these files and keys."""

    def of(content=None, **changed):
        write_catalogue("a.sh3f", entry(**changed), content=content)
        return shape_of(read_catalogue(tmp_path).models[0])

    return of


def test_a_model_fills_the_unit_box_with_its_front_forward(shape):
    components = by_material(shape())
    low, high = Piece("box", tuple(components.values())).bounds
    np.testing.assert_allclose([low, high], [[-0.5, 0.0, 0.0], [0.5, 1.0, 1.0]], atol=1e-12)
    # The face at the file's +z, with the file's x to the right for those who look at it, so to -x here.
    assert corners(components["front"]) == {(-0.5, 1, 0), (0.5, 1, 0), (0.5, 1, 1), (-0.5, 1, 1)}
    assert corners(components["cloth"]) >= {(-0.5, 0, 0), (0.5, 0, 1)}


def test_a_model_is_not_mirrored(shape, files):
    obj = files()["sofa/thing.obj"].decode().replace("v 2 5 4", "v 2.5 5 4")
    marked = by_material(shape(files(obj=obj)))["front"]
    # The corner at the file's right, top and front sticks out: right is -x for those who face the front.
    assert corners(marked) == {(0.5, 1, 0), (-0.3, 1, 0), (-0.5, 1, 1), (0.5, 1, 1)}


def test_faces_stay_counter_clockwise_from_outside(shape):
    for component in shape().components:
        a, b, c = (component.mesh.vertices[component.mesh.faces[:, k]] for k in range(3))
        outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), (a + b + c) / 3 - (0.0, 0.5, 0.5))
        assert (outward > 0).all()


def test_the_catalogue_turns_a_model(shape):
    # A quarter about the file's upward axis takes its front, +z, to +x, so to -x here.
    turned = by_material(shape(modelRotation="0 0 1 0 1 0 -1 0 0"))
    assert corners(turned["front"]) == {(-0.5, 0, 0), (-0.5, 1, 0), (-0.5, 0, 1), (-0.5, 1, 1)}


def test_textures_count_as_they_are_and_plain_colours_within_bounds(shape, files):
    mtl = files()["sofa/thing.mtl"].decode().replace("Kd 0.2 0.4 0.6", "Kd 0 0.4 1")
    components = by_material(shape(files(mtl=mtl)))
    cloth, front = (components[name].finish.material for name in ("cloth", "front"))
    assert cloth.colour == (1.0, 1.0, 1.0)
    assert cloth.texture.tolist() == [[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [255, 255, 255]]]
    assert front.texture is None
    assert front.colour == pytest.approx((0.12, 0.4, 0.93), abs=0.003)


def test_texture_coordinates_begin_at_the_lower_left(shape, files):
    mtl = files()["sofa/thing.mtl"].decode() + "map_Kd cloth.png\n"
    front = by_material(shape(files(mtl=mtl)))["front"].mesh
    uv = dict(zip(map(tuple, front.vertices.round(6).tolist()), map(tuple, front.uv.tolist()), strict=True))
    assert uv == {(0.5, 1, 0): (0, 0), (-0.5, 1, 0): (1, 0), (-0.5, 1, 1): (1, 1), (0.5, 1, 1): (0, 1)}


@pytest.mark.parametrize("kept", [0, 20, 45, None])
def test_a_missing_or_broken_texture_is_counted_and_its_colour_used(shape, files, kept):
    content = files()
    image = content.pop("sofa/cloth.png")
    found = shape(content if kept is None else {**content, "sofa/cloth.png": image[:kept]})
    assert found.missing == 1
    assert by_material(found)["cloth"].finish.material.colour == pytest.approx((0.5, 0.25, 0.2), abs=0.003)


def with_hole():
    pixels = np.full((4, 4, 4), 255, np.uint8)
    pixels[0, :2, 3] = 0
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "PNG")
    return file.getvalue()


@pytest.mark.parametrize(
    ("name", "change", "why"),
    [
        ("thing.obj", lambda data: data.replace(b"v 0 0 0", b"v nan 0 0"), "expected vertices with numbers"),
        ("thing.obj", lambda data: data.replace(b"5/1 6/2", b"99/1 6/2"), "expected"),
        ("thing.obj", lambda data: data.replace(b"v 2 ", b"v 0 "), "got a flat one"),
        ("thing.obj", lambda _: b"", "expected"),
        ("thing.obj", lambda data: data + b"f 1/1 2/2 3/3\n" * 40_000, "expected 1 to 40000 triangles, got 40012"),
        ("thing.mtl", lambda data: data.replace(b"Kd 0.5", b"d 0.1\nKd 0.5"), "got one of glass"),
        ("thing.mtl", lambda _: None, "'sofa/thing.mtl': expected an entry"),
        ("cloth.png", lambda _: with_hole(), "got one with clear parts"),
    ],
)
def test_what_would_look_wrong_is_refused_in_one_line(shape, files, name, change, why):
    content = files()
    changed = change(content.pop(f"sofa/{name}"))
    with pytest.raises(SceneError, match=r"^a.sh3f: Test#model1 left out: ") as told:
        shape(content if changed is None else {**content, f"sofa/{name}": changed})
    assert why in str(told.value)
    assert "\n" not in str(told.value)


def test_a_name_that_leaves_the_archive_is_not_read(shape, files, tmp_path):
    (tmp_path / "secret.png").write_bytes(files()["sofa/cloth.png"])
    mtl = files()["sofa/thing.mtl"].decode().replace("cloth.png", "../../../secret.png")
    assert shape(files(mtl=mtl)).missing == 1


def test_names_in_an_old_encoding(shape, files):
    old = {
        name: data.replace(b"front", "hölzern".encode("latin-1")) if name.endswith((".obj", ".mtl")) else data
        for name, data in files().items()
    }
    assert by_material(shape(old)).keys() == {"cloth", "hölzern"}
