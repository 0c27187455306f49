"""Renders what a viewport shows, on a thread of its own: the newest scene by the newest camera.

Nothing in here touches bpy. What comes anew ends what is on: a build by its Cancel, a picture by
its session's. A picture starts coarse and becomes finer, so that there is always something to see.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import native_scene
from ..scene_data import FloatArray, SceneData
from . import keys, studio_blur
from .denoising import DenoisingRequest, ViewDenoiser
from .view_camera import ViewCamera, coarse_view

POLL_SECONDS = 0.01
# How wide the pixels of the pictures are that come before the final ones.
COARSE = (8, 4)


@dataclass(slots=True)
class SceneRequest:
    """A scene to be rendered from now on."""

    data: SceneData
    settings: dict[str, Any]  # the core's
    source: str  # the core's pass that is shown
    background: float | None = None  # how opaque the world is; None: as the film says
    blur: float = 0.0  # of a studio light behind the scene, 0 to 1
    denoising: DenoisingRequest | None = None


@dataclass(slots=True)
class Picture:
    """What there is to see."""

    view: ViewCamera
    pixels: FloatArray  # [height, width, 4], premultiplied, scene linear
    pixel: int  # how wide its pixels are on the screen
    sample: int
    samples: int
    is_denoised: bool = False


@dataclass(slots=True)
class _Wanted:
    """What the worker has been asked for; guarded by the condition."""

    scene: SceneRequest | None = None  # not taken yet
    view: ViewCamera | None = None
    changed: bool = False  # another scene or view than what is on
    paused: bool = False
    stopped: bool = False
    cancel: Any = None  # of the build that is on
    is_for_view: bool = False  # the build that is on is of no use to another view


@dataclass(slots=True)
class Statistics:
    """Of what is on."""

    triangles: int = 0
    bytes: int = 0
    rays: int = 0
    seconds: float = 0.0
    stage: str = ""


class Worker:
    """One a viewport; `redraw` is called, from the thread, when there is something new to show."""

    def __init__(self, core: Any, redraw: Callable[[], None]) -> None:
        self._core = core
        self._redraw = redraw
        self._wanted = _Wanted()
        self._condition = threading.Condition()
        self._scene: Any = None  # core.Scene
        self._built: tuple[SceneData, native_scene.Parts] | None = None  # what it is made of
        self._settings: dict[str, Any] = {}
        self._source = "Combined"
        self._background: float | None = None
        self._is_idle = False
        self.picture: Picture | None = None
        self.error = ""
        self.warnings: list[str] = []  # of the build
        self.statistics = Statistics()
        self.view_denoiser = ViewDenoiser(self._show_picture)
        self._thread = threading.Thread(target=self._run, name="komorebi-viewport", daemon=True)
        self._thread.start()

    # Called by Blender's thread.

    def show(self, request: SceneRequest) -> None:
        """From now on this scene."""
        with self._condition:
            self._wanted.scene, self._wanted.changed = request, True
            self._interrupt()

    def look(self, view: ViewCamera) -> None:
        """From now on by this camera; nothing happens if that is so already."""
        with self._condition:
            if view == self._wanted.view:
                return
            self._wanted.view, self._wanted.changed = view, True
            if self._wanted.is_for_view:
                self._interrupt()
            self._condition.notify_all()

    @property
    def is_idle(self) -> bool:
        """Whether nothing is left to do."""
        with self._condition:
            return self._is_idle and not self._wanted.changed

    def pause(self, paused: bool) -> None:
        with self._condition:
            self._wanted.paused = paused
            self._condition.notify_all()

    def stop(self) -> None:
        """Ends the thread; back within some milliseconds."""
        with self._condition:
            self._wanted.stopped = self._wanted.changed = True
            self._interrupt()
        if threading.current_thread() is not self._thread:
            self._thread.join()

    def _interrupt(self) -> None:
        if self._wanted.cancel is not None:
            self._wanted.cancel.request()
        self._condition.notify_all()

    # The thread.

    def _run(self) -> None:
        while True:
            with self._condition:
                while not self._wanted.changed and not self._wanted.stopped:
                    self._is_idle = True
                    self._condition.wait()
                self._is_idle = False
                if self._wanted.stopped:
                    break
                request, view = self._wanted.scene, self._wanted.view
                self._wanted.scene, self._wanted.changed = None, False
                cancel = self._wanted.cancel = self._core.Cancel()
            try:
                if request is not None:
                    self._build(request, cancel, view)
                if self._scene is not None and view is not None:
                    self._render(view)
            except self._core.Cancelled:
                if request is not None:
                    self._take_back(request)
            except Exception as error:
                self._fail(error)
        self._scene = self._built = None
        self.view_denoiser.close()
        keys.close(id(self))

    def _take_back(self, request: SceneRequest) -> None:
        """What was not built comes again, unless there is a newer one."""
        with self._condition:
            if self._wanted.scene is None and not self._wanted.stopped:
                self._wanted.scene, self._wanted.changed = request, True

    def _fail(self, error: Exception) -> None:
        self.error = str(error)
        self._scene = self._built = None
        self._redraw()

    def _build(self, request: SceneRequest, cancel: Any, view: ViewCamera | None) -> None:
        self.error, self.statistics = "", Statistics(stage="Building the scene")
        threads = request.settings["threads"]
        shown = {mesh.key.geometry for mesh in request.data.meshes if mesh.key is not None}
        studio_blur.blur(self._core, request.data.world, request.blur, threads)
        parts = native_scene.load(self._core, request.data, 0.0, threads, cancel)
        eye = None if view is None else coarse_view(self._core, view, 1).camera
        scene = native_scene.build(self._core, request.data, parts, None, threads, cancel, eye)
        self._built, self.warnings = (request.data, parts), native_scene.warnings(parts)
        keys.show(id(self), shown)
        self._scene, self._settings = scene, request.settings
        self._source, self._background = request.source, request.background
        self.view_denoiser.configure(request.denoising)
        self.statistics = Statistics(scene.triangle_count, scene.byte_count)

    def _come_near(self, view: ViewCamera) -> bool:
        """Builds the tree over instances anew when the view is so far from where it was built for
        that floats are coarse there; False when something else is wanted."""
        eye = coarse_view(self._core, view, 1).camera
        if self._built is None or not self._scene.is_far_from_origin(eye):
            return True
        with self._condition:
            if self._wanted.changed:
                return False
            cancel = self._wanted.cancel = self._core.Cancel()
            self._wanted.is_for_view = True
        data, parts = self._built
        threads = self._settings["threads"]
        try:
            self._scene = native_scene.build(self._core, data, parts, None, threads, cancel, eye)
        except self._core.Cancelled:
            return False
        finally:
            with self._condition:
                self._wanted.is_for_view = False
        return True

    def _is_over(self) -> bool:
        return self._wanted.changed

    def _render(self, view: ViewCamera) -> None:
        """Picture after picture until the last sample, or until something else is wanted."""
        final = self._settings["pixel_size"]
        for pixel in (*(p * final for p in COARSE), final):
            if pixel == final and not self._come_near(view):
                return
            if not self._render_at(view, pixel, pixel == final):
                return

    def _render_at(self, view: ViewCamera, pixel: int, is_final: bool) -> bool:
        settings = dict(self._settings)
        del settings["pixel_size"]
        coarse = coarse_view(self._core, view, pixel)
        if not is_final:
            settings |= {
                "samples": 1, "light_samples": 2, "guides_light": False,
                "use_adaptive_sampling": False,
            }  # fmt: skip
        settings["region"] = coarse.region
        self.view_denoiser.begin()
        session = self._core.Session(self._scene, self._core.Settings(**settings), coarse.camera)
        try:
            sample = 0
            while True:
                over = session.wait(POLL_SECONDS)
                if self._is_over():
                    return False
                progress = session.progress()
                if session.error:
                    raise RuntimeError(session.error)
                if over or progress["sample"] > sample:
                    sample = progress["sample"]
                    if over or sample > 0:
                        self._publish(view, session, pixel, progress, is_final, over)
                if over:
                    return self.view_denoiser.is_finished(self._is_over)
                if self._wanted.paused:
                    self._stand_still(session)
        finally:
            session.cancel()

    def _stand_still(self, session: Any) -> None:
        """Until the pause ends or something else is wanted."""
        session.cancel()
        session.wait(1.0)
        with self._condition:
            self._condition.wait_for(lambda: self._wanted.changed or not self._wanted.paused)
        session.resume()

    def _publish(
        self, view: ViewCamera, session: Any, pixel: int, progress: Any, is_final: bool, over: bool
    ) -> None:
        statistics = self.statistics
        statistics.rays, statistics.seconds = progress["rays"], progress["elapsed"]
        sample = progress["sample"] if is_final else 0
        denoises = is_final and self.view_denoiser.takes(sample, over)
        if self.view_denoiser.has_shown and not denoises:
            return
        pixels = session.read(self._source)
        if self._background is not None:
            pixels[:, :, :3] += np.float32(self._background) * session.read("Environment")
            pixels[:, :, 3] += np.float32(self._background) * (1.0 - pixels[:, :, 3])
        picture = Picture(view, pixels, pixel, sample, self._settings["samples"])
        if denoises:
            self.view_denoiser.offer(
                picture, [session.read(name) for name in self.view_denoiser.guides]
            )
        if not self.view_denoiser.has_shown:
            self._show_picture(picture)

    def _show_picture(self, picture: Picture) -> None:
        self.picture = picture
        self._redraw()
