"""Bringing an open file into the state that both engines render alike."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy

from compare.inside import camera, engines, materials, objects, render_settings, world

# A shadow on a catcher is a ratio of two means, which has an error of its own at few samples.
CATCHER_SAMPLES = 8


def open_file(path: str) -> list[str]:
    """Open a .blend without its interface and scripts; complaints about missing parts become
    notes."""
    try:
        bpy.ops.wm.open_mainfile(filepath=path, load_ui=False, use_scripts=False)
    except RuntimeError as error:
        if not bpy.data.filepath or not Path(bpy.data.filepath).samefile(path):
            raise
        return [f"Blender said while opening: {' '.join(str(error).split())}"]
    return []


def prepare(job: dict[str, Any]) -> tuple[Any, list[str]]:
    """Bring the open file into the state that both engines render; returns the scene and what was
    changed."""
    scene = bpy.context.scene
    if job["frame"] is not None:
        scene.frame_set(job["frame"])
    if job["camera"] is not None:
        camera.look_through(scene, job["camera"])
    notes = render_settings.set_size(scene, job["longest"])
    render_settings.set_output(scene)
    layer, more = render_settings.choose_view_layer(scene, job["view_layer"])
    lamps = job["lamps"] and job["mode"] == "world"
    notes += more + (objects.lamps_unseen() if lamps else objects.lamps_off())
    notes += objects.objects_off()
    if job["materials"]:
        layer.material_override = None
        notes += materials.make_matt()
    else:
        layer.material_override = engines.clay(job["mode"], job["flat"])
    if not job["materials"] or job["world_image"]:
        notes += world.set_world(scene, job["mode"], job["world_image"], lamps)
    if job["mode"] == "ao":
        objects.terminators_off()
        notes += objects.visible_alike()
    scene.frame_set(scene.frame_current)  # the camera bound to a marker, and all drivers
    depsgraph = layer.depsgraph
    depsgraph.update()
    notes += camera.ensure_camera(scene, depsgraph)
    notes += camera.supported_camera(scene.camera) + objects.unsupported_instances(depsgraph)
    samples = job["samples"]
    if any(t.is_shadow_catcher for t in scene.objects if t.type != "LIGHT"):
        samples *= CATCHER_SAMPLES
        notes.append(f"shadow catchers: {CATCHER_SAMPLES} times the samples")
    if job["stereo"] is not None:
        camera.both_eyes(scene, job["stereo"] == "spherical")
    if job["engine"] == "CYCLES":
        engines.set_cycles(scene, samples, job["bounces"])
    else:
        engines.set_komorebi(scene, samples, job["mode"], job["bounces"], job["materials"])
    engines.set_fast_gi(scene, job)
    return scene, layer, notes
