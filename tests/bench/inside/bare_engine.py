"""An engine that renders nothing: every redraw shows one of two pictures that are there already.

From an edit to its pixels on the screen is then what Blender, its OpenGL and the screen take.
"""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np


class BareEngine(bpy.types.RenderEngine):
    """A white sky above noise, of which no two redraws in a row show the same."""

    bl_idname = "BENCH_BARE"
    bl_label = "Bare"

    textures: list[Any] = []
    shown = 0

    def view_update(self, context: Any, depsgraph: Any) -> None:
        pass

    def view_draw(self, context: Any, depsgraph: Any) -> None:
        import gpu
        from gpu_extras.presets import draw_texture_2d

        width, height = context.region.width, context.region.height
        if not BareEngine.textures:
            BareEngine.textures = [_picture(gpu, width, height, seed) for seed in (1, 2)]
        BareEngine.shown = 1 - BareEngine.shown
        gpu.state.blend_set("ALPHA_PREMULT")
        self.bind_display_space_shader(depsgraph.scene)
        draw_texture_2d(BareEngine.textures[BareEngine.shown], (0, 0), width, height)
        self.unbind_display_space_shader()
        gpu.state.blend_set("NONE")


def _picture(gpu: Any, width: int, height: int, seed: int) -> Any:
    pixels = np.ones((height, width, 4), np.float32)
    below = height * 2 // 3
    pixels[:below, :, :3] = np.random.default_rng(seed).random((below, width, 1), np.float32)
    buffer = gpu.types.Buffer("FLOAT", pixels.size, pixels.ravel())
    return gpu.types.GPUTexture((width, height), format="RGBA16F", data=buffer)


def register() -> None:
    bpy.utils.register_class(BareEngine)
