"""Colour and depth images of a house, rendered with pyrender's OpenGL objects on EGL (a GPU, or Mesa on the CPU).

Light is baked into the vertices (`slamgym.scenes.light`), so a frame is one pass of pyrender's flat shader over a few
merged batches. Textures are mipmapped. Geometry is drawn two-sided, since meshes found in the wild are wound either
way. Batches outside the view are left out; any pose may be rendered, so nothing is left out for good.

Multisampling is a choice. Off, the default, colour and depth are those of the ray through the pixel's centre. With 4
samples a pixel the edges of surfaces are smooth as in a camera's image, so that corners found on them stay where they
are from frame to frame: of ORB's keypoints some 3 to 4 in 100 more are found again. It costs a second pass and about
three times the time of a frame on a CPU; depth keeps its single sample, since a mean over an edge is no surface.
"""

from collections.abc import Iterator
from types import TracebackType
from typing import Literal, Self, get_args

import numpy as np
from numpy.typing import NDArray

from slamgym.camera import PinholeCamera
from slamgym.errors import ConfigError, RenderError, unknown_word
from slamgym.geometry import inverse
from slamgym.opengl import Batch, Canvas, Context, Drawing
from slamgym.scenes.house import House, Part
from slamgym.types import FloatArray

Lighting = Literal["baked", "flat"]
Multisampling = Literal[0, 4]

MAX_BRIGHTNESS = 4.0

Z_NEAR_M = 0.05
Z_FAR_M = 40.0
CELL_M = 4.0
"""Batches are cut along a grid of this size, so that those outside the view can be left out."""

WHITE = np.full((1, 1, 3), 255, np.uint8)


class Renderer:
    """Renders one house through one camera. Opens an OpenGL context of its own; `close` frees it.

    lighting: "baked" multiplies materials with `Part.light`; "flat" shows the materials alone.
    brightness: factor of all grey values, above 0 to 4, of what shines by itself too; values past white are clipped.
    Grey values of sRGB are about the 2.2th root of light, so a factor b is what b^2.2 times the exposure would do.
    multisampling: samples a pixel for the colour, 0 (one, at the centre) or 4.
    Raises ConfigError for another lighting, brightness or multisampling and for a camera with distortion, RenderError
    when the light is not baked or EGL does not work.
    """

    def __init__(
        self,
        house: House,
        camera: PinholeCamera,
        lighting: str = "baked",
        brightness: float = 1.0,
        multisampling: int = 0,
    ) -> None:
        _check(camera, brightness, multisampling)
        batches = make_batches(house, lighting)
        self._brightness = brightness
        self._projection = projection_matrix(camera)
        self._corners = box_corners(batches)
        self._context: Context | None = Context()
        try:
            with self._context.current():
                samples = [0, multisampling] if multisampling else [0]
                self._canvases = [Canvas(camera.width, camera.height, count) for count in samples]
                self._drawing = Drawing(batches)
        except BaseException:
            self._context.destroy()
            raise

    def render(self, T_world_cam: FloatArray) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        """Colour (H, W, 3) and depth (H, W), metres along the optical axis, 0 where nothing is within 0.05 to 40 m.

        The same pose gives the same bits, in this renderer or another one of the same house.
        """
        if self._context is None:
            raise RenderError("expected an open renderer, got one that is closed; make a new Renderer")
        view = inverse(np.asarray(T_world_cam, dtype=np.float64))
        visible = visible_boxes(self._corners, self._projection @ view)
        with self._context.current():
            for canvas in self._canvases:
                canvas.clear()
                self._drawing.draw(visible, view, self._projection, self._brightness)
            for smooth in self._canvases[1:]:
                self._canvases[0].resolve(smooth)
            rgb, window_depth = self._canvases[0].read()
        return rgb, linear_depth(window_depth)

    def close(self) -> None:
        """Free what the renderer holds; calling it again does nothing."""
        if self._context is None:
            return
        with self._context.current():
            self._drawing.delete()
            for canvas in self._canvases:
                canvas.delete()
        self._context.destroy()
        self._context = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _check(camera: PinholeCamera, brightness: float, multisampling: int) -> None:
    if camera.distortion:
        raise ConfigError(f"camera: expected one without distortion to render, got {camera.distortion}")
    if not 0.0 < brightness <= MAX_BRIGHTNESS:
        raise ConfigError(f"brightness: expected a factor above 0, at most {MAX_BRIGHTNESS:g}, got {brightness}")
    if multisampling not in get_args(Multisampling):
        raise ConfigError(f"multisampling: expected {get_args(Multisampling)} samples a pixel, got {multisampling}")


def projection_matrix(camera: PinholeCamera) -> FloatArray:
    """OpenGL projection (4, 4) straight from the optical frame, so that row 0 of the buffer is the image's top row.

    OpenGL's window has its origin at a pixel's corner, the camera's at a pixel's centre: hence the halves.
    """
    n, f = Z_NEAR_M, Z_FAR_M
    x0 = 2.0 * (camera.cx + 0.5) / camera.width - 1.0
    y0 = 2.0 * (camera.cy + 0.5) / camera.height - 1.0
    return np.array(
        [
            [2.0 * camera.fx / camera.width, 0.0, x0, 0.0],
            [0.0, 2.0 * camera.fy / camera.height, y0, 0.0],
            [0.0, 0.0, (f + n) / (f - n), -2.0 * f * n / (f - n)],
            [0.0, 0.0, 1.0, 0.0],
        ]
    )


def linear_depth(window_depth: NDArray[np.float32]) -> NDArray[np.float32]:
    """Metres along the optical axis from OpenGL's window depth in [0, 1]; 0 where nothing was drawn (exactly 1)."""
    n, f = np.float32(Z_NEAR_M), np.float32(Z_FAR_M)
    depth: NDArray[np.float32] = (n * f) / (f - window_depth * (f - n))
    depth[window_depth == 1.0] = 0.0
    return depth


def make_batches(house: House, lighting: str) -> list[Batch]:
    """The house's triangles merged by texture and cut into cells; few batches, since each costs time in Python."""
    if lighting not in get_args(Lighting):
        raise ConfigError(unknown_word("lighting", lighting, get_args(Lighting)))
    by_texture: dict[int, list[Part]] = {}
    for part in house.parts:
        by_texture.setdefault(id(part.material.texture), []).append(part)
    return [batch for parts in by_texture.values() for batch in _split_cells(_merge(parts, lighting))]


def _merge(parts: list[Part], lighting: str) -> Batch:
    starts = np.cumsum([0] + [len(part.vertices) for part in parts])
    texture = parts[0].material.texture
    return Batch(
        WHITE if texture is None else texture,
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.faces + np.int32(start) for part, start in zip(parts, starts, strict=False)]),
        np.concatenate([np.zeros((len(p.vertices), 2), np.float32) if p.uv is None else p.uv for p in parts]),
        np.concatenate([_colour(part, lighting) for part in parts]),
    )


def _colour(part: Part, lighting: str) -> NDArray[np.float32]:
    """Factors (V, 3) of the texture: the material's colour, the vertices' own and, when baked, the light."""
    material = np.broadcast_to(np.asarray(part.material.colour, dtype=np.float32), part.vertices.shape)
    colour = material if part.colour is None else material * part.colour
    if lighting == "flat":
        return colour
    if part.light is None:
        raise RenderError(f"expected baked light, got none in part {part.name!r}; call bake_light, or lighting='flat'")
    return colour * part.light


def _split_cells(batch: Batch) -> Iterator[Batch]:
    centres = batch.vertices[batch.faces].mean(axis=1)
    _, cell = np.unique(np.floor(centres[:, :2] / CELL_M), axis=0, return_inverse=True)
    for index in range(cell.max(initial=-1) + 1):
        used, corner = np.unique(batch.faces[cell == index], return_inverse=True)
        faces = corner.reshape(-1, 3).astype(np.int32)
        yield Batch(batch.texture, batch.vertices[used], faces, batch.uv[used], batch.colour[used])


def box_corners(batches: list[Batch]) -> FloatArray:
    """Homogeneous corners (B, 8, 4) of the batches' bounding boxes."""
    bounds = np.array([(batch.vertices.min(axis=0), batch.vertices.max(axis=0)) for batch in batches])
    which = np.indices((2, 2, 2)).reshape(3, 8).T
    corners = bounds.reshape(-1, 2, 3)[:, which, np.arange(3)]
    return np.concatenate([corners, np.ones((*corners.shape[:2], 1))], axis=2)


def visible_boxes(corners: FloatArray, clip_from_world: FloatArray) -> NDArray[np.intp]:
    """Indices of the boxes that reach into the view, nearest first: no box lies wholly beyond one clipping plane."""
    clip = corners @ clip_from_world.T
    w = clip[..., 3:]
    beyond = np.concatenate([clip[..., :3] > w, clip[..., :3] < -w], axis=2)
    outside = np.any(np.all(beyond, axis=1), axis=1)
    nearest_first: NDArray[np.intp] = np.argsort(w[..., 0].min(axis=1), kind="stable")
    visible: NDArray[np.intp] = nearest_first[~outside[nearest_first]]
    return visible
