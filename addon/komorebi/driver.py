"""Renders one view layer of one frame: export → build → session → Blender's render result."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import bpy

from . import (
    background,
    core,
    dump,
    jobs,
    memory,
    metadata,
    native_scene,
    native_surfaces,
    reporting,
)
from .denoise import library as oidn
from .denoise import run as denoise
from .errors import RenderCancelled, RenderError
from .export import export_scene
from .export.names import name_of
from .export.settings import export_settings
from .framing import Region, render_region
from .passes import Pass, enabled_cryptomattes, enabled_passes
from .progress import Progress
from .result import ResultWriter
from .scene_data import CameraData, FloatArray, SceneData
from .scene_settings import settings_of, suited
from .unchanged import Unchanged
from .views import active_views

T = TypeVar("T")

TILE_SIZE = 64


@dataclass(slots=True)
class View:
    """One eye of a frame ("" when there is only one)."""

    name: str
    camera: CameraData


@dataclass(slots=True)
class Frame:
    """What `export_frame` leaves for `render_frame`."""

    layer: str
    region: Region
    passes: list[Pass]
    settings: dict[str, Any]
    oidn: str  # the library to denoise with; "": the picture stays as it is
    scene: SceneData
    views: list[View]
    mattes: dict[str, list[str]]  # names in each Cryptomatte
    exposure: float = 1.0  # of the film


def export_frame(engine: Any, depsgraph: Any) -> Frame | None:
    """Blender's data → arrays, while Blender keeps its data locked."""
    core.load()  # fail before the work
    with suited(engine):
        return _export_frame(engine, depsgraph)


def _export_frame(engine: Any, depsgraph: Any) -> Frame | None:
    scene = depsgraph.scene
    layer = name_of(depsgraph.view_layer)
    engine.update_stats("", f"{layer} | Exporting the scene")
    oidn = _denoiser(scene)
    framing = jobs.framing_scene(scene.original).render
    region = render_region(framing, engine.resolution_x, engine.resolution_y)
    if region[0] >= region[2] or region[1] >= region[3]:
        raise RenderError("The render border holds no pixel")
    passes = enabled_passes(scene, depsgraph.view_layer)
    _warn_missing(engine, layer, passes)
    pixels = (region[2] - region[0]) * (region[3] - region[1])
    memory.require(pixels, passes, engine.resolution_x, engine.resolution_y)
    names = active_views(scene)
    settings = export_settings(scene, depsgraph.view_layer, passes, region)
    unchanged = _unchanged(engine, depsgraph)
    data = export_scene(engine, depsgraph, names, settings["passes"], unchanged)
    views = [View(name, camera) for name, camera in data.cameras.items()]
    mattes = _matte_names(data, enabled_cryptomattes(depsgraph.view_layer))
    # Ambient occlusion is no light.
    exposure = settings_of(scene).film_exposure if settings["method"] == "WORLD_LIGHT" else 1.0
    return Frame(layer, region, passes, settings, oidn, data, views, mattes, exposure)


def _unchanged(engine: Any, depsgraph: Any) -> Unchanged:
    """What this engine instance has exported before, without what has changed since."""
    known = getattr(engine, "unchanged", None)
    if known is None or not depsgraph.scene.render.use_persistent_data:
        known = engine.unchanged = Unchanged()
    known.begin(depsgraph)
    return known


def _warn_missing(engine: Any, layer: str, passes: list[Pass]) -> None:
    for p in passes:
        if not p.source:
            reporting.warn(
                engine, f'view layer "{layer}": pass "{p.name}" is not rendered yet, black'
            )


def _matte_names(data: SceneData, mattes: list[str]) -> dict[str, list[str]]:
    names = {
        "CryptoObject": [o.name for o in data.objects],
        "CryptoMaterial": [m.name for m in data.materials.materials],
        "CryptoAsset": [o.asset for o in data.objects],
    }
    return {matte: sorted(set(names[matte])) for matte in mattes}


def _denoiser(scene: Any) -> str:
    if not settings_of(scene).use_denoising:
        return ""
    library = oidn.find()
    if library.missing:  # now, not after an hour
        raise RenderError(f"Denoising is switched on. {library.missing}")
    return library.path


def render_frame(engine: Any, _depsgraph: Any, frame: Frame) -> None:
    """Renders the exported views one after the other."""
    engine.update_stats("", f"{frame.layer} | Building the scene")
    native, threads = core.load(), frame.settings["threads"]
    cancel = native.Cancel()
    parts = _native_work(
        engine, cancel,
        lambda: native_scene.load(native, frame.scene, _expected_rays(frame), threads, cancel),
    )  # fmt: skip
    for sentence in native_scene.warnings(parts):
        reporting.warn(engine, sentence)
    for view in frame.views:
        _render_view(engine, frame, parts, view)
        if engine.test_break():
            return


def _expected_rays(frame: Frame) -> float:
    """At most so many: a noise threshold or a time limit may end sooner."""
    x_min, y_min, x_max, y_max = frame.region
    settings = frame.settings
    light = settings["light_samples"] or core.load().AUTOMATIC_LIGHT_SAMPLES
    pixels = (x_max - x_min) * (y_max - y_min) * len(frame.views)
    per_bounce = 2  # the one that finds the next surface, and its light ray
    return float(pixels) * settings["samples"] * (1 + light + per_bounce * settings["bounces"])


def _native_work(engine: Any, cancel: Any, work: Callable[[], T]) -> T:
    """The result of `work()` on a thread; its failures as RenderError and RenderCancelled."""
    try:
        return background.run(work, engine.test_break, cancel)
    except core.load().Cancelled:
        raise RenderCancelled from None
    except (ValueError, RuntimeError) as error:  # the core's sentences
        raise RenderError(str(error)) from error


def _render_view(engine: Any, frame: Frame, parts: native_scene.Parts, view: View) -> None:
    native, data, threads = core.load(), frame.scene, frame.settings["threads"]
    progress = Progress(
        engine, f"{frame.layer}, {view.name}" if view.name else frame.layer, _said(data, parts)
    )
    cancel = native.Cancel()

    def build() -> tuple[Any, Any]:
        scene = native_scene.build(native, data, parts, view.camera, threads, cancel)
        return scene, native.Settings(tile_size=TILE_SIZE, **frame.settings)

    scene, settings = _native_work(engine, cancel, build)
    if not engine.is_preview and dump.write(scene, settings):
        return
    session = _native_work(engine, cancel, lambda: native.Session(scene, settings, cancel=cancel))
    writer = ResultWriter(
        engine, frame.layer, view.name, frame.region, frame.passes, frame.exposure
    )
    _run_session(engine, session, writer, progress, frame)


def _run_session(
    engine: Any, session: Any, writer: ResultWriter, progress: Progress, frame: Frame
) -> None:
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
            progress.update(session)
            if show_tiles:
                writer.show(session, tiles)
    except BaseException:
        session.cancel()
        raise
    if session.error:
        raise RenderError(session.error)
    fields, picture = metadata.fields(frame, session), None
    denoises = bool(frame.oidn) and not cancelled
    if show_tiles or not denoises:  # to be seen meanwhile, and there when denoising is given up
        writer.finish(session, fields)
    if denoises:
        progress.stage("Denoising")
        picture = _denoised(engine, session, frame)
        if not show_tiles:
            writer.finish(session, fields, picture)
        elif picture is not None:
            writer.replace(session, picture)
    progress.update(session, final=True)


def _denoised(engine: Any, session: Any, frame: Frame) -> FloatArray | None:
    """The denoised Combined; None when the user stops it, and keeps the noisy picture."""
    x_min, y_min, x_max, y_max = frame.region
    width, height, settings = x_max - x_min, y_max - y_min, frame.settings
    albedo, normal = denoise.guides(session, width, height)
    picture = session.read("Combined", 0, 0, width, height)
    try:
        with denoise.Denoiser(frame.oidn, settings["threads"]) as denoiser:
            return background.run(
                lambda: denoiser.denoise(picture, (albedo, normal)), engine.test_break, denoiser
            )
    except RenderCancelled:
        return None


def _said(data: SceneData, parts: native_scene.Parts) -> str:
    trees = "SAH trees" if parts.builder == "SAH" else "Linear trees"
    count = len(data.lamps)
    lamps = f"{count} lamp{'' if count == 1 else 's'}" if count else ""
    simpler = native_surfaces.simplified(data.materials)
    simplified = f"Simplified: {simpler}" if simpler else ""
    return " | ".join(filter(None, (trees, lamps, simplified)))
