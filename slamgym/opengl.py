"""The OpenGL objects behind `slamgym.render`: a context on EGL, a canvas to draw on, and what is drawn.

The only user of pyrender and PyOpenGL, which are imported when the first context is made: both read the environment and
open libraries as they are imported.
"""

import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from textwrap import shorten
from typing import Any

import numpy as np
from numpy.typing import NDArray

from slamgym.errors import RenderError
from slamgym.types import FloatArray

NO_EGL = (
    "cannot render: expected a working EGL with OpenGL 4.1, got: {error}; on Debian or Ubuntu: "
    "apt-get install libegl1 libgl1 libopengl0 libgl1-mesa-dri libegl-mesa0"
)
FORKED = (
    "cannot render in a process that was forked from one that already has: Mesa's threads are gone here, and drawing "
    "would hang; start it by 'spawn', for example gym.make_vec(..., vector_kwargs={'context': 'spawn'})"
)

_opened_by: int | None = None
"""Id of the process that first used EGL: this one, or one that it was forked from."""

# Positions of the vertex attributes in pyrender's buffers, and what its flat shader has to multiply.
FLAT_SHADER = {
    "USE_METALLIC_MATERIAL": 1,
    "HAS_BASE_COLOR_TEX": 1,
    "TEXCOORD_0_LOC": 1,
    "COLOR_0_LOC": 2,
    "INST_M_LOC": 3,
}


@dataclass(frozen=True, slots=True, eq=False)
class Batch:
    """Triangles that share a texture: uint8 (H, W, 3). colour: float32 (V, 3) factors of the texture."""

    texture: NDArray[np.uint8]
    vertices: NDArray[np.float32]
    faces: NDArray[np.int32]
    uv: NDArray[np.float32]
    colour: NDArray[np.float32]


class Context:
    """An OpenGL context on pyrender's EGL platform, current only while it is used, so that others can have theirs.

    Raises RenderError when EGL does not work, or cannot work after a fork.
    """

    def __init__(self) -> None:
        global _opened_by
        if _opened_by not in (None, os.getpid()):
            raise RenderError(FORKED)
        _opened_by = os.getpid()
        chosen = os.environ.setdefault("PYOPENGL_PLATFORM", "egl")
        if chosen != "egl":
            raise RenderError(f"expected PYOPENGL_PLATFORM to be 'egl' or unset, got {chosen!r}; unset it")
        try:
            from pyrender.platforms import egl

            device = egl.get_device_by_index(int(os.environ.get("EGL_DEVICE_ID", "0")))
            platform = egl.EGLPlatform(0, 0, device=device)
            platform.init_context()
        except Exception as error:  # PyOpenGL fails in many ways, from AttributeError to AssertionError
            reason = shorten(f"{type(error).__name__} {error}", 100)
            raise RenderError(NO_EGL.format(error=reason)) from error
        self._display, self._context = platform._egl_display, platform._egl_context
        platform._egl_display = None  # else it would shut down the display of all contexts when it is deleted
        self._bind(None)

    @contextmanager
    def current(self) -> Iterator[None]:
        self._bind(self._context)
        try:
            yield
        finally:
            self._bind(None)

    def destroy(self) -> None:
        from OpenGL import EGL

        EGL.eglDestroyContext(self._display, self._context)

    def _bind(self, context: Any) -> None:
        from OpenGL import EGL

        context = EGL.EGL_NO_CONTEXT if context is None else context
        EGL.eglMakeCurrent(self._display, EGL.EGL_NO_SURFACE, EGL.EGL_NO_SURFACE, context)


class Canvas:
    """A framebuffer of colour and depth with `samples` a pixel, 0 for one at its centre; row 0 is an image's first.

    Raises RenderError for an image that is larger than OpenGL allows.
    """

    def __init__(self, width: int, height: int, samples: int = 0) -> None:
        from OpenGL import GL

        most = int(GL.glGetIntegerv(GL.GL_MAX_RENDERBUFFER_SIZE))
        if max(width, height) > most:
            raise RenderError(f"camera: expected an image of at most {most}x{most} pixels, got {width}x{height}")
        self.width, self.height = width, height
        self._framebuffer = GL.glGenFramebuffers(1)
        self._buffers = GL.glGenRenderbuffers(2)
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._framebuffer)
        formats = (GL.GL_RGBA8, GL.GL_DEPTH_COMPONENT24)
        attachments = (GL.GL_COLOR_ATTACHMENT0, GL.GL_DEPTH_ATTACHMENT)
        for buffer, pixel_format, attachment in zip(self._buffers, formats, attachments, strict=True):
            GL.glBindRenderbuffer(GL.GL_RENDERBUFFER, buffer)
            GL.glRenderbufferStorageMultisample(GL.GL_RENDERBUFFER, samples, pixel_format, width, height)
            GL.glFramebufferRenderbuffer(GL.GL_FRAMEBUFFER, attachment, GL.GL_RENDERBUFFER, buffer)
        GL.glViewport(0, 0, width, height)
        GL.glEnable(GL.GL_DEPTH_TEST)
        GL.glClearColor(0.0, 0.0, 0.0, 1.0)
        GL.glPixelStorei(GL.GL_PACK_ALIGNMENT, 1)  # rows of RGB are not padded to 4 bytes, here and in textures
        GL.glPixelStorei(GL.GL_UNPACK_ALIGNMENT, 1)

    def clear(self) -> None:
        """Draw here from now on, on black."""
        from OpenGL import GL

        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._framebuffer)
        GL.glClear(GL.GL_COLOR_BUFFER_BIT | GL.GL_DEPTH_BUFFER_BIT)

    def resolve(self, multisampled: "Canvas") -> None:
        """Take over the colours of a canvas of the same size, each pixel the mean of its samples' grey values."""
        from OpenGL import GL

        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, multisampled._framebuffer)
        GL.glBindFramebuffer(GL.GL_DRAW_FRAMEBUFFER, self._framebuffer)
        whole = (0, 0, self.width, self.height)
        GL.glBlitFramebuffer(*whole, *whole, GL.GL_COLOR_BUFFER_BIT, GL.GL_NEAREST)

    def read(self) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        """Colour (H, W, 3) and window depth (H, W) in [0, 1], 1 where nothing was drawn; of one sample a pixel."""
        from OpenGL import GL

        rgb = np.empty((self.height, self.width, 3), np.uint8)
        depth = np.empty((self.height, self.width), np.float32)
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._framebuffer)
        GL.glReadPixels(0, 0, self.width, self.height, GL.GL_RGB, GL.GL_UNSIGNED_BYTE, rgb)
        GL.glReadPixels(0, 0, self.width, self.height, GL.GL_DEPTH_COMPONENT, GL.GL_FLOAT, depth)
        return rgb, depth

    def delete(self) -> None:
        from OpenGL import GL

        GL.glDeleteFramebuffers(1, [self._framebuffer])
        GL.glDeleteRenderbuffers(2, self._buffers)


class Drawing:
    """Batches in the memory of the current context, drawn with pyrender's flat shader in the order asked for."""

    def __init__(self, batches: Sequence[Batch]) -> None:
        import pyrender
        from pyrender.shader_program import ShaderProgramCache

        self._programs = ShaderProgramCache()
        self._program = self._programs.get_program("flat.vert", "flat.frag", defines=FLAT_SHADER)
        self._program._add_to_context()
        images = {id(batch.texture): batch.texture for batch in batches}
        self._textures = {key: pyrender.Texture(source=image, source_channels="RGB") for key, image in images.items()}
        self._primitives = [
            pyrender.Primitive(batch.vertices, texcoord_0=batch.uv, color_0=batch.colour, indices=batch.faces)
            for batch in batches
        ]
        for thing in (*self._textures.values(), *self._primitives):
            thing._add_to_context()
        self._batches: list[tuple[Any, Any]] = [
            (primitive, self._textures[id(batch.texture)])
            for primitive, batch in zip(self._primitives, batches, strict=True)
        ]

    def draw(self, which: Iterable[int], view: FloatArray, projection: FloatArray, brightness: float) -> None:
        """Draw the batches of these indices; view and projection: (4, 4); brightness: factor of all colours."""
        from OpenGL import GL

        self._program._bind()
        for name, value in {"M": np.eye(4), "V": view, "P": projection}.items():
            self._program.set_uniform(name, value)
        self._program.set_uniform("material.base_color_factor", np.full(4, brightness))
        for index in which:
            primitive, texture = self._batches[index]
            texture._bind()
            primitive._bind()
            GL.glDrawElementsInstanced(GL.GL_TRIANGLES, primitive.indices.size, GL.GL_UNSIGNED_INT, None, 1)

    def delete(self) -> None:
        for thing in (*self._primitives, *self._textures.values()):
            thing.delete()
        self._programs.clear()
