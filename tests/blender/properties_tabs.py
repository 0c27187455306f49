"""Runs in a Blender with a window: opens each tab of the properties editor, unfolded, with Komorebi.

    blender ... -P tests/blender/properties_tabs.py -- FOLDER

For each subject and tab it shows the editor in place of the 3D view, writes the name of the tab and
the editor's place (x and y from the bottom left, width, height) to FOLDER/shown and waits until the test has taken FOLDER/shown away (so that it can keep a picture).
Errors in panels are what Blender prints; the last line is DONE and the number of tabs.
"""

import os
import sys
import traceback
from pathlib import Path

import bpy

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))
import support  # noqa: E402

FOLDER = Path(sys.argv[sys.argv.index("--") + 1])
# Of Blender's, to be unfolded too: a panel with all that are in it, which come after it.
ADOPTED = ("DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture",
           "VIEWLAYER_PT_override")  # fmt: skip


def unfold(classes):
    """Panels that start closed would not be drawn; `classes` are not registered."""
    for cls in classes:
        if "DEFAULT_CLOSED" in getattr(cls, "bl_options", ()):
            cls.bl_options = set(cls.bl_options) - {"DEFAULT_CLOSED"}


def prepare():
    support.enable()
    import komorebi
    from komorebi import ui

    komorebi.unregister()
    unfold(ui.CLASSES)
    blenders = [getattr(bpy.types, name) for name in ADOPTED if hasattr(bpy.types, name)]
    for cls in reversed(blenders):
        bpy.utils.unregister_class(cls)
    unfold(blenders)
    for cls in blenders:
        bpy.utils.register_class(cls)
    komorebi.register()
    bpy.context.preferences.view.show_splash = False
    scene = bpy.context.scene
    support.small(scene)
    layer = bpy.context.view_layer
    layer.use_pass_z = layer.use_pass_mist = True
    bpy.ops.object.empty_add()
    bpy.context.object.name = "Empty"
    bpy.context.object.instance_type = "COLLECTION"
    bpy.context.object.instance_collection = bpy.data.collections.new("Instanced")
    cube = bpy.data.objects["Cube"]
    cube.modifiers.new("Hair", "PARTICLE_SYSTEM")
    cube.particle_systems[0].settings.type = "HAIR"


def steps():
    """(subject, tab, what to change before)."""
    scene = bpy.context.scene
    for tab in ("RENDER", "OUTPUT", "VIEW_LAYER", "SCENE", "WORLD", "OBJECT", "PARTICLES",
                "PHYSICS", "CONSTRAINT", "MODIFIER", "DATA", "MATERIAL"):  # fmt: skip
        yield "Cube", tab, lambda: None
    yield "Camera", "OBJECT", lambda: None
    yield "Camera", "DATA", lambda: None
    camera = bpy.data.cameras["Camera"]
    yield "Camera", "DATA", lambda: setattr(camera, "type", "PANO")
    yield "Light", "DATA", lambda: None
    yield "Light", "OBJECT", lambda: None
    yield "Empty", "OBJECT", lambda: None
    yield "Cube", "RENDER", lambda: setattr(scene.komorebi, "method", "WORLD_LIGHT")


class Show:
    def __init__(self):
        self.steps, self.shown, self.wait = steps(), 0, 0

    def __call__(self):
        try:
            return self.step()
        except BaseException:
            traceback.print_exc()
            sys.stderr.flush()
            os._exit(3)  # an exception in a timer does not end Blender

    def step(self):
        mark = FOLDER / "shown"
        if mark.exists():
            return 0.05
        if self.wait:
            self.wait -= 1
            if self.wait == 0:
                area = largest()
                mark.write_text(f"{self.name} {area.x} {area.y} {area.width} {area.height}")
            return 0.1
        try:
            subject, tab, change = next(self.steps)
        except StopIteration:
            print("DONE", self.shown, flush=True)
            bpy.ops.wm.quit_blender()
            return None
        change()
        obj = bpy.data.objects[subject]
        bpy.context.view_layer.objects.active = obj
        area = largest()
        area.spaces.active.context = tab
        area.tag_redraw()
        self.shown += 1
        self.name = f"{self.shown:02}-{subject}-{tab}"
        self.wait = 3
        return 0.1


def largest():
    """The largest area of the window, where the 3D view is at first."""
    areas = bpy.context.window_manager.windows[0].screen.areas
    return max(areas, key=lambda area: area.width * area.height)


def begin():
    try:
        largest().type = "PROPERTIES"
        bpy.app.timers.register(Show(), first_interval=0.5, persistent=True)
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(3)


prepare()  # before the first draw: a panel that is drawn already must not go
bpy.app.timers.register(begin, first_interval=1.0, persistent=True)
