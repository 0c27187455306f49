"""One rendered 3D viewport: what the engine calls, all on Blender's own thread."""

from __future__ import annotations

import contextlib
import traceback
import weakref
from typing import Any

from .. import core, reporting
from ..errors import RenderError
from ..export import export_view
from ..export.settings import export_settings
from ..passes import Pass
from ..result import EXPOSED
from ..unchanged import Unchanged
from .drawing import Drawing
from .notices import Notices
from .view_camera import view_camera
from .view_options import background_of, blur_of, shown_in, world_of
from .view_settings import denoising_of, preview_settings
from .worker import Picture, SceneRequest, Worker

# Of a viewport's Render Pass the core's name.
PASSES = {
    "COMBINED": "Combined", "EMISSION": "Emission", "ENVIRONMENT": "Environment",
    "AO": "Ambient Occlusion", "SKY_VISIBILITY": "Sky Visibility",
    "SHADOW_CATCHER": "Shadow Catcher", "DIFFUSE_COLOR": "Diffuse Color",
    "BENT_NORMAL": "Bent Normal", "POSITION": "Position", "NORMAL": "Normal", "UV": "UV",
    "DEPTH": "Depth", "MIST": "Mist", "DENOISING_ALBEDO": "Diffuse Color",
    "DENOISING_NORMAL": "Denoising Normal", "SAMPLE_COUNT": "Debug Sample Count",
    "OBJECT_INDEX": "Object Index", "MATERIAL_INDEX": "Material Index",
    "INSTANCE_INDEX": "Instance Index",
}  # fmt: skip

# How long a redraw waits, once, for the picture of a new view, or scene, for which trees may have
# to be built: so that what is drawn is what there is, not once more what there was, which takes as
# long to draw. Longer ones come when they are there.
VIEW_SECONDS, SCENE_SECONDS = 0.03, 0.1


class Viewport:
    """Lives as long as the engine's instance, which is that of one viewport."""

    def __init__(self, engine: Any) -> None:
        self._worker = Worker(core.load(), _redrawer(engine))
        self._drawing = Drawing()
        self._unchanged = Unchanged()
        self._awaits = False  # whether the next redraw waits for a picture
        self._error = ""
        self._render_pass = ""
        self.notices = Notices()
        self._exported: list[str] = []  # what the export has warned of
        self._loaded: list[str] | None = None  # what the worker has, when last asked

    def close(self) -> None:
        """Ends all work; nothing may be called afterwards."""
        self._worker.stop()

    @property
    def picture(self) -> Picture | None:
        """The newest one."""
        return self._worker.picture

    @property
    def error(self) -> str:
        return self._error or self._worker.error

    @property
    def is_done(self) -> bool:
        """Whether all of it is rendered and drawn."""
        return self._worker.is_idle and self._drawing.picture is self._worker.picture

    def update(self, engine: Any, context: Any, depsgraph: Any) -> None:
        """Something in the scene has changed."""
        try:
            self._error = ""
            with reporting.collected() as self._exported:
                self._export(engine, context.space_data, depsgraph)
        except RenderError as error:
            self._error = str(error)
        except Exception as error:
            traceback.print_exc()
            self._error = f"Unexpected {type(error).__name__}: {error}"
        engine.tag_redraw()

    def _export(self, engine: Any, space: Any, depsgraph: Any) -> None:
        scene = depsgraph.scene
        source = PASSES[space.shading.komorebi.render_pass]
        data = export_view(
            engine, depsgraph, self._unchanged, shown_in(space), world_of(space), (source,)
        )
        passes = [Pass(source, "RGBA", "COLOR", source)]
        settings = export_settings(scene, depsgraph.view_layer, passes, (0, 0, 1, 1))
        denoising = denoising_of(scene, source, settings["threads"])
        kept = [source] if denoising is None else [source, *denoising.guides]
        settings |= preview_settings(scene) | {"passes": kept}
        exposed = source in EXPOSED and settings["method"] == "WORLD_LIGHT"
        self._render_pass = space.shading.komorebi.render_pass
        background = background_of(space) if source == "Combined" else None
        if background is not None:
            settings |= {"film_transparent": True, "passes": [*kept, "Environment"]}
        self._worker.show(
            SceneRequest(
                data, settings, source, background, blur_of(space), denoising,
                exposure=scene.komorebi.film_exposure if exposed else 1.0,
                pixel_size=_pixel_size(scene),
                start_resolution=scene.komorebi.preview_start_resolution,
            )
        )  # fmt: skip
        self._awaits = True

    def draw(self, engine: Any, context: Any, depsgraph: Any) -> None:
        """Blender draws the region: shows what there is, and has the rest rendered."""
        try:
            view = view_camera(engine, context, depsgraph)
        except RenderError as error:
            engine.update_stats("", f"Komorebi: {error}")
            return
        if view is None:
            return
        if context.space_data.shading.komorebi.render_pass != self._render_pass:
            self.update(engine, context, depsgraph)  # Blender tells nobody
        self._worker.pause(context.scene.komorebi.preview_pause)
        is_new_view = self._worker.look(view)
        if is_new_view or self._awaits:
            self._worker.await_picture(SCENE_SECONDS if self._awaits else VIEW_SECONDS)
            self._awaits = False
        picture = self._worker.picture
        error = self.error
        if picture is not None and not error:
            self._drawing.draw(engine, depsgraph.scene, picture)
        if self._worker.warnings is not self._loaded:
            self._loaded = self._worker.warnings
            self.notices.hold([*self._exported, *self._loaded])
        engine.update_stats("", f"Komorebi: {error}" if error else self._said(picture))

    def _said(self, picture: Picture | None) -> str:
        statistics = self._worker.statistics
        lines = [statistics.stage if picture is None else self._of(picture)]
        lines += filter(None, (self._worker.view_denoiser.error, self.notices.text))
        return "\n".join(lines)

    def _of(self, picture: Picture) -> str:
        statistics = self._worker.statistics
        said = []
        if picture.sample > 0:
            denoised = ", denoised" if picture.is_denoised else ""
            said.append(f"Sample {picture.sample}/{picture.samples}{denoised}")
        said.append(f"{statistics.triangles / 1e6:.1f} M tris")
        if statistics.seconds > 0.0:
            said.append(f"{statistics.rays / statistics.seconds / 1e6:.0f} Mrays/s")
        said.append(f"{statistics.bytes / 1e6:.0f} MB")
        return " · ".join(said)


def _pixel_size(scene: Any) -> int:
    """Blender's preview_pixel_size: AUTO is one pixel, two on screens of high density."""
    import bpy

    size = scene.render.preview_pixel_size
    if size != "AUTO":
        return int(size)
    return 2 if bpy.context.preferences.system.pixel_size > 1.5 else 1


def _redrawer(engine: Any) -> Any:
    """What a worker calls to be seen; it keeps no engine alive."""
    reference = weakref.ref(engine)

    def redraw() -> None:
        living = reference()
        if living is None:
            return
        with contextlib.suppress(ReferenceError):  # Blender has freed its half
            living.tag_redraw()

    return redraw
