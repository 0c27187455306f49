"""Blender's scene → plain arrays (`scene_data.py`). The only part that reads bpy data."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from contextlib import nullcontext
from typing import Any

from ..errors import RenderCancelled
from ..passes import value_columns
from ..scene_data import SceneData, WorldData
from ..scene_settings import settings_of
from ..unchanged import Unchanged
from .aovs import AovReader
from .camera_motion import CameraMotion
from .deform import DeformingShapes
from .instance import Shown, export_instances
from .motion import InstanceMotion
from .shutter import Shutter, export_shutter
from .sky_choice import export_sky
from .surroundings import surroundings_of
from .unsupported import warn_scene
from .wanted import Wanted


def export_scene(
    engine: Any, depsgraph: Any, views: Sequence[str] = ("",), sources: Collection[str] = (),
    unchanged: Unchanged | None = None,
) -> SceneData:  # fmt: skip
    """Everything that the view layer of `depsgraph` shows at its frame, seen by each stereo view.

    `sources` are the core's passes that are kept, which decide what they need to know; `unchanged`
    knows what an earlier frame has exported. With motion blur the depsgraph is evaluated at other
    times, too, and is at its frame again afterwards.
    """
    warn_scene(engine, depsgraph.scene)
    exported_world = export_sky(engine, depsgraph.scene, depsgraph.view_layer)
    shutter = export_shutter(depsgraph.scene, depsgraph.view_layer, sources)
    unchanged = unchanged or Unchanged()
    with nullcontext() if shutter is None else shutter.at_middle(engine):
        if shutter is not None:
            unchanged.begin(depsgraph)  # the middle may be at another time
        cameras = [CameraMotion(engine, depsgraph, view, shutter) for view in views]
        data = SceneData(
            cameras={view: camera.data for view, camera in zip(views, cameras, strict=True)},
            world=exported_world,
            texture_limit=settings_of(depsgraph.scene).texture_limit << 20,
        )
        deforming = DeformingShapes(engine, depsgraph, shutter)
        motion = None if shutter is None else InstanceMotion(shutter, deforming)
        if depsgraph.view_layer.use_sky and settings_of(depsgraph.scene).sky == "SCENE":
            columns = value_columns(depsgraph.view_layer)
            aovs = AovReader(engine, columns, surroundings_of(depsgraph.scene))
            data.world_values = aovs.of_world(depsgraph.scene.world)
        wanted = Wanted.by(sources)
        export_instances(engine, depsgraph, data, wanted, unchanged, deforming, motion)
        if shutter is not None and motion is not None:
            _follow(engine, depsgraph, shutter, cameras, motion)
            data.instances = motion.finish(data.instances)
            deforming.finish(data.meshes)
            for camera in cameras:
                camera.finish()
    return data


def export_view(
    engine: Any, depsgraph: Any, unchanged: Unchanged, shown: Shown | None,
    world: WorldData | None, sources: Collection[str],
) -> SceneData:  # fmt: skip
    """What a viewport's depsgraph shows, without a camera: the view has one of its own. `world` in
    place of the scene's."""
    unchanged.begin(depsgraph)
    data = SceneData(
        cameras={},
        world=world or export_sky(engine, depsgraph.scene, depsgraph.view_layer),
        texture_limit=settings_of(depsgraph.scene).texture_limit << 20,
    )
    export_instances(engine, depsgraph, data, Wanted.by(sources), unchanged, shown=shown)
    return data


def _follow(
    engine: Any, depsgraph: Any, shutter: Shutter, cameras: list[CameraMotion],
    motion: InstanceMotion,
) -> None:  # fmt: skip
    """Goes through the other times that anything has to be known at."""
    times = motion.times.union(*(camera.times for camera in cameras)) - {0.0}
    for number, time in enumerate(sorted(times)):
        if engine.test_break():
            raise RenderCancelled
        engine.update_stats("", f"Exporting motion: time {number + 1} of {len(times)}")
        shutter.go_to(engine, time)
        for camera in cameras:
            camera.record(time)
        motion.record(engine, depsgraph, time)
