"""Every setting that the add-on's code reads is drawn by some panel while Komorebi is chosen.

What is read: names of attributes in the code outside of ui/ that are properties, open to change, of
the types that hold settings. What is drawn: by our panels and by those of Blender that we show.
"""

import ast
import contextlib
from pathlib import Path

import bpy
import komorebi
import panel_recorder as recorder
import panel_subjects
from komorebi import passes, ui

ADDON = Path(komorebi.__file__).parent
# Types with settings, and what of them is no setting: names, trees, what code reads of other types.
SETTINGS = (
    "Scene", "RenderSettings", "ViewLayer", "LayerCollection", "Object", "Camera",
    "CameraDOFSettings", "World", "WorldLighting", "WorldMistSettings", "Material",
    "ParticleSettings", "KomorebiSceneSettings", "KomorebiViewLayerSettings",
    "CyclesObjectSettings", "CyclesCameraSettings", "CyclesCurveRenderSettings",
    "CyclesRenderSettings", "CyclesVisibilitySettings", "CyclesRenderLayerSettings",
)  # fmt: skip
ELSEWHERE = {
    **{f"border_{end}_{axis}": "drawn into the view" for end in ("min", "max") for axis in "xy"},
    "compositing_node_group": "the compositor's header, from 5.0",
    "focus_subtarget": "drawn where the focus object is an armature",
    "feature_set": "read to say that adaptive subdivision is ignored",
    "displacement_method": "read to say that nothing is displaced",
    **dict.fromkeys(("fps", "fps_base"), "drawn where the rate is none of Blender's list"),
    "frame_current": "the timeline",
    "frame_subframe": "the timeline, where its menu shows it",
    "holdout": "the outliner's column and menu",
    "indirect_only": "the outliner's menu",
    "kink": "drawn where strands have children",
    "kink_extra_steps": "drawn where strands have children that wind",
    "matrix_world": "by Transform",
    "preview_pause": "the viewport's header",
    "shadow_terminator_offset": "of Cycles up to 4.1, drawn as the object's own after that",
    "use_adaptive_subdivision": "read to say that it is ignored",
    "use_nodes": "always on from 5.0, drawn before",
}
NO_SETTING = {  # names of other types too, which are what is read
    "height": "of an image, read in native_scene.py",
    "instance_object": "of an instance, not of particles",
    "location": "of a node",
    "material": "of a slot, not of particles",
    "name": "what a message says",
    "scale": "of a node",
}


# Passes that a file's compositor may ask for and that nothing fills: told to Blender, not shown.
UNFILLED = {switch.prop for switch in passes.SWITCHES if not switch.group}


def attributes_read():
    """{name: file} of every attribute that the add-on's code takes, its panels left out."""
    found = {}
    for path in ADDON.rglob("*.py"):
        if "ui" in path.relative_to(ADDON).parts[:1]:
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Attribute):
                found.setdefault(node.attr, path.name)
            elif isinstance(node, ast.Constant) and str(node.value).isidentifier():
                found.setdefault(node.value, path.name)  # getattr(obj, "visible_camera")
    return found


def settings():
    """{name: [type]} of all properties that a user may change, of the types with settings."""
    groups = {cls.__name__: cls for cls in bpy.types.PropertyGroup.__subclasses__()}
    found = {}
    for name in SETTINGS:
        if name == "CyclesCameraSettings" and name not in groups:
            continue  # in 3.4 alone: later its properties are the camera's own
        cls = getattr(bpy.types, name, None) or groups[name]
        for p in cls.bl_rna.properties:
            if not p.is_readonly and not p.is_hidden:
                found.setdefault(p.identifier, []).append(name)
    return found


def drawn_names():
    """Names of properties in all that is shown, Blender's panels included."""
    shown = [p for p in bpy.types.Panel.__subclasses__()
             if "KOMOREBI" in getattr(p, "COMPAT_ENGINES", ())]  # fmt: skip
    free = [bpy.types.RENDER_PT_context, bpy.types.SCENE_PT_scene, bpy.types.OBJECT_PT_instancing]
    names = set()
    for _, context in panel_subjects.subjects():
        for panel in (*ui.CLASSES, *shown, *free):
            # Some of Blender's own ask for more of a context than there is without a window.
            forgiven = () if panel in ui.CLASSES else (Exception,)
            with contextlib.suppress(*forgiven):
                names |= {name for _, name in recorder.draw(panel, context) or ()}
    return names


def test_all_that_is_read_can_be_set():
    read, drawn = attributes_read(), drawn_names()
    missing = {
        f"{name} of {' or '.join(types)}, read in {read[name]}"
        for name, types in settings().items()
        if name in read and name not in {*drawn, *NO_SETTING, *ELSEWHERE, *UNFILLED}
    }
    assert not missing, missing
