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
from . import keys
from .view_camera import Rect, ViewCamera, coarse_view

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


@dataclass(slots=True)
class Picture:
    """What there is to see."""

    view: ViewCamera
    pixels: FloatArray  # [height, width, 4], premultiplied, scene linear
    pixel: int  # how wide its pixels are on the screen
    sample: int
    samples: int


@dataclass(slots=True)
class _Wanted:
    """What the worker has been asked for; guarded by the condition."""

    scene: SceneRequest | None = None  # not taken yet
    view: ViewCamera | None = None
    changed: bool = False  # another scene or view than what is on
    paused: bool = False
    stopped: bool = False
    cancel: Any = None  # of the build that is on


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
        self._settings: dict[str, Any] = {}
        self._source = "Combined"
        self._background: float | None = None
        self._is_idle = False
        self.picture: Picture | None = None
        self.error = ""
        self.statistics = Statistics()
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
                    self._build(request, cancel)
                if self._scene is not None and view is not None:
                    self._render(view)
            except self._core.Cancelled:
                if request is not None:
                    self._take_back(request)
            except Exception as error:
                self._fail(error)
        self._scene = None
        keys.close(id(self))

    def _take_back(self, request: SceneRequest) -> None:
        """What was not built comes again, unless there is a newer one."""
        with self._condition:
            if self._wanted.scene is None and not self._wanted.stopped:
                self._wanted.scene, self._wanted.changed = request, True

    def _fail(self, error: Exception) -> None:
        self.error = str(error)
        self._scene = None
        self._redraw()

    def _build(self, request: SceneRequest, cancel: Any) -> None:
        self.error, self.statistics = "", Statistics(stage="Building the scene")
        threads = request.settings["threads"]
        shown = {mesh.key.geometry for mesh in request.data.meshes if mesh.key is not None}
        parts = native_scene.load(self._core, request.data, 0.0, threads, cancel)
        scene = native_scene.build(self._core, request.data, parts, None, threads, cancel)
        keys.show(id(self), shown)
        self._scene, self._settings = scene, request.settings
        self._source, self._background = request.source, request.background
        self.statistics = Statistics(scene.triangle_count, scene.byte_count)

    def _is_over(self) -> bool:
        return self._wanted.changed

    def _render(self, view: ViewCamera) -> None:
        """Picture after picture until the last sample, or until something else is wanted."""
        final = self._settings["pixel_size"]
        for pixel in (*(p * final for p in COARSE), final):
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
                        self._publish(view, session, coarse.region, pixel, progress, is_final)
                if over:
                    return True
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
        self, view: ViewCamera, session: Any, region: Rect, pixel: int, progress: Any,
        is_final: bool,
    ) -> None:  # fmt: skip
        pixels = session.read(self._source)
        if self._background is not None:
            pixels[:, :, :3] += np.float32(self._background) * session.read("Environment")
            pixels[:, :, 3] += np.float32(self._background) * (1.0 - pixels[:, :, 3])
        statistics = self.statistics
        statistics.rays, statistics.seconds = progress["rays"], progress["elapsed"]
        self.picture = Picture(
            view, pixels, pixel, progress["sample"] if is_final else 0, self._settings["samples"]
        )
        self._redraw()
