"""Broken and hostile mesh files: each gives a house or an error of one line, and nothing outside its folder is read."""

import json

import numpy as np
import pytest
import trimesh
from PIL import Image

ENTRIES = ("room.glb", "room.gltf", "room.obj", "room.ply", "coloured.ply", "room.stl", "text.stl")


def textured_box(extents, centre, image):
    box = trimesh.creation.box(extents, trimesh.transformations.translation_matrix(centre))
    box.unmerge_vertices()
    material = trimesh.visual.material.PBRMaterial(
        name="print", baseColorTexture=image, baseColorFactor=[255, 200, 90, 255]
    )
    box.visual = trimesh.visual.TextureVisuals(uv=box.vertices[:, :2] / 4.0, material=material)
    return box


def room():
    """A room 4 x 5 x 2.6 m, y up, with a box in it that is painted corner by corner."""
    rng = np.random.default_rng(0)
    image = Image.fromarray(rng.integers(0, 255, (8, 8, 3), np.uint8))
    box = trimesh.creation.box((0.5, 0.8, 0.5), trimesh.transformations.translation_matrix((1.0, 0.4, 1.0)))
    box.visual.vertex_colors = rng.integers(0, 255, (8, 4), np.uint8)
    shell = textured_box((4.0, 2.6, 5.0), (0.0, 1.3, 0.0), image)
    scene = trimesh.Scene({"shell": shell, "box": box})
    scene.add_geometry(box, node_name="again", geom_name="box", transform=np.diag([1.0, 1.0, -1.0, 1.0]))
    return scene


@pytest.fixture
def corpus(hostile_folder):
    scene = room()
    for name in ("room.glb", "room.obj"):
        scene.export(hostile_folder / name)
    for name, content in scene.export(file_type="gltf").items():
        (hostile_folder / name.replace("model", "room")).write_bytes(content)
    mesh = scene.to_mesh()
    mesh.export(hostile_folder / "room.ply")
    scene.geometry["box"].export(hostile_folder / "coloured.ply", encoding="ascii")
    mesh.export(hostile_folder / "room.stl")
    scene.geometry["box"].export(hostile_folder / "text.stl", file_type="stl_ascii")
    refine(hostile_folder)
    return hostile_folder


def refine(folder):
    """Have the .gltf name its image as a file, and use what trimesh does not write."""
    with (folder / "room.obj").open("a") as file:
        file.write("f -1 -2 -3\n")
    header = json.loads((folder / "room.gltf").read_text())
    view = header["bufferViews"][header["images"][0].pop("bufferView")]
    buffer = (folder / header["buffers"][view["buffer"]]["uri"]).read_bytes()
    start = view.get("byteOffset", 0)
    (folder / "print.png").write_bytes(buffer[start : start + view["byteLength"]])
    header["images"][0] = {"uri": "print.png"}
    texture = header["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]
    texture["extensions"] = {"KHR_texture_transform": {"offset": [0.5, 0.1], "scale": [2, 3], "rotation": 1.5}}
    (folder / "room.gltf").write_text(json.dumps(header))


def run(fuzz, corpus, count, seed, limit_s):
    told = fuzz("slamgym.scenes.mesh:Mesh", "slamgym.scenes.mesh:read_mesh", corpus, ENTRIES, count, seed, limit_s)
    assert sum(told.values()) == count
    return told


def test_200_broken_meshes(fuzz, corpus):
    told = run(fuzz, corpus, 200, seed=1, limit_s=120)
    # As it should be with such damage: some of it harmless, some beyond repair.
    assert all(told[name, outcome] for name in ENTRIES for outcome in ("read", "refused")), told


@pytest.mark.fuzz
def test_10_000_broken_meshes(fuzz, corpus):
    run(fuzz, corpus, 10_000, seed=2, limit_s=3000)
