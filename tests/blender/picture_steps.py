"""What pictures.py shows: each function sets Blender's window up, and reads the screen.

Runs inside Blender: `-P picture_steps.py -- NAME FOLDER`.
"""

import math
import os
import runpy
import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

sys.path.insert(0, str(Path(__file__).parent))
import window_steps as w

NAME, FOLDER = sys.argv[sys.argv.index("--") + 1 :]
SCENES = Path(__file__).parents[2] / "blend_scenes"

LIMIT = 3600  # seconds for a picture

screens = 0


def keep():
    """The screen as it is now, for pictures.py."""
    global screens
    pixels = np.ascontiguousarray(np.round(255 * w.screen()[::-1]).astype(np.uint8))
    np.save(f"{FOLDER}/screen_{screens:04}.npy", pixels)
    screens += 1


def prepare(samples):
    """The scene under the light that its own picture has."""
    samples = int(os.environ.get("KOMOREBI_PICTURE_SAMPLES", samples))  # fewer, for a quick look
    bpy.context.preferences.view.show_splash = False
    arguments, sys.argv = sys.argv, sys.argv[:1]  # the script reads what comes after "--"
    runpy.run_path(str(SCENES / "set_studio_light.py"))
    sys.argv = arguments
    scene = bpy.context.scene
    scene.render.engine = "KOMOREBI"
    scene.komorebi.method = "WORLD_LIGHT"
    settings = scene.komorebi
    settings.preview_samples = settings.samples = samples
    settings.use_preview_denoising = settings.use_denoising = True
    settings.preview_denoising_start_sample = samples  # the last picture alone
    return scene


def through_camera():
    space = w.space()
    space.region_3d.view_perspective = "CAMERA"
    with bpy.context.temp_override(**w.view()):
        bpy.ops.view3d.view_center_camera()
    space.shading.type = "RENDERED"


def properties_tab(tab):
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == "PROPERTIES":
            area.spaces.active.context = tab


def viewport():
    """The rendered viewport in Blender's interface."""
    prepare(samples=32)
    properties_tab("RENDER")
    yield 0.3
    through_camera()
    overlay = w.space().overlay
    overlay.show_cursor = overlay.show_floor = overlay.show_relationship_lines = False
    overlay.show_axis_x = overlay.show_axis_y = overlay.show_extras = False
    for obj in bpy.context.selected_objects:
        obj.select_set(False)
    yield from w.finished(LIMIT)
    keep()


def look(position, target):
    """Points a free view, which fills the window, from one place at another."""
    space = w.space()
    view = space.region_3d
    direction = Vector(target) - Vector(position)
    view.view_perspective = "PERSP"
    view.view_rotation = direction.to_track_quat("-Z", "Y")
    view.view_location = target
    view.view_distance = direction.length
    # A viewport shows twice as much as a camera with its lens.
    space.lens = 2.0 * bpy.context.scene.camera.data.lens


def full_view():
    """Nothing but the view, from where the scene's camera is."""
    yield from w.alone()
    look((0.55, -5.0, 1.30), (-0.05, 6.0, 3.15))
    w.space().shading.type = "RENDERED"


def refines():
    """How the picture gets better after an edit."""
    scene = prepare(samples=64)
    yield from full_view()
    yield from w.finished(LIMIT)
    scene.world.node_tree.nodes["Mapping"].inputs["Rotation"].default_value[2] += 0.01
    (viewport,) = w.viewports()
    yield from until(lambda: viewport.picture.pixel > 1)
    keep()
    for samples in (1, 8, scene.komorebi.preview_samples):
        yield from until(
            lambda n=samples: viewport.picture.pixel == 1 and viewport.picture.sample >= n
        )
        keep()


def until(holds):
    """Waits for what is to be seen, and until it is drawn."""
    while not holds():
        yield 0.002
    yield 0.1


def passes():
    """The shading popover's render passes."""
    prepare(samples=16)
    yield from full_view()
    for name in ("COMBINED", "NORMAL", "AO", "DIFFUSE_COLOR"):
        w.space().shading.komorebi.render_pass = name
        w.view()["area"].tag_redraw()
        yield 0.2
        yield from w.finished(LIMIT)
        keep()


def studio():
    """A studio light in place of the scene's world, with the popover that says so."""
    prepare(samples=16)
    yield from full_view()
    shading = w.space().shading
    shading.use_scene_world_render = False
    shading.studio_light = "courtyard.exr"
    shading.studiolight_background_alpha = 1.0
    yield 0.2
    yield from w.finished(LIMIT)
    keep()


def render():
    """The final render on its way, tile by tile."""
    from komorebi.progress import Progress

    done = 0.0
    update = Progress.update

    def noted(self, session, final=False):
        nonlocal done
        done = session.progress()["fraction"]
        update(self, session, final)

    Progress.update = noted
    scene = prepare(samples=16)
    yield 0.3
    scene.komorebi.use_progressive = False
    bpy.context.preferences.view.render_display_type = "AREA"
    with bpy.context.temp_override(window=w.view()["window"]):
        bpy.ops.render.render("INVOKE_DEFAULT")
    yield from until(lambda: done > 0.6)
    keep()


def turntable(frames=36):
    """The view swings on a loop in front of the stair."""
    prepare(samples=8)
    yield from full_view()
    space = w.space()
    space.use_render_border = True
    space.render_border_min_x, space.render_border_max_x = 0.0, 1.0
    space.render_border_min_y, space.render_border_max_y = 60 / 480, 420 / 480
    for frame in range(frames):
        turn = 2.0 * math.pi * frame / frames
        look((2.4 * math.sin(turn), -4.8, 1.7 + 0.4 * math.cos(turn)), (0.0, 6.0, 2.9))
        yield 0.1
        yield from w.finished(LIMIT)
        keep()


w.start(globals()[NAME]())
