"""Pixels onto the screen: one texture a viewport, drawn through the scene's display transform."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..scene_data import FloatArray
from .view_camera import Rect
from .worker import Picture

# Blender's own shader for images interpolates, which would hide how coarse a picture is.
VERTEX = """
void main()
{
  texel = texCoord;
  gl_Position = ModelViewProjectionMatrix * vec4(pos, 0.0, 1.0);
}
"""
FRAGMENT = """
void main()
{
  color = texelFetch(image, ivec2(texel), 0);
}
"""

TextureRect = tuple[float, float, float, float]  # lower left and upper right corner, in texels


class Drawing:
    """The texture of the picture that was drawn last."""

    def __init__(self) -> None:
        self.picture: Picture | None = None
        self._texture: Any = None
        self._shader: Any = None
        self._batch: Any = None
        self._place: tuple[Rect, TextureRect] | None = None

    def draw(self, engine: Any, scene: Any, picture: Picture) -> None:
        """Within view_draw."""
        import gpu  # not usable in background mode

        if picture is not self.picture:
            assert picture.texels is not None
            self._texture = _texture(gpu, picture.texels)
            self.picture = picture
        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(scene)
        self._draw_quad(gpu, picture.view.region, texture_rect(picture))
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")

    def _draw_quad(self, gpu: Any, place: Rect, part: TextureRect) -> None:
        from gpu_extras.batch import batch_for_shader

        x, y, x_end, y_end = place
        u, v, u_end, v_end = part
        if self._shader is None:
            self._shader = _texel_shader(gpu)
        shader = self._shader
        if self._batch is None or (place, part) != self._place:
            self._place = place, part
            self._batch = batch_for_shader(
                shader, "TRI_FAN",
                {
                    "pos": ((x, y), (x_end, y), (x_end, y_end), (x, y_end)),
                    "texCoord": ((u, v), (u_end, v), (u_end, v_end), (u, v_end)),
                },
            )  # fmt: skip
        shader.bind()
        shader.uniform_sampler("image", self._texture)
        self._batch.draw(shader)


def texture_rect(picture: Picture) -> TextureRect:
    """What of its texture the view's region shows. The first pixel may begin before the region
    does, and the last end after it."""
    view, pixel = picture.view, picture.pixel
    left = (view.region[0] - view.film[0]) % pixel / pixel
    below = (view.region[1] - view.film[1]) % pixel / pixel
    return left, below, left + view.width / pixel, below + view.height / pixel


def _texel_shader(gpu: Any) -> Any:
    """Draws the texel that a pixel of the screen lies in."""
    between = gpu.types.GPUStageInterfaceInfo("komorebi_texel")
    between.smooth("VEC2", "texel")
    info = gpu.types.GPUShaderCreateInfo()
    info.push_constant("MAT4", "ModelViewProjectionMatrix")
    info.sampler(0, "FLOAT_2D", "image")
    info.vertex_in(0, "VEC2", "pos")
    info.vertex_in(1, "VEC2", "texCoord")
    info.vertex_out(between)
    info.fragment_out(0, "VEC4", "color")
    info.vertex_source(VERTEX)
    info.fragment_source(FRAGMENT)
    return gpu.shader.create_from_info(info)


def _texture(gpu: Any, texels: FloatArray) -> Any:
    height, width = texels.shape[:2]
    buffer = gpu.types.Buffer("FLOAT", texels.size, np.ravel(texels))
    return gpu.types.GPUTexture((width, height), format="RGBA16F", data=buffer)
