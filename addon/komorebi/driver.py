"""Renders one view layer of one frame: export → build → session → Blender's render result."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy

from . import background, core, dump, jobs, native_scene, reporting
from .errors import RenderCancelled, RenderError
from .export import export_scene
from .export.names import name_of
from .export.settings import export_settings
from .framing import Region, render_region
from .passes import Pass, enabled_passes
from .progress import Progress
from .result import ResultWriter
from .scene_data import SceneData
from .views import active_views

TILE_SIZE = 64


@dataclass(slots=True)
class View:
    """One eye of a frame ("" when there is only one)."""

    name: str
    scene: SceneData


@dataclass(slots=True)
class Frame:
    """What `export_frame` leaves for `render_frame`."""

    layer: str
    region: Region
    passes: list[Pass]
    settings: dict[str, Any]
    views: list[View]


def export_frame(engine: Any, depsgraph: Any) -> Frame | None:
    """Blender's data → arrays, while Blender keeps its data locked."""
    core.load()  # fail before the work
    scene = depsgraph.scene
    layer = name_of(depsgraph.view_layer)
    engine.update_stats("", f"{layer} | Exporting the scene")
    framing = jobs.framing_scene(scene.original).render
    region = render_region(framing, engine.resolution_x, engine.resolution_y)
    if region[0] >= region[2] or region[1] >= region[3]:
        raise RenderError("The render border holds no pixel")
    passes = enabled_passes(depsgraph.view_layer)
    views = [View(name, export_scene(engine, depsgraph, name)) for name in active_views(scene)]
    settings = export_settings(scene, passes, region)
    return Frame(layer, region, passes, settings, views)


def render_frame(engine: Any, _depsgraph: Any, frame: Frame) -> None:
    """Renders the exported views one after the other."""
    for view in frame.views:
        _render_view(engine, frame, view)
        if engine.test_break():
            return


def _render_view(engine: Any, frame: Frame, view: View) -> None:
    native = core.load()
    progress = Progress(
        engine, f"{frame.layer}, {view.name}" if view.name else frame.layer,
        _tile_count(frame.region), _ignored(view.scene),
    )  # fmt: skip
    progress.stage("Building the scene")
    cancel = native.Cancel()
    threads = frame.settings["threads"]
    try:
        scene, environment = background.run(
            lambda: native_scene.build(native, view.scene, threads, cancel),
            engine.test_break, cancel,
        )  # fmt: skip
        settings = native.Settings(tile_size=TILE_SIZE, **frame.settings)
    except native.Cancelled:
        raise RenderCancelled from None
    except (ValueError, RuntimeError) as error:  # the core's sentences
        raise RenderError(str(error)) from error
    _warn_environment(engine, environment)
    if dump.write(scene, settings):
        return
    writer = ResultWriter(engine, frame.layer, view.name, frame.region, frame.passes)
    _run_session(engine, native.Session(scene, settings), writer, progress)


def _run_session(engine: Any, session: Any, writer: ResultWriter, progress: Progress) -> None:
    """Polls until the picture is done; when cancelled, what is done stays."""
    show_tiles = not bpy.app.background
    cancelled = False
    try:
        while not session.wait(background.POLL_SECONDS):
            if not cancelled and engine.test_break():
                cancelled = True
                session.cancel()
                continue
            tiles = session.updated_tiles()
            progress.add_tiles(len(tiles))
            progress.update(session)
            if show_tiles:
                writer.show(session, tiles)
    except BaseException:
        session.cancel()
        raise
    if session.error:
        raise RenderError(session.error)
    writer.finish(session)
    progress.update(session, final=True)


def _tile_count(region: Region) -> int:
    across = -(-(region[2] - region[0]) // TILE_SIZE)
    return across * -(-(region[3] - region[1]) // TILE_SIZE)


def _ignored(scene: SceneData) -> str:
    """What the method leaves out by design: for the statistics, not a warning."""
    parts = [f"{n} {kind}{'' if n == 1 else 's'}" for kind, n in scene.ignored.items()]
    return f"Without {', '.join(parts)}" if parts else ""


def _warn_environment(engine: Any, environment: Any | None) -> None:
    if environment is None:
        return
    for count, what in (
        (environment.nonfinite_texels, "are not finite"),
        (environment.negative_texels, "are negative"),
    ):
        if count:
            reporting.warn(engine, f"environment map: {count} pixels {what}, rendered as black")
