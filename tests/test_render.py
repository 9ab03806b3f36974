import gc
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace

import cv2
import numpy as np
import pytest
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from numpy.typing import NDArray

from slamgym.camera import CAMERAS, PinholeCamera
from slamgym.errors import ConfigError, RenderError
from slamgym.geometry import mast_camera_pose
from slamgym.render import Renderer, linear_depth, projection_matrix, visible_boxes
from slamgym.scenes.house import House, Material, Part
from slamgym.types import FloatArray

CAMERA = PinholeCamera(160, 120, 110.0, 112.0, 81.3, 57.8)


def quad(name: str, corners: list[tuple[float, float, float]], material: Material) -> Part:
    """A quadrilateral given counter-clockwise, its texture upright when seen with the first edge at the bottom."""
    vertices, uv = np.array(corners, np.float32), np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
    return Part(name, material, vertices, np.array([[0, 1, 2], [0, 2, 3]], np.int32), uv)


def wall(x: float, material: Material, half: float = 5.0) -> Part:
    """A wall in the plane x = const, seen by a camera that looks along +x; z from -half to half."""
    corners = [(x, half, -half), (x, -half, -half), (x, -half, half), (x, half, half)]
    return quad(f"wall{x}", corners, material)


def box(name: str, low: tuple[float, ...], high: tuple[float, ...], colour: tuple[float, float, float]) -> Part:
    corners = np.array(np.meshgrid(*zip(low, high, strict=True), indexing="ij"), np.float32).reshape(3, 8).T
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]], np.int32)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return Part(name, Material(name, colour), corners, faces)


def cluttered_room() -> House:
    rng = np.random.default_rng(0)
    parts = [box("room", (-4, -3, 0), (4, 3, 2.5), (0.8, 0.8, 0.7))]
    for k in range(25):
        low = rng.uniform((-3.8, -2.8, 0), (3.2, 2.2, 1.5))
        parts.append(box(f"box{k}", tuple(low), tuple(low + rng.uniform(0.1, 0.6, 3)), tuple(rng.uniform(0.2, 1, 3))))
    return House("cluttered", tuple(parts))


def poses(count: int) -> list[FloatArray]:
    rng = np.random.default_rng(1)
    places = rng.uniform((-3, -2, 0, 0.5), (3, 2, 2 * np.pi, 1.5), size=(count, 4))
    return [mast_camera_pose(x, y, yaw, height) for x, y, yaw, height in places]


def ray_cast_depth(house: House, camera: PinholeCamera, T_world_cam: FloatArray) -> NDArray[np.float32]:
    """Depth (H, W) along the optical axis through the pixels' centres, by Embree."""
    scene = EmbreeScene()
    TriangleMesh(scene, np.concatenate([part.vertices[part.faces] for part in house.parts]))
    v, u = np.indices((camera.height, camera.width))
    rays = np.stack([(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(u.shape)], axis=-1)
    directions = (rays.reshape(-1, 3) @ T_world_cam[:3, :3].T).astype(np.float32)
    origins = np.broadcast_to(T_world_cam[:3, 3], directions.shape).astype(np.float32)
    distance = scene.run(origins, directions, query="DISTANCE")
    return np.where(distance < 1e3, distance, 0.0).reshape(u.shape).astype(np.float32)


@pytest.fixture(scope="module")
def room() -> Iterator[Renderer]:
    with Renderer(cluttered_room(), CAMERA, "flat") as renderer:
        yield renderer


def test_images_have_the_promised_types(room: Renderer) -> None:
    rgb, depth = room.render(poses(1)[0])
    assert rgb.shape == (120, 160, 3)
    assert rgb.dtype == np.uint8
    assert depth.shape == (120, 160)
    assert depth.dtype == np.float32
    assert rgb.flags.c_contiguous
    assert depth.flags.c_contiguous


def test_depth_is_that_of_rays_through_the_pixel_centres(room: Renderer) -> None:
    for T_world_cam in poses(6):
        expected = ray_cast_depth(cluttered_room(), CAMERA, T_world_cam)
        _, depth = room.render(T_world_cam)
        seen = expected > 0.06
        relative = np.abs(depth - expected)[seen] / expected[seen]
        assert np.mean(relative > 1e-3) < 2e-3  # pixels that an edge crosses may go either way
        assert relative[relative < 1e-3].max() < 2e-4


def test_culling_leaves_nothing_out(monkeypatch: pytest.MonkeyPatch, room: Renderer) -> None:
    views = poses(12)
    culled = [room.render(pose) for pose in views]
    counts = [len(visible_boxes(room._corners, projection_matrix(CAMERA) @ np.linalg.inv(pose))) for pose in views]
    assert min(counts) < len(room._corners)
    monkeypatch.setattr("slamgym.render.visible_boxes", lambda corners, _: np.arange(len(corners)))
    for (rgb, depth), pose in zip(culled, views, strict=True):
        all_rgb, all_depth = room.render(pose)
        assert (rgb == all_rgb).all()
        assert (depth == all_depth).all()


def test_nothing_in_view_is_black_at_depth_0() -> None:
    empty = House("wall", (wall(-2.0, Material("w")), wall(45.0, Material("far"))))
    with Renderer(empty, CAMERA, "flat") as renderer:
        rgb, depth = renderer.render(mast_camera_pose(0, 0, 0, 0))
    assert not depth.any()
    assert not rgb.any()


def test_a_house_without_parts_renders_nothing() -> None:
    with Renderer(House("empty", ()), CAMERA, "flat") as renderer:
        assert not renderer.render(np.eye(4))[1].any()


def test_texture_is_upright_and_not_mirrored() -> None:
    image = np.zeros((4, 4, 3), np.uint8)
    image[:2, :2], image[:2, 2:], image[2:, :2], image[2:, 2:] = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0)
    house = House("picture", (wall(2.0, Material("picture", texture=image), half=1.0),))
    with Renderer(house, CAMERA, "flat") as renderer:
        rgb, _ = renderer.render(mast_camera_pose(0, 0, 0, 0))
    top, bottom, left, right = 30, 85, 55, 108
    assert rgb[top, left].tolist() == [255, 0, 0]
    assert rgb[top, right].tolist() == [0, 255, 0]
    assert rgb[bottom, left].tolist() == [0, 0, 255]
    assert rgb[bottom, right].tolist() == [255, 255, 0]


def test_an_image_of_odd_size_is_not_sheared() -> None:
    camera = PinholeCamera(101, 75, 80.0, 80.0, 50.0, 37.0)
    with Renderer(House("w", (wall(2.0, Material("w", (1.0, 0.0, 0.5)), half=0.51),)), camera, "flat") as renderer:
        rgb, depth = renderer.render(mast_camera_pose(0, 0, 0, 0))
    assert ((rgb == (255, 0, 128)).all(axis=2) == (depth > 0)).all()
    inside = np.argwhere(depth > 0)
    assert inside.min(axis=0).tolist() == [17, 30]
    assert inside.max(axis=0).tolist() == [57, 70]


@pytest.mark.parametrize("size", [1, 2, 3, 5, 30])
def test_textures_of_any_size_keep_their_colours(size: int) -> None:
    image = np.full((size, size, 3), (10, 120, 230), np.uint8)
    with Renderer(House("w", (wall(2.0, Material("w", texture=image)),)), CAMERA, "flat") as renderer:
        rgb, _ = renderer.render(mast_camera_pose(0, 0, 0, 0))
    assert (rgb == (10, 120, 230)).all()


def test_textures_repeat_and_far_ones_blur_instead_of_flickering() -> None:
    checker = np.kron([[0, 1], [1, 0]], np.full((8, 8), 255)).astype(np.uint8)[..., None].repeat(3, axis=2)
    part = wall(3.0, Material("checker", texture=checker))
    assert part.uv is not None
    coarse, fine = (House("w", (replace(part, uv=part.uv * repeats),)) for repeats in (4, 2000))
    with Renderer(coarse, CAMERA, "flat") as near, Renderer(fine, CAMERA, "flat") as far:
        assert near.render(mast_camera_pose(0, 0, 0, 0))[0].std() > 100
        blurred = far.render(mast_camera_pose(0, 0, 0, 0))[0]
    assert blurred.std() < 2
    assert abs(blurred.mean() - 127.5) < 3


def test_light_multiplies_the_material() -> None:
    part = replace(wall(2.0, Material("w", (0.5, 1.0, 0.8))), light=np.full((4, 3), (0.5, 0.6, 1.1), np.float32))
    with Renderer(House("w", (part,)), CAMERA) as baked, Renderer(House("w", (part,)), CAMERA, "flat") as flat:
        lit, bare = (renderer.render(mast_camera_pose(0, 0, 0, 0))[0][60, 80] for renderer in (baked, flat))
    np.testing.assert_allclose(lit, 255 * np.array([0.25, 0.6, 0.88]), atol=1)
    np.testing.assert_allclose(bare, 255 * np.array([0.5, 1.0, 0.8]), atol=1)


def test_vertex_colours_multiply_texture_material_and_light() -> None:
    texture = np.full((4, 4, 3), (255, 255, 102), np.uint8)
    part = replace(
        wall(2.0, Material("w", (0.5, 1.0, 1.0), texture)),
        colour=np.full((4, 3), (1.0, 0.25, 0.5), np.float32),
        light=np.full((4, 3), (0.6, 1.0, 1.0), np.float32),
    )
    with Renderer(House("w", (part,)), CAMERA) as baked, Renderer(House("w", (part,)), CAMERA, "flat") as flat:
        lit, bare = (renderer.render(mast_camera_pose(0, 0, 0, 0))[0][60, 80] for renderer in (baked, flat))
    np.testing.assert_allclose(lit, 255 * np.array([0.3, 0.25, 0.2]), atol=1)
    np.testing.assert_allclose(bare, 255 * np.array([0.5, 0.25, 0.2]), atol=1)


def test_vertex_colours_are_blended_across_a_face() -> None:
    colour = np.array([[1, 0, 0], [0, 0, 1], [0, 0, 1], [1, 0, 0]], np.float32)  # left red, right blue
    house = House("w", (replace(wall(2.0, Material("w"), half=1.0), colour=colour),))
    with Renderer(house, CAMERA, "flat") as renderer:
        rgb, _ = renderer.render(mast_camera_pose(0, 0, 0, 0))
    left_to_right = (np.arange(40, 120) - 81.3 + 55) / 110  # the wall is 110 px wide, its middle at 81.3
    np.testing.assert_allclose(rgb[60, 40:120, 2], 255 * left_to_right, atol=1.5)
    np.testing.assert_allclose(rgb[60, 40:120, 0], 255 * (1 - left_to_right), atol=1.5)


@pytest.mark.parametrize("lighting", ["baked", "flat"])
@pytest.mark.parametrize("brightness", [0.25, 1.0, 2.0])
def test_brightness_multiplies_grey_values_and_clips_at_white(lighting: str, brightness: float) -> None:
    part = replace(wall(2.0, Material("w", (0.2, 0.4, 0.8))), light=np.ones((4, 3), np.float32))
    with Renderer(House("w", (part,)), CAMERA, lighting, brightness=brightness) as renderer:
        seen, depth = renderer.render(mast_camera_pose(0, 0, 0, 0))
    expected = np.minimum(255 * brightness * np.array([0.2, 0.4, 0.8]), 255)
    np.testing.assert_allclose(seen[60, 80], expected, atol=1)
    assert (depth > 0).all()


def test_light_above_white_is_still_there_when_it_is_dimmed() -> None:
    part = replace(wall(2.0, Material("lamp")), light=np.full((4, 3), 1.5, np.float32))
    with Renderer(House("w", (part,)), CAMERA, brightness=0.5) as renderer:
        np.testing.assert_allclose(renderer.render(mast_camera_pose(0, 0, 0, 0))[0][60, 80], 0.75 * 255, atol=1)


@pytest.mark.parametrize(
    ("name", "value"),
    [("brightness", 0.0), ("brightness", -1.0), ("brightness", 4.1), ("brightness", np.nan), ("multisampling", 3)],
)
def test_other_brightness_and_multisampling_are_refused_in_one_line(name: str, value: float) -> None:
    with pytest.raises(ConfigError, match=rf"^{name}: expected .*got {value}$"):
        Renderer(cluttered_room(), CAMERA, "flat", **{name: value})  # type: ignore[arg-type]


def test_multisampling_shares_a_pixel_that_an_edge_cuts() -> None:
    half = (81.3 - 30.0) * 2 / 110  # the wall's left edge passes through the middle of column 30
    house = House("w", (wall(2.0, Material("w", (1.0, 1.0, 1.0)), half=half),))
    with Renderer(house, CAMERA, "flat") as hard, Renderer(house, CAMERA, "flat", multisampling=4) as soft:
        hard_row, soft_row = (renderer.render(mast_camera_pose(0, 0, 0, 0))[0][60, :, 0] for renderer in (hard, soft))
    assert hard_row[30] in (0, 255)
    assert soft_row[30] in (127, 128)  # two of four samples
    assert soft_row[[28, 29, 31, 32]].tolist() == hard_row[[28, 29, 31, 32]].tolist() == [0, 0, 255, 255]


def test_multisampling_changes_edges_alone_and_leaves_depth(room: Renderer) -> None:
    shares = []
    with Renderer(cluttered_room(), CAMERA, "flat", multisampling=4) as soft:
        for pose in poses(6):
            (rgb, depth), (soft_rgb, soft_depth) = room.render(pose), soft.render(pose)
            assert (depth == soft_depth).all()
            changed = np.abs(rgb.astype(int) - soft_rgb).max(axis=2) > 2
            shares.append(np.mean(changed))
            assert (soft.render(pose)[0] == soft_rgb).all()
            around = np.ones((3, 3))
            spread = cv2.dilate(rgb, around).astype(int) - cv2.erode(rgb, around)
            assert not changed[spread.max(axis=2) == 0].any()  # beside no edge
    assert 0.002 < np.mean(shares) < 0.1


def test_the_same_pose_gives_the_same_bits_in_renderers_side_by_side(room: Renderer) -> None:
    views = poses(4)
    first = [room.render(pose) for pose in views]
    with (
        Renderer(cluttered_room(), CAMERA, "flat") as other,
        Renderer(cluttered_room(), CAMERAS["small"], "flat") as small,
    ):
        for (rgb, depth), pose in zip(first, views, strict=True):
            small.render(pose)
            for again_rgb, again_depth in (other.render(pose), room.render(pose)):
                assert (rgb == again_rgb).all()
                assert (depth == again_depth).all()
    assert (room.render(views[0])[0] == first[0][0]).all()  # still works after the others are closed


def test_a_renderer_that_was_dropped_unclosed_does_no_harm(room: Renderer) -> None:
    dropped = Renderer(cluttered_room(), CAMERA, "flat")
    dropped.render(poses(1)[0])
    del dropped
    gc.collect()
    assert room.render(poses(1)[0])[1].any()


def test_images_do_not_share_memory(room: Renderer) -> None:
    first, second = (room.render(pose) for pose in poses(2))
    before = first[0].copy(), first[1].copy()
    room.render(poses(3)[2])
    assert (first[0] == before[0]).all()
    assert (first[1] == before[1]).all()
    assert not np.shares_memory(first[0], second[0])


def test_close_twice_and_render_after_close() -> None:
    renderer = Renderer(cluttered_room(), CAMERA, "flat")
    renderer.close()
    renderer.close()
    with pytest.raises(RenderError, match="closed"):
        renderer.render(np.eye(4))


def test_unbaked_light_and_unknown_lighting_are_refused() -> None:
    with pytest.raises(RenderError, match="bake_light"):
        Renderer(cluttered_room(), CAMERA)
    with pytest.raises(ConfigError, match="did you mean 'baked'"):
        Renderer(cluttered_room(), CAMERA, "bake")


def test_window_depth_becomes_metres() -> None:
    P = projection_matrix(CAMERA)
    metres = np.array([[0.05, 0.5, 3.0, 39.0]])
    clip = np.stack([np.zeros(4), np.zeros(4), metres[0], np.ones(4)]).T @ P.T
    window = (0.5 * clip[:, 2] / clip[:, 3] + 0.5).astype(np.float32)[None]
    np.testing.assert_allclose(linear_depth(window), metres, rtol=2e-4)
    assert linear_depth(np.ones((1, 1), np.float32)) == 0.0


@pytest.mark.parametrize(
    ("variable", "value", "word"),
    [
        ("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent", "libegl-mesa0"),
        ("EGL_DEVICE_ID", "99", "libegl-mesa0"),
        ("PYOPENGL_PLATFORM", "osmesa", "PYOPENGL_PLATFORM"),
    ],
)
def test_without_egl_the_error_is_one_line_that_says_what_to_do(variable: str, value: str, word: str) -> None:
    code = (
        "from slamgym.camera import CAMERAS\n"
        "from slamgym.errors import RenderError\n"
        "from slamgym.render import Renderer\n"
        "from slamgym.scenes.house import House\n"
        "try: Renderer(House('h', ()), CAMERAS['small'], 'flat')\n"
        "except RenderError as error: print(error)\n"
    )
    environment = {**os.environ, variable: value}
    run = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=60)
    assert run.returncode == 0, run.stderr
    assert len(run.stdout.splitlines()) == 1
    assert word in run.stdout


def test_importing_the_module_opens_no_graphics() -> None:
    code = "import sys, os, slamgym.render; print('OpenGL' in sys.modules, 'PYOPENGL_PLATFORM' in os.environ)"
    environment = {key: value for key, value in os.environ.items() if key != "PYOPENGL_PLATFORM"}
    run = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=60)
    assert run.stdout.split() == ["False", "False"], run.stderr


def test_a_camera_larger_than_opengl_allows_is_refused() -> None:
    with pytest.raises(RenderError, match=r"at most .* pixels, got 100000x10"):
        Renderer(cluttered_room(), PinholeCamera(100_000, 10, 100.0, 100.0, 50.0, 5.0), "flat")
