"""Pixels onto the screen: one texture a viewport, drawn through the scene's display transform."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..scene_data import FloatArray
from .view_camera import Rect
from .worker import Picture


class Drawing:
    """The texture of the picture that was drawn last."""

    def __init__(self) -> None:
        self.picture: Picture | None = None
        self._texture: Any = None
        self._batch: Any = None
        self._place: Rect | None = None

    def draw(self, engine: Any, scene: Any, picture: Picture) -> None:
        """Within view_draw."""
        import gpu  # not usable in background mode

        if picture is not self.picture:
            assert picture.texels is not None
            self._texture = _texture(gpu, picture.texels)
            self.picture = picture
        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(scene)
        self._draw_quad(gpu, picture.view.region)
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")

    def _draw_quad(self, gpu: Any, place: Rect) -> None:
        from gpu_extras.batch import batch_for_shader

        x, y, x_end, y_end = place
        shader = _image_shader(gpu)
        if self._batch is None or place != self._place:
            self._place = place
            self._batch = batch_for_shader(
                shader, "TRI_FAN",
                {
                    "pos": ((x, y), (x_end, y), (x_end, y_end), (x, y_end)),
                    "texCoord": ((0, 0), (1, 0), (1, 1), (0, 1)),
                },
            )  # fmt: skip
        shader.bind()
        shader.uniform_sampler("image", self._texture)
        self._batch.draw(shader)


def _image_shader(gpu: Any) -> Any:
    """Blender's shader that draws a texture; its name once told the dimensions."""
    try:
        return gpu.shader.from_builtin("IMAGE")
    except ValueError:
        return gpu.shader.from_builtin("2D_IMAGE")


def _texture(gpu: Any, texels: FloatArray) -> Any:
    height, width = texels.shape[:2]
    buffer = gpu.types.Buffer("FLOAT", texels.size, np.ravel(texels))
    return gpu.types.GPUTexture((width, height), format="RGBA16F", data=buffer)
