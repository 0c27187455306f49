# mypy: disable-error-code="override"
"""What Blender calls. Nothing but delegation: the work starts in `driver.py`."""

from __future__ import annotations

import weakref
from typing import Any

import bpy

from . import guard, passes

ENGINE_ID = "KOMOREBI"


class KomorebiRenderEngine(bpy.types.RenderEngine):
    """The entry "Komorebi" in Blender's list of render engines.

    An instance lives for one render (longer with Persistent Data) and holds only the frame that
    is exported and not yet rendered, and names of what it has exported (`unchanged.py`); what
    outlives a frame is in `cache.py`.
    """

    bl_idname = ENGINE_ID
    bl_label = "Komorebi"
    bl_use_preview = True
    bl_use_postprocess = True  # the compositor and the sequencer go over the picture
    bl_use_image_save = True
    bl_use_custom_freestyle = False  # Blender draws strokes itself, else they come as a scene here
    bl_use_shading_nodes_custom = False  # Blender's own shader nodes
    bl_use_eevee_viewport = True  # Material Preview is EEVEE's
    bl_use_gpu_context = False
    bl_use_spherical_stereo = True
    bl_use_stereo_viewport = False
    bl_use_alembic_procedural = False  # Blender reads Alembic files, frame by frame
    bl_use_materialx = False

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        # From 4.4 Blender passes arguments that the base class must see; 5.2 comes here twice.
        super().__init__(*args, **kwargs)

    def __del__(self) -> None:
        try:
            self.frame = None
            base = super()
            if hasattr(base, "__del__"):
                base.__del__()
        except (ReferenceError, AttributeError):
            pass  # Blender freed its half of the object first

    def update(self, data: Any, depsgraph: Any) -> None:
        """Exports the view layer of `depsgraph`; Blender's data is locked meanwhile."""
        self.frame = guard.run(self, depsgraph, "export_frame")

    def render(self, depsgraph: Any) -> None:
        """Renders what `update` exported into Blender's render result."""
        frame, self.frame = getattr(self, "frame", None), None
        if frame is not None:
            guard.run(self, depsgraph, "render_frame", frame)

    def view_update(self, context: Any, depsgraph: Any) -> None:
        """A viewport in Rendered shading: something has changed, or everything is new."""
        self._viewport().update(self, context, depsgraph)

    def view_draw(self, context: Any, depsgraph: Any) -> None:
        """Draws the region of a viewport."""
        self._viewport().draw(self, context, depsgraph)

    def _viewport(self) -> Any:
        viewport = getattr(self, "viewport", None)
        if viewport is None:
            # Late, so that the add-on can be enabled, and can say what is wrong, without NumPy.
            from .viewport.viewport import Viewport

            viewport = self.viewport = Viewport(self)
            # Not left to __del__: of what Blender has freed first, and its other threads have still
            # held, nothing can be asked any more there.
            weakref.finalize(self, viewport.close).atexit = False
        return viewport

    def update_render_passes(self, scene: Any = None, renderlayer: Any = None) -> None:
        """Tells Blender which passes a view layer will have."""
        passes.register_passes(self, scene, renderlayer)


def register() -> None:
    bpy.utils.register_class(KomorebiRenderEngine)


def unregister() -> None:
    bpy.utils.unregister_class(KomorebiRenderEngine)
