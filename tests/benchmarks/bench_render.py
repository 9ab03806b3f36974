"""What a rendered frame costs: ours against plain pyrender, and against one batched draw as the least that it can be.

All render colour and depth of the same house at the same poses, turn by turn in one run, and must agree on what they
see. Plain pyrender draws the house's parts one by one, always with four samples a pixel. The batched draw, by moderngl,
has all triangles in one buffer and all textures, scaled to one size, in one array; it draws them all, seen or not. Run
by `make bench`.
"""

import os
import time
from collections.abc import Callable
from statistics import median
from typing import Any

import cv2
import moderngl
import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from slamgym.agents.planner import plan_path
from slamgym.camera import CAMERAS, PinholeCamera
from slamgym.geometry import inverse, mast_camera_pose
from slamgym.params import DriveParams
from slamgym.render import WHITE, Z_FAR_M, Z_NEAR_M, Renderer, linear_depth, projection_matrix
from slamgym.scenes.house import House, Part
from slamgym.stage import load_stage
from slamgym.types import FloatArray

SCENE, OPTIONS = "procedural:6", {"size": "large", "clutter": 2}
"""The house of the first ten seeds with most triangles."""

POSES, PATH_M = 60, 25.0
LAYER_PX = 512
Image = tuple[NDArray[np.uint8], NDArray[np.float32]]

VERTEX_SHADER = """
#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 place;
layout(location = 2) in vec3 colour;
uniform mat4 clip_from_world;
out vec3 texture_place;
out vec3 factor;
void main() {
    gl_Position = clip_from_world * vec4(position, 1.0);
    texture_place = place;
    factor = colour;
}
"""
FRAGMENT_SHADER = """
#version 330 core
in vec3 texture_place;
in vec3 factor;
uniform sampler2DArray textures;
out vec4 colour;
void main() { colour = vec4(texture(textures, texture_place).rgb * factor, 1.0); }
"""


class BatchedDraw:
    """All triangles of a house in one draw, without any of slamgym's or pyrender's drawing."""

    def __init__(self, house: House, camera: PinholeCamera, samples: int) -> None:
        self.context = context = moderngl.create_context(standalone=True, backend="egl")  # type: ignore[arg-type]
        size = camera.width, camera.height
        self.canvas = context.framebuffer(
            context.renderbuffer(size, 4, samples=samples), context.depth_renderbuffer(size, samples=samples)
        )
        self.output = context.framebuffer(context.renderbuffer(size, 4), context.depth_renderbuffer(size))
        self.program = context.program(VERTEX_SHADER, FRAGMENT_SHADER)
        images = {id(texture_of(part)): texture_of(part) for part in house.parts}
        layers = [cv2.resize(image, (LAYER_PX, LAYER_PX))[::-1] for image in images.values()]
        self.textures = context.texture_array((LAYER_PX, LAYER_PX, len(layers)), 3, np.stack(layers).tobytes())
        self.textures.build_mipmaps()
        layer_of = {key: layer for layer, key in enumerate(images)}
        vertices = np.concatenate([vertex_rows(part, layer_of[id(texture_of(part))]) for part in house.parts])
        starts = np.cumsum([0] + [len(part.vertices) for part in house.parts])
        faces = np.concatenate([part.faces + start for part, start in zip(house.parts, starts, strict=False)])
        self.mesh = context.vertex_array(
            self.program,
            [(context.buffer(vertices.tobytes()), "3f 3f 3f", "position", "place", "colour")],
            context.buffer(faces.astype(np.int32).tobytes()),
        )
        self.shape, self.projection = (camera.height, camera.width), projection_matrix(camera)

    def render(self, T_world_cam: FloatArray) -> Image:
        with self.context as context:
            self.canvas.use()
            self.canvas.clear(depth=1.0)
            context.enable_only(moderngl.DEPTH_TEST)
            clip_from_world = (self.projection @ inverse(T_world_cam)).T.astype(np.float32)
            self.program["clip_from_world"].write(clip_from_world.tobytes())  # type: ignore[union-attr]
            self.textures.use()
            self.mesh.render()
            output = self.canvas
            if self.canvas.samples:
                context.copy_framebuffer(self.output, self.canvas)
                output = self.output
            rgb = np.frombuffer(output.read(components=3, alignment=1), np.uint8)
            depth = np.frombuffer(output.read(attachment=-1, components=1, dtype="f4"), np.float32)
        return rgb.reshape(*self.shape, 3), linear_depth(depth.reshape(self.shape))


class PlainPyrender:
    """A mesh a part, as one would do it with pyrender first."""

    def __init__(self, house: House, camera: PinholeCamera) -> None:
        os.environ.setdefault("PYOPENGL_PLATFORM", "egl")
        import pyrender

        self.scene = pyrender.Scene(bg_color=[0.0, 0.0, 0.0])
        textures: dict[int, Any] = {}
        for part in house.parts:
            image = texture_of(part)
            # pyrender shears textures with rows that are no multiple of four bytes.
            padded = cv2.resize(image, (-(-image.shape[1] // 4) * 4, image.shape[0]))
            texture = textures.setdefault(id(image), pyrender.Texture(source=padded, source_channels="RGB"))
            self.scene.add(pyrender.Mesh([self._primitive(part, texture)]))
        # pyrender counts from the image's corner, not from the centre of its first pixel.
        centre = camera.cx + 0.5, camera.cy + 0.5
        lens = pyrender.IntrinsicsCamera(camera.fx, camera.fy, *centre, znear=Z_NEAR_M, zfar=Z_FAR_M)
        self.camera = self.scene.add(lens)
        self.renderer = pyrender.OffscreenRenderer(camera.width, camera.height)
        self.flags = pyrender.RenderFlags.FLAT

    @staticmethod
    def _primitive(part: Part, texture: Any) -> Any:
        import pyrender

        material = pyrender.MetallicRoughnessMaterial(baseColorTexture=texture, doubleSided=True)
        rows = vertex_rows(part, 0)
        return pyrender.Primitive(
            rows[:, :3], texcoord_0=rows[:, 3:5], color_0=rows[:, 6:], indices=part.faces, material=material
        )

    def render(self, T_world_cam: FloatArray) -> Image:
        self.scene.set_pose(self.camera, T_world_cam @ np.diag([1.0, -1.0, -1.0, 1.0]))
        image: Image = self.renderer.render(self.scene, self.flags)
        return image


def texture_of(part: Part) -> NDArray[np.uint8]:
    return WHITE if part.material.texture is None else part.material.texture


def vertex_rows(part: Part, layer: int) -> NDArray[np.float32]:
    """Columns (V, 9): position, place in the texture and its layer, factors of its colour."""
    uv = np.zeros((len(part.vertices), 2)) if part.uv is None else part.uv
    colour = np.ones(3) if part.colour is None else part.colour
    factor = np.multiply(part.material.colour, colour) * part.light
    return np.column_stack([part.vertices, uv, np.full(len(uv), layer), factor]).astype(np.float32)


def timed(action: Callable[[FloatArray], Image], pose: FloatArray) -> tuple[Image, float]:
    """The image and the milliseconds that it took."""
    begin = time.perf_counter()
    image = action(pose)
    return image, (time.perf_counter() - begin) * 1e3


def check_alike(images: dict[str, Image]) -> None:
    """Raise unless the images show the same; multisampled ones may differ at edges, and in depth."""
    rgb, depth = images["ours"]
    for name, (other_rgb, other_depth) in images.items():
        differ = np.mean(np.abs(rgb.astype(int) - other_rgb).max(axis=2) > 24)
        far = np.mean(np.abs(depth - other_depth) > 0.02 * depth)
        limit = 0.05 if "4x" in name else 0.01
        assert max(differ, far) < limit, f"{name} shows something else: {differ:.4f} colour, {far:.4f} depth"


def house_and_views() -> tuple[House, list[FloatArray]]:
    """The house, and poses of the camera along a path through it."""
    stage = load_stage(DriveParams(scene=SCENE, scene_options=OPTIONS))
    path = plan_path(stage.grid, stage.free, PATH_M, np.random.default_rng(0))
    views = []
    for s in np.linspace(0.0, path.length_m, POSES):
        x, y = path.point_at(s)
        views.append(mast_camera_pose(x, y, path.heading_at(s), 0.83))
    return stage.house, views


def main() -> None:
    house, views = house_and_views()
    camera = CAMERAS["default"]
    renderers: dict[str, Any] = {
        "one batched draw": BatchedDraw(house, camera, 0),
        "ours": Renderer(house, camera),
        "one batched draw, 4x": BatchedDraw(house, camera, 4),
        "ours, 4x": Renderer(house, camera, multisampling=4),
        "plain pyrender, 4x": PlainPyrender(house, camera),
    }
    times_ms: dict[str, list[float]] = {name: [] for name in renderers}
    for index, pose in enumerate([views[0], *views]):
        images = {}
        for name, renderer in renderers.items():
            images[name], ms = timed(renderer.render, pose)
            times_ms[name] += [ms] if index else []  # the first frame of each loads things
        check_alike(images)
    report(house, {name: median(values) for name, values in times_ms.items()})


def report(house: House, ms: dict[str, float]) -> None:
    triangles = sum(len(part.faces) for part in house.parts)
    title = f"{SCENE}: {len(house.parts)} parts, {triangles:,} triangles, 640x480 colour and depth"
    table = Table("what", "ms a frame", "of one batched draw", title=title)
    for name, value in ms.items():
        floor = ms["one batched draw, 4x" if "4x" in name else "one batched draw"]
        aim = "  (aim: at most 1.50)" if name.startswith("ours") else ""
        table.add_row(name.replace("4x", "4 samples a pixel"), f"{value:.1f}", f"{value / floor:.2f}{aim}")
    Console().print(table)


if __name__ == "__main__":
    main()
