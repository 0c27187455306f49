"""Renders what a viewport shows, on a thread of its own: the newest scene by the newest camera.

Nothing in here touches bpy. What comes anew ends what is on: a build by its Cancel, a picture by
its session's. A picture starts coarse and becomes finer, so that there is always something to see.
The coarsest is never given up for another, and of two builds in a row only one: else edits that
come faster than pictures, as in playback, would leave none.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import native_scene
from ..scene_data import FloatArray, SceneData
from . import keys, studio_blur
from .denoising import DenoisingRequest, ViewDenoiser
from .refinement import (
    MOTION_SECONDS,
    REST_SECONDS,
    first_pixel,
    is_quick,
    next_pixel,
    quick_settings,
    redraw_seconds,
)
from .texels import texels_of
from .view_camera import ViewCamera, coarse_view

POLL_SECONDS = 0.01
END_SECONDS = 5.0  # what a session may take to end: some milliseconds as a rule


@dataclass(slots=True)
class SceneRequest:
    """A scene to be rendered from now on."""

    data: SceneData
    settings: dict[str, Any]  # the core's
    source: str  # the core's pass that is shown
    background: float | None = None  # how opaque the world is; None: as the film says
    blur: float = 0.0  # of a studio light behind the scene, 0 to 1
    denoising: DenoisingRequest | None = None
    exposure: float = 1.0
    pixel_size: int = 1  # how wide the final picture's pixels are on the screen
    start_resolution: int = 128  # of the first picture's longer side, in its pixels, at most


@dataclass(slots=True)
class Picture:
    """What there is to see."""

    view: ViewCamera
    pixels: FloatArray  # [height, width, 4], premultiplied, scene linear
    pixel: int  # how wide its pixels are on the screen
    sample: int
    samples: int
    serial: int = 0  # of the request that it answers
    exposure: float = 1.0
    texels: FloatArray | None = None  # as it goes onto the screen [rows, columns, 4]
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
    serial: int = 0  # of the newest scene or view
    since: float = -math.inf  # when it came
    is_motion: bool = False  # it came soon after the one before
    session: Any = None  # that is on
    gives_way: bool = False  # it ends when something else is wanted
    owes_picture: bool = False  # a build was given up, and no picture has come since
    is_awaited: bool = False  # Blender's thread waits for the next picture


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
        self._request: SceneRequest | None = None  # that it was built for
        self._serial = 0  # of what is on
        self._cost = math.inf  # seconds that a pixel of the last first picture took
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
            wanted = self._wanted
            wanted.scene = request
            if wanted.cancel is not None and not wanted.owes_picture:
                wanted.cancel.request()
                wanted.owes_picture = True
            self._change()

    def look(self, view: ViewCamera) -> bool:
        """From now on by this camera; False, and nothing happens, if that is so already."""
        with self._condition:
            wanted = self._wanted
            if view == wanted.view:
                return False
            wanted.view = view
            if wanted.is_for_view and wanted.cancel is not None:
                wanted.cancel.request()
            self._change()
            return True

    def _change(self) -> None:
        now = time.monotonic()
        self._wanted.is_motion = now - self._wanted.since < MOTION_SECONDS
        self._wanted.since = now
        self._wanted.changed = True
        self._wanted.serial += 1
        if self._wanted.gives_way and self._wanted.session is not None:
            self._wanted.session.cancel()
        self._condition.notify_all()

    def await_picture(self, seconds: float) -> None:
        """Back when there is a picture of what is wanted, or will be none, or after `seconds`."""
        with self._condition:
            self._wanted.is_awaited = True
            self._condition.wait_for(self._is_answered, seconds)
            self._wanted.is_awaited = False

    def _is_answered(self) -> bool:
        if self._is_idle and not self._wanted.changed:
            return True
        return self.picture is not None and self.picture.serial == self._wanted.serial

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
        """Ends the thread; back within some milliseconds. May be called again, and by a thread that
        has held the engine last, which waits for none: the worker may be waiting for it."""
        with self._condition:
            wanted = self._wanted
            wanted.stopped = wanted.changed = True
            if wanted.cancel is not None:
                wanted.cancel.request()
            if wanted.session is not None:
                wanted.session.cancel()
            self._condition.notify_all()
        if threading.current_thread() is threading.main_thread():
            self._thread.join()

    # The thread.

    def _run(self) -> None:
        while True:
            with self._condition:
                while not self._wanted.changed and not self._wanted.stopped:
                    self._is_idle = True
                    self._condition.notify_all()
                    self._condition.wait()
                self._is_idle = False
                if self._wanted.stopped:
                    break
                request, view = self._wanted.scene, self._wanted.view
                self._wanted.scene, self._wanted.changed = None, False
                self._serial = self._wanted.serial
                cancel = self._wanted.cancel = self._core.Cancel()
            try:
                if request is not None:
                    self._build(request, cancel, view)
                self._end_build()
                if self._request is not None and view is not None:
                    self._render(self._request, view)
            except self._core.Cancelled:
                if request is not None:
                    self._take_back(request)
            except Exception as error:
                # Another view may be one that can be rendered; another scene comes by itself.
                if request is not None and self._request is not request:
                    self._scene = self._built = self._request = None
                self.error = str(error)
                self._redraw()
        self._scene = self._built = self._request = None
        self.view_denoiser.close()
        keys.close(id(self))

    def _end_build(self) -> None:
        """No build is on any more."""
        with self._condition:
            self._wanted.cancel = None
            self._wanted.is_for_view = False

    def _take_back(self, request: SceneRequest) -> None:
        """What was not built comes again, unless there is a newer one."""
        with self._condition:
            if self._wanted.scene is None and not self._wanted.stopped:
                self._wanted.scene, self._wanted.changed = request, True

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
        self._scene, self._request = scene, request
        self.view_denoiser.configure(request.denoising)
        self.statistics = Statistics(scene.triangle_count, scene.byte_count)

    def _come_near(self, view: ViewCamera, threads: int) -> bool:
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
        try:
            self._scene = native_scene.build(self._core, data, parts, None, threads, cancel, eye)
        except self._core.Cancelled:
            return False
        finally:
            self._end_build()
        return True

    def _is_over(self) -> bool:
        """Whether what is on is to end."""
        return self._wanted.stopped or (self._wanted.changed and self._wanted.gives_way)

    def _render(self, request: SceneRequest, view: ViewCamera) -> None:
        """Picture after picture until the last sample, or until something else is wanted."""
        self.error = ""
        final, settings = request.pixel_size, request.settings
        pixel = first_pixel(view.width, view.height, request.start_resolution, final, self._cost)
        is_first = True
        while pixel > final or is_first or not is_quick(settings):
            start = time.monotonic()
            quick = quick_settings(settings, pixel > final)
            if not self._render_at(view, pixel, quick, is_final=False, gives_way=not is_first):
                return
            seconds = time.monotonic() - start
            if is_first:
                self._cost = seconds * pixel**2 / (view.width * view.height)
                if not self._rest():
                    return
            if pixel == final:
                break
            pixel, is_first = next_pixel(pixel, seconds, final), False
        if self._come_near(view, settings["threads"]):
            self._render_at(view, final, settings, is_final=True, gives_way=True)

    def _rest(self) -> bool:
        """After the first picture, in a motion or a pause; False when something else is wanted."""
        with self._condition:
            wanted = self._wanted
            wanted.gives_way = True
            if wanted.is_motion:
                self._condition.wait_for(lambda: self._is_over() or wanted.paused, REST_SECONDS)
            self._condition.wait_for(lambda: self._is_over() or not wanted.paused)
            return not self._is_over()

    def _render_at(
        self, view: ViewCamera, pixel: int, settings: dict[str, Any], is_final: bool,
        gives_way: bool,
    ) -> bool:  # fmt: skip
        """Whether it came to its end."""
        with self._condition:
            self._wanted.gives_way = gives_way
            if self._is_over():
                return False
        coarse = coarse_view(self._core, view, pixel)
        self.view_denoiser.begin()
        session = self._core.Session(
            self._scene, self._core.Settings(**settings | {"region": coarse.region}), coarse.camera
        )
        with self._condition:
            self._wanted.session = session
            if self._is_over():  # since then
                session.cancel()
        try:
            return self._follow(session, view, pixel, is_final)
        finally:
            with self._condition:
                self._wanted.session = None
            session.cancel()
            session.wait(END_SECONDS)  # else whoever frees it would wait with Python's lock

    def _follow(self, session: Any, view: ViewCamera, pixel: int, is_final: bool) -> bool:
        """Shows what comes of a session until it is over (True) or is to end (False)."""
        sample, shown, start = 0, 0.0, time.monotonic()
        while True:
            over = session.wait(POLL_SECONDS)
            if self._is_over():
                return False
            progress = session.progress()
            if session.error:
                raise RuntimeError(session.error)
            now = time.monotonic()
            is_new = is_final and progress["sample"] > sample
            if over or (is_new and now - shown >= redraw_seconds(now - start)):
                sample, shown = progress["sample"], now
                self._publish(view, session, pixel, progress, is_final, over)
            if over:
                return self.view_denoiser.is_finished(self._is_over)
            if self._wanted.paused and self._wanted.gives_way:
                self._stand_still(session)

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
        request = self._request
        assert request is not None
        pixels = session.read(request.source)
        if request.background is not None:
            pixels[:, :, :3] += np.float32(request.background) * session.read("Environment")
            pixels[:, :, 3] += np.float32(request.background) * (1.0 - pixels[:, :, 3])
        picture = Picture(
            view, pixels, pixel, sample, request.settings["samples"], self._serial, request.exposure
        )
        if denoises:
            self.view_denoiser.offer(
                picture, [session.read(name) for name in self.view_denoiser.guides]
            )
        if not self.view_denoiser.has_shown:
            self._show_picture(picture)

    def _show_picture(self, picture: Picture) -> None:
        picture.texels = texels_of(picture.pixels, picture.exposure)
        with self._condition:
            self.picture = picture
            self._wanted.owes_picture = False
            is_awaited = self._wanted.is_awaited and self._is_answered()
            self._condition.notify_all()
        if not is_awaited:  # else it is drawn anyway
            self._redraw()
