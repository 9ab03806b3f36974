import base64
import json
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

from slamgym.camera import PinholeCamera
from slamgym.errors import SceneError
from slamgym.geometry import mast_camera_pose
from slamgym.render import Renderer
from slamgym.scenes.house import House
from slamgym.scenes.importing.placed_options import PlacedOptions
from slamgym.scenes.mesh import Mesh, read_mesh

AS_IT_IS = PlacedOptions(up="z", unit=1.0, floor=0.0)
AUTO = PlacedOptions()
RED, GREEN, BLUE, WHITE = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)
PRINT = np.array([[RED, GREEN], [BLUE, WHITE]], np.uint8)
"""Red at the upper left."""
# A wall 2 x 2 m that a camera at the origin sees when it looks along x: its left is at y = 1.
WALL = np.array([[2, 1, 0], [2, -1, 0], [2, -1, 2], [2, 1, 2]], np.float32)
QUAD = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
WALL_UV = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
"""(0, 0) at the lower left."""


def png(pixels=PRINT):
    content = BytesIO()
    Image.fromarray(pixels).save(content, "PNG")
    return content.getvalue()


def uri(content):
    return "data:application/octet-stream;base64," + base64.b64encode(content).decode()


def gltf(path, material=None, image=None, colours=None, nodes=None, vertices=WALL):
    """A wall in glTF, by hand. There v runs down from the upper left."""
    arrays = {"POSITION": vertices, "TEXCOORD_0": WALL_UV * (1, -1) + (0, 1)} | (
        {} if colours is None else {"COLOR_0": colours}
    )
    blobs = [QUAD.tobytes(), *(np.asarray(array, np.float32).tobytes() for array in arrays.values())]
    tree = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": list(range(len(nodes or [0])))}],
        "nodes": nodes or [{"name": "wall", "mesh": 0}],
        "meshes": [{"primitives": [{"indices": 0, "attributes": {name: k + 1 for k, name in enumerate(arrays)}}]}],
        "buffers": [{"byteLength": len(blob), "uri": uri(blob)} for blob in blobs],
        "bufferViews": [{"buffer": k, "byteLength": len(blob)} for k, blob in enumerate(blobs)],
        "accessors": [{"bufferView": 0, "componentType": 5125, "count": 6, "type": "SCALAR"}]
        + [
            {"bufferView": k + 1, "componentType": 5126, "count": 4, "type": f"VEC{array.shape[1]}"}
            for k, array in enumerate(arrays.values())
        ],
    }
    if material is not None:
        tree["materials"] = [material]
        tree["meshes"][0]["primitives"][0]["material"] = 0
    if image is not None:
        tree |= {"images": [{"uri": image}], "textures": [{"source": 0}]}
    path.write_text(json.dumps(tree))
    return path


TEXTURED = {"name": "print", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}


def obj(path, mtl, usemtl="usemtl print"):
    lines = [f"v {x} {y} {z}" for x, y, z in WALL] + [f"vt {u} {v}" for u, v in WALL_UV]
    path.write_text("\n".join(["mtllib wall.mtl", *lines, usemtl, "f 1/1 2/2 3/3", "f 1/1 3/3 4/4"]) + "\n")
    path.with_name("wall.mtl").write_text(mtl)
    return path


def colour_at(part, corner, towards=(0.5, 0.5)):
    """Of the texture, next to a corner of the wall."""
    k = np.linalg.norm(part.vertices - WALL[corner], axis=1).argmin()
    u, v = (part.uv[k] * 0.8 + np.multiply(towards, 0.2)) % 1.0
    height, width = part.material.texture.shape[:2]
    return tuple(part.material.texture[int((1.0 - v) * height), int(u * width)].tolist())


def seen(house):
    """Four pixels of the wall, row by row, from the origin."""
    with Renderer(house, PinholeCamera(40, 40, 20.0, 20.0, 20.0, 20.0), lighting="flat", multisampling=0) as renderer:
        rgb, _ = renderer.render(mast_camera_pose(0.0, 0.0, 0.0, 1.0))
    return rgb[[15, 15, 25, 25], [15, 25, 15, 25]].astype(int)


@pytest.fixture
def wall_files(tmp_path):
    (tmp_path / "print.png").write_bytes(png())
    flat = gltf(tmp_path / "wall.gltf", TEXTURED, uri(png()))
    trimesh.load(flat).export(tmp_path / "wall.glb")
    obj(tmp_path / "wall.obj", "newmtl print\nKd 1 1 1\nmap_Kd print.png\n")
    return tmp_path


@pytest.mark.parametrize("name", ["wall.gltf", "wall.glb", "wall.obj"])
def test_textures_are_the_right_way_up(wall_files, name):
    house = read_mesh(wall_files / name, AS_IT_IS)
    (part,) = house.parts
    assert [colour_at(part, corner) for corner in range(4)] == [BLUE, WHITE, GREEN, RED]
    assert np.abs(seen(house) - [RED, GREEN, BLUE, WHITE]).max() < 60
    assert house.defects == ()


def test_a_room_comes_with_what_was_assumed(tmp_path):
    box = trimesh.creation.box((4.0, 2.6, 5.0))  # y up, its middle at the origin
    box.invert()
    box.export(tmp_path / "room.glb")
    house = Mesh.load(tmp_path / "room.glb", AUTO)
    assert house.name == str(tmp_path / "room.glb")
    assert house.assumptions == (
        "up axis: y, as glTF has it",
        "unit: 1 m, as a storey is 2.60 high",
        "floor: at -1.3 m, a level surface of 100% of the rectangle",
    )
    (part,) = house.parts
    np.testing.assert_allclose(part.vertices.min(axis=0), [-2.0, -2.5, 0.0], atol=1e-6)
    np.testing.assert_allclose(part.vertices.max(axis=0), [2.0, 2.5, 2.6], atol=1e-6)
    assert (part.vertices.dtype, part.faces.dtype) == (np.float32, np.int32)
    assert part.material.colour == (0.8, 0.8, 0.8)
    assert house.defects == ()


def test_a_real_house(shared_data):
    house = read_mesh(shared_data / "scenes" / "aws_small_house.glb", AUTO)
    assert house.assumptions[0] == (
        "up axis: z, seen in the geometry (glTF says y, but a storey would be 8.6 high with y up, not 3)"
    )
    assert sum(len(part.faces) for part in house.parts) == 145_840
    assert len({id(part.material.texture) for part in house.parts if part.material.texture is not None}) == 64
    vertices = np.concatenate([part.vertices for part in house.parts])
    np.testing.assert_allclose(np.ptp(vertices, axis=0), [19.0, 11.4, 3.0], atol=0.01)
    assert [defect.partition(",")[0] for defect in house.defects] == [
        "aws_small_house.glb: 4 faces without area left out"
    ]


def test_glb_is_also_read_from_the_process_of_its_own(wall_files):
    there, here = Mesh.load(wall_files / "wall.glb", AS_IT_IS), read_mesh(wall_files / "wall.glb", AS_IT_IS)
    assert (there.parts[0].vertices == here.parts[0].vertices).all()
    assert (there.parts[0].material.texture == PRINT).all()
    assert there.assumptions == here.assumptions


@pytest.mark.parametrize(
    ("transform", "seen_at_corners"),
    [
        ({}, [BLUE, WHITE, GREEN, RED]),
        ({"offset": [0.5, 0.0]}, [WHITE, BLUE, RED, GREEN]),
        ({"offset": [0.0, 0.5]}, [RED, GREEN, WHITE, BLUE]),
        # The coordinates turn counter-clockwise, so the picture clockwise: its lower left goes to the upper left.
        ({"rotation": np.pi / 2}, [WHITE, GREEN, RED, BLUE]),
        ({"scale": [0.25, 0.25]}, [RED, RED, RED, RED]),
    ],
)
def test_transforms_of_textures(tmp_path, transform, seen_at_corners):
    texture = {"index": 0, "extensions": {"KHR_texture_transform": transform}}
    material = {"name": "print", "pbrMetallicRoughness": {"baseColorTexture": texture}}
    (part,) = read_mesh(gltf(tmp_path / "wall.gltf", material, uri(png())), AS_IT_IS).parts
    middle = part.uv.mean(axis=0)
    assert [colour_at(part, corner, towards=middle) for corner in range(4)] == seen_at_corners


def test_linear_factors_become_srgb(tmp_path):
    plain = {"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.5, 1.0, 1.0]}}
    (part,) = read_mesh(gltf(tmp_path / "wall.gltf", plain), AS_IT_IS).parts
    # 1.055 * 0.2^(1/2.4) - 0.055 and so on, by a pocket calculator; the factor is kept in 8 bits.
    np.testing.assert_allclose(part.material.colour, [0.4845, 0.7354, 1.0], atol=0.003)
    assert part.uv is None


def test_vertex_colours_of_gltf_are_linear_too(tmp_path):
    colours = np.array([[0.2, 0.5, 1.0, 1.0]] * 4, np.float32)
    for material in (None, {"name": "white"}):
        (part,) = read_mesh(gltf(tmp_path / "wall.gltf", material, colours=colours), AS_IT_IS).parts
        np.testing.assert_allclose(part.colour, [[0.4845, 0.7354, 1.0]] * 4, atol=0.003)
        assert part.material.colour == pytest.approx((1.0, 1.0, 1.0))


def test_what_is_clear_is_left_out_and_what_shines_has_its_light(tmp_path):
    glass = {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.2]}}
    nodes = [{"name": "wall", "mesh": 0}, {"name": "pane", "mesh": 0}]
    with pytest.raises(SceneError, match="expected triangles, got none"):
        read_mesh(gltf(tmp_path / "glass.gltf", glass, nodes=nodes), AS_IT_IS)
    solid = glass | {"alphaMode": "OPAQUE"}
    assert len(read_mesh(gltf(tmp_path / "solid.gltf", solid, nodes=nodes), AS_IT_IS).parts) == 2
    bulb = {"emissiveFactor": [1.0, 1.0, 0.5], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}}
    (part,) = read_mesh(gltf(tmp_path / "bulb.gltf", bulb), AS_IT_IS).parts
    assert (part.light == 1.0).all()
    np.testing.assert_allclose(part.material.colour, [1.0, 1.0, 0.7354], atol=0.003)


UNLIT: dict[str, object] = {"extensions": {"KHR_materials_unlit": {}}}
BLACK = {"baseColorFactor": [0, 0, 0, 1]}
PICTURE = {"index": 0}


@pytest.mark.parametrize(
    ("material", "colour", "has_texture", "shines"),
    [
        (TEXTURED | UNLIT, (1, 1, 1), True, True),
        (UNLIT | {"emissiveFactor": [1, 1, 1], "pbrMetallicRoughness": BLACK}, (0, 0, 0), False, True),
        # An emissive texture is the picture where there is no other, in the factor's colour.
        ({"emissiveFactor": [1, 1, 0.5], "emissiveTexture": PICTURE}, (1, 1, 0.7354), True, True),
        (
            {"emissiveFactor": [1, 1, 1], "emissiveTexture": PICTURE, "pbrMetallicRoughness": BLACK},
            (1, 1, 1),
            True,
            True,
        ),
        (TEXTURED | {"emissiveFactor": [1, 1, 1], "emissiveTexture": PICTURE}, (1, 1, 1), True, True),
        (TEXTURED | {"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 1}}, (1, 1, 1), True, False),
        (TEXTURED | {"emissiveFactor": [1, 1, 1]}, (1, 1, 1), True, True),
        # A glow is none.
        ({"emissiveFactor": [0.4, 0, 0], "pbrMetallicRoughness": BLACK}, (0, 0, 0), False, False),
        ({"emissiveFactor": [0.4, 0, 0], "emissiveTexture": PICTURE}, (1, 1, 1), False, False),
    ],
)
def test_light_that_is_in_a_material(tmp_path, material, colour, has_texture, shines):
    path = gltf(tmp_path / "wall.gltf", material, uri(png()))
    tree = json.loads(path.read_text())
    tree["images"].append({"uri": uri(png(PRINT[::-1]))})
    tree["textures"].append({"source": 1})
    path.write_text(json.dumps(tree))
    house = read_mesh(path, AS_IT_IS)
    (part,) = house.parts
    assert part.material.colour == pytest.approx(colour, abs=0.003)
    assert (part.material.texture is not None) is has_texture
    assert (part.light is not None) is shines
    assert has_texture is False or (part.material.texture == PRINT).all()
    assert house.defects == ()


def test_clear_materials_of_obj_are_told(tmp_path):
    path = obj(tmp_path / "wall.obj", "newmtl print\nKd 1 1 1\nd 0.1\n")
    path.write_text(path.read_text() + "usemtl frame\nf 1 2 3\n")
    (tmp_path / "wall.mtl").write_text("newmtl print\nd 0.1\n\nnewmtl frame\nKd 0.25 0.5 1\n")
    house = read_mesh(path, AS_IT_IS)
    assert [part.material.name for part in house.parts] == ["frame"]
    np.testing.assert_allclose(house.parts[0].material.colour, [0.25, 0.5, 1.0], atol=0.003)
    assert house.assumptions[3] == "left out as clear: 'print'"


def test_a_black_kd_beside_a_texture_is_not_meant(tmp_path):
    (tmp_path / "print.png").write_bytes(png())
    for kd, colour in (("0 0 0", (1.0, 1.0, 1.0)), ("1 0 1", (1.0, 0.0, 1.0))):
        path = obj(tmp_path / "wall.obj", f"newmtl print\nKd {kd}\nmap_Kd print.png\n")
        assert read_mesh(path, AS_IT_IS).parts[0].material.colour == colour


def test_a_mirrored_node_still_shows_its_outside(tmp_path):
    mirrored = [{"name": "wall", "mesh": 0}, {"name": "twin", "mesh": 0, "scale": [-1, 1, 1]}]
    house = read_mesh(gltf(tmp_path / "walls.gltf", nodes=mirrored), AS_IT_IS)
    corners = {part.name: part.vertices[part.faces[0]] for part in house.parts}
    normals = {name: np.cross(b - a, c - a).tolist() for name, (a, b, c) in corners.items()}
    assert normals == {"wall/GLTF": [-4.0, 0.0, 0.0], "twin/GLTF": [4.0, 0.0, 0.0]}


def test_colours_of_vertices_and_faces(tmp_path):
    header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n"
    faces = "element face 2\nproperty list uchar int vertex_indices\n"
    corners = [f"{x} {y} {z}" for x, y, z in WALL]
    vertex = "\n".join(f"{corner} 255 {51 * k} 0" for k, corner in enumerate(corners))
    (tmp_path / "v.ply").write_text(f"{header}{rgb}{faces}end_header\n{vertex}\n3 0 1 2\n3 0 2 3\n")
    (part,) = read_mesh(tmp_path / "v.ply", AS_IT_IS).parts
    np.testing.assert_allclose(part.colour, [[1.0, 0.2 * k, 0.0] for k in range(4)], atol=1e-6)
    assert part.material.colour == (1.0, 1.0, 1.0)
    face = "3 0 1 2 255 0 0\n3 0 2 3 0 0 255\n"
    (tmp_path / "f.ply").write_text(f"{header}{faces}{rgb}end_header\n" + "\n".join(corners) + f"\n{face}")
    (part,) = read_mesh(tmp_path / "f.ply", AS_IT_IS).parts
    assert part.colour[part.faces].tolist() == [[[1, 0, 0]] * 3, [[0, 0, 1]] * 3]


def test_texture_coordinates_that_are_not_the_first(tmp_path):
    moved = {"KHR_texture_transform": {"texCoord": 1}}
    for picture in ({"index": 0, "texCoord": 1}, {"index": 0, "texCoord": 7, "extensions": moved}):
        material = {"name": "print", "pbrMetallicRoughness": {"baseColorTexture": picture}}
        path = gltf(tmp_path / "wall.gltf", material, uri(png()))
        tree = json.loads(path.read_text())
        attributes = tree["meshes"][0]["primitives"][0]["attributes"]
        attributes |= {"TEXCOORD_1": attributes["TEXCOORD_0"], "TEXCOORD_0": len(tree["accessors"])}
        tree["accessors"].append({"componentType": 5126, "count": 4, "type": "VEC2"})  # all zero
        path.write_text(json.dumps(tree))
        (part,) = read_mesh(path, AS_IT_IS).parts
        assert [colour_at(part, corner) for corner in range(4)] == [BLUE, WHITE, GREEN, RED]


# Bad input


def test_bad_vertices_are_told_and_the_rest_is_used(tmp_path):
    lines = [
        "v 0 0 0",
        "v 4 0 0",
        "v 4 4 0",
        "v 0 4 0",
        "v nan 0 1",
        "v 300000 300000 0",
        "v 300001 300001 0",
        "v 300000 300001 1",
    ]
    extra = ["v 0 0 2.5", "v 4 0 2.5", "v 4 4 2.5", "v 0 4 2.5"]
    faces = ["1 2 3", "1 3 4", "1 2 5", "1 1 2", "6 7 8", "1 2 10", "1 10 9", "2 3 11", "2 11 10", "3 4 12", "3 12 11"]
    (tmp_path / "room.obj").write_text("\n".join(lines + extra + [f"f {face}" for face in faces]))
    house = read_mesh(tmp_path / "room.obj", PlacedOptions(up="z"))
    assert sum(len(part.faces) for part in house.parts) == 8
    assert [defect.partition(" left out")[0] for defect in house.defects] == [
        "room.obj: 1 face with vertices that are not numbers",
        "room.obj: 1 face without area",
        "room.obj: 1 face far away from all others",
    ]
    assert max(float(part.vertices.max()) for part in house.parts) == 4.0


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("missing.png", "No such file"),
        ("broken.png", "expected an image"),
        ("wood.dds", "expected an image"),
        ("../secret.png", "leaves it"),
        ("/etc/passwd", "leaves it"),
        ("file:///etc/passwd", "nothing is fetched"),
        ("http://127.0.0.1:9/a.png", "nothing is fetched"),
        ("link.png", "leaves it"),
        ("pipe.png", "which is none"),
    ],
)
def test_textures_that_cannot_be_had_are_told(hostile_folder, name, message):
    (hostile_folder / "broken.png").write_bytes(png()[:50])
    (hostile_folder / "wood.dds").write_bytes(b"DDS of another kind")
    for path in (
        obj(hostile_folder / "wall.obj", f"newmtl print\nKd 1 0 0\nmap_Kd {name}\n"),
        gltf(hostile_folder / "wall.gltf", TEXTURED, name),
    ):
        house = read_mesh(path, AS_IT_IS)
        assert house.parts[0].material.texture is None
        assert house.defects[0].startswith(f"{path.name}: ")
        assert any(message in defect for defect in house.defects), house.defects


@pytest.mark.parametrize("name", ["../wall.mtl", "/etc/passwd", "http://127.0.0.1:9/wall.mtl", "pipe.png"])
def test_materials_outside_the_folder_are_not_read(hostile_folder, name):
    path = obj(hostile_folder / "wall.obj", "")
    (hostile_folder.parent / "wall.mtl").write_text("newmtl print\nKd 1 0 0\n")
    path.write_text(path.read_text().replace("wall.mtl", name))
    house = read_mesh(path, AS_IT_IS)
    assert house.parts[0].material.colour == (0.8, 0.8, 0.8)
    assert name in house.defects[0]


def test_geometry_outside_the_folder_is_refused(hostile_folder):
    path = gltf(hostile_folder / "wall.gltf")
    tree = json.loads(path.read_text())
    tree["buffers"][0]["uri"] = "../secret.png"
    path.write_text(json.dumps(tree))
    with pytest.raises(SceneError, match="which leaves it"):
        read_mesh(path, AS_IT_IS)


def test_textures_in_a_subfolder_with_a_space(tmp_path):
    (tmp_path / "my images").mkdir()
    (tmp_path / "my images" / "print.png").write_bytes(png())
    path = gltf(tmp_path / "wall.gltf", TEXTURED, "my%20images/print.png")
    assert (read_mesh(path, AS_IT_IS).parts[0].material.texture == PRINT).all()


@pytest.mark.parametrize("suffix", Mesh.suffixes)
@pytest.mark.parametrize("content", [b"", b"hello", b"\xff" * 300])
def test_what_is_no_mesh_is_refused(tmp_path, suffix, content):
    path = tmp_path / f"house{suffix}"
    path.write_bytes(content)
    with pytest.raises(SceneError) as told:
        read_mesh(path, AUTO)
    assert str(told.value).startswith(f"{path}: expected ")
    assert len(str(told.value).splitlines()) == 1


def test_truncated_files_are_refused(wall_files):
    trimesh.creation.box().export(wall_files / "wall.stl")
    trimesh.creation.box().export(wall_files / "wall.ply")
    for name in ("wall.glb", "wall.gltf", "wall.stl", "wall.ply"):
        path = wall_files / name
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
        with pytest.raises(SceneError, match="cannot be read"):
            read_mesh(path, AS_IT_IS)


def test_what_is_no_triangle_is_told_and_the_rest_is_used(tmp_path):
    path = gltf(tmp_path / "wall.gltf", nodes=[{"name": "wall", "mesh": 0}, {"name": "edge", "mesh": 1}])
    tree = json.loads(path.read_text())
    (wall,) = tree["meshes"][0]["primitives"]
    unindexed = {"attributes": wall["attributes"]}
    tree["meshes"] = [
        {"name": "wall", "primitives": [wall, unindexed, wall | {"mode": 6}, wall | {"mode": 5}]},
        {"name": "edge", "primitives": [wall | {"mode": mode} for mode in (0, 1, 2, 3)]},
    ]
    tree["nodes"][1]["children"] = [2]
    tree["nodes"].append({"name": "below", "mesh": 0, "translation": [0, 0, -5]})
    path.write_text(json.dumps(tree))
    house = read_mesh(path, AS_IT_IS)
    # Twice, as the edge's child stands: two indexed triangles, one of four corners, three with an area of a strip.
    assert sum(len(part.faces) for part in house.parts) == 2 * (2 + 1 + 3)
    assert house.defects[:2] == (
        "wall.gltf: primitives left out: expected triangles or strips of them, got others, in 'wall', 'edge'",
        "wall.gltf: corners left out: expected three for each triangle, got a rest, in 'wall'",
    )
    tree["meshes"] = [{"name": "wall", "primitives": [wall | {"mode": 6}]}]
    tree |= {"scenes": [{"nodes": [0]}], "nodes": tree["nodes"][:1]}
    path.write_text(json.dumps(tree))
    with pytest.raises(SceneError, match="expected triangles or strips of them, got others, in 'wall'"):
        read_mesh(path, AS_IT_IS)


def test_a_changed_header_goes_with_the_binary_content_of_a_glb(tmp_path):
    rest = trimesh.Trimesh(WALL, QUAD, process=False)
    rest.export(tmp_path / "wall.glb")
    data = (tmp_path / "wall.glb").read_bytes()
    end = 20 + int.from_bytes(data[12:16], "little")
    tree = json.loads(data[20:end])
    tree["accessors"][tree["meshes"][0]["primitives"][0]["indices"]]["count"] = 5
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    size = (20 + len(text) + len(data) - end).to_bytes(4, "little")
    head = data[:8] + size + len(text).to_bytes(4, "little") + data[16:20]
    (tmp_path / "wall.glb").write_bytes(head + text + data[end:])
    house = read_mesh(tmp_path / "wall.glb", AS_IT_IS)
    assert [part.vertices[part.faces].tolist() for part in house.parts] == [[WALL[:3].tolist()]]
    assert "corners left out" in house.defects[0]


def test_instances_are_told(tmp_path):
    more = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}
    house = read_mesh(gltf(tmp_path / "w.gltf", nodes=[{"name": "row", "mesh": 0, "extensions": more}]), AS_IT_IS)
    assert len(house.parts) == 1
    assert house.defects == (
        "w.gltf: instances left out: expected a node for each, got EXT_mesh_gpu_instancing, in 'row'",
    )


def test_too_much_is_refused(tmp_path):
    path = gltf(tmp_path / "wall.gltf")
    tree = json.loads(path.read_text())
    for change, message in (
        ({"accessors": [{"componentType": 5126, "count": 10**12, "type": "SCALAR"}]}, "at most 50000000 numbers"),
        ({"nodes": [{"mesh": 0}] * 100_001}, "at most 100000 nodes"),
        ({"extensionsRequired": ["KHR_draco_mesh_compression"]}, "without compression"),
    ):
        path.write_text(json.dumps(tree | change))
        with pytest.raises(SceneError, match=message):
            read_mesh(path, AS_IT_IS)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"nodes": 5}, "expected nodes to be a list of objects, got 5; export"),
        ({"accessors": None}, "expected accessors to be a list of objects, got None"),
        ({"accessors": [{"count": "many"}]}, "each accessor to have a count, got 'many'"),
        ({"nodes": [{"children": "all"}]}, "a node's children to be numbers, got 'all'"),
        ({"nodes": [{"children": [k + 1]} for k in range(1100)]}, "at most 1000 nodes one inside another, got 1001"),
    ],
)
def test_malformed_trees_are_told(tmp_path, change, message):
    path = gltf(tmp_path / "wall.gltf")
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    with pytest.raises(SceneError, match=message):
        read_mesh(path, AS_IT_IS)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("house.glb", b"", "expected a .glb file, got an empty file"),
        ("house.glb", b"PK", "got one that does not begin with glTF or {; export"),
        ("house.gltf", b'{"a":' + b"[" * 200_000, "nested too deeply"),
        ("house.obj", b"v 0 0 0\n\0", "expected text, got a binary file; is it really an .obj"),
    ],
)
def test_broken_headers_are_told(tmp_path, name, content, message):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(SceneError, match=message):
        read_mesh(tmp_path / name, AUTO)


def test_instances_that_multiply_are_refused(tmp_path):
    ball = trimesh.creation.icosphere(subdivisions=6)  # 81,920 triangles
    scene = trimesh.Scene({"ball": ball})
    for k in range(70):
        scene.add_geometry(ball, node_name=f"n{k}", geom_name="ball")
    scene.export(tmp_path / "balls.glb")
    with pytest.raises(SceneError, match="at most 5000000 triangles, got 5816320"):
        read_mesh(tmp_path / "balls.glb", AS_IT_IS)


def test_points_are_no_mesh(tmp_path):
    trimesh.PointCloud(np.eye(3)).export(tmp_path / "scan.ply")
    with pytest.raises(SceneError, match=r"got none that can be used"):
        read_mesh(tmp_path / "scan.ply", AS_IT_IS)


def test_a_scene_without_floor_is_refused_unless_its_height_is_given(tmp_path):
    trimesh.creation.icosphere(subdivisions=3).export(tmp_path / "ball.stl")
    with pytest.raises(SceneError, match=r"ball.stl: no floor found.*give the scene options up, unit and floor"):
        read_mesh(tmp_path / "ball.stl", AUTO)
    assert isinstance(read_mesh(tmp_path / "ball.stl", PlacedOptions(floor=-1.0)), House)


def test_a_missing_file_is_told(tmp_path):
    with pytest.raises(SceneError, match="No such file"):
        Mesh.load(Path(tmp_path / "none.glb"), AUTO)
