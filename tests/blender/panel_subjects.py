"""What a user may have before the properties editor: a context for each kind of thing."""

import types

import bpy
from komorebi.properties import KomorebiViewSettings
from panel_recorder import Context

# A viewport that shows a studio light in Rendered shading.
SHADING = types.SimpleNamespace(
    bl_rna=bpy.types.View3DShading.bl_rna, type="RENDERED", use_scene_world_render=False,
    komorebi=types.SimpleNamespace(bl_rna=KomorebiViewSettings.bl_rna),
)  # fmt: skip
SPACE = types.SimpleNamespace(
    shading=SHADING, type="PROPERTIES", context="OBJECT", pin_id=None, use_pin_id=False, search_filter="",
    path_from_id=lambda *_: "",
)  # fmt: skip
DATA_MEMBERS = {
    "MESH": "mesh", "CURVE": "curve", "SURFACE": "curve", "FONT": "curve", "META": "meta_ball",
    "CAMERA": "camera", "LIGHT": "light", "ARMATURE": "armature", "LATTICE": "lattice",
    "SPEAKER": "speaker", "CURVES": "curves", "VOLUME": "volume", "POINTCLOUD": "pointcloud",
}  # fmt: skip


def context_of(obj=None, **more):
    """The context of the properties editor while `obj` is active."""
    scene = bpy.context.scene
    members = {
        "engine": scene.render.engine, "scene": scene, "view_layer": scene.view_layers[0],
        "world": scene.world, "space_data": SPACE, "collection": scene.collection,
        "region": types.SimpleNamespace(width=400, height=900),
        "object": obj, "active_object": obj, "mode": "OBJECT",
    }  # fmt: skip
    if obj is not None:
        member = DATA_MEMBERS.get(obj.type)
        if member:
            members[member] = obj.data
        slots = obj.material_slots
        members["material_slot"] = slots[0] if slots else None
        members["material"] = slots[0].material if slots else None
        systems = obj.particle_systems
        members["particle_system"] = members["particle_system_editable"] = (
            systems[0] if systems else None
        )
        members["particle_settings"] = systems[0].settings if systems else None
    return Context(**{**members, **more})


def panorama_owner(camera):
    """Whoever has the settings of panoramas in this release, or None."""
    for owner in (camera, getattr(camera, "cycles", None)):
        if owner is not None and "panorama_type" in owner.bl_rna.properties:
            return owner
    return None


def panorama_types(camera):
    owner = panorama_owner(camera)
    if owner is None:
        return []
    return [item.identifier for item in owner.bl_rna.properties["panorama_type"].enum_items]


def add(name, data):
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def subjects():
    """Yields (name, context); a later one may change what an earlier one showed, so draw at once."""
    scene = bpy.context.scene
    cube, camera, light = (bpy.data.objects[n] for n in ("Cube", "Camera", "Light"))
    yield "mesh", context_of(cube)
    cube.material_slots[0].material = None
    yield "empty slot", context_of(cube)
    plain = bpy.data.materials.new("Plain")
    cube.material_slots[0].material = plain
    yield "material without nodes", context_of(cube)
    yield "camera", context_of(camera)
    camera.data.sensor_fit = "VERTICAL"
    yield "camera with a sensor's height", context_of(camera)
    camera.data.type = "ORTHO"
    yield "orthographic camera", context_of(camera)
    camera.data.type = "PANO"
    yield "panorama", context_of(camera)
    for kind in panorama_types(camera.data):
        panorama_owner(camera.data).panorama_type = kind
        yield f"panorama {kind}", context_of(camera)
    for kind in ("POINT", "SUN", "SPOT", "AREA"):
        light.data.type = kind
        yield f"light {kind}", context_of(light)
    light.data.shape = "RECTANGLE"
    yield "rectangular light", context_of(light)
    empty = add("Empty", None)
    yield "empty", context_of(empty)
    empty.instance_type = "COLLECTION"
    empty.instance_collection = bpy.data.collections.new("Instanced")
    yield "instance of a collection", context_of(empty)
    yield "curve", context_of(add("Curve", bpy.data.curves.new("Curve", "CURVE")))
    yield "nothing active", context_of(None)
    cube.modifiers.new("Hair", "PARTICLE_SYSTEM")
    cube.particle_systems[0].settings.type = "HAIR"
    yield "hair", context_of(cube)
    scene.render.use_motion_blur = scene.render.use_multiview = scene.render.use_simplify = True
    scene.view_layers[0].use_pass_mist, scene.view_layers[0].samples = True, 4
    scene.komorebi.method = "WORLD_LIGHT"
    scene.komorebi.use_adaptive_sampling = True
    scene.komorebi.use_preview_adaptive_sampling = True
    if hasattr(scene, "cycles_curves"):
        scene.cycles_curves.shape = "RIBBONS"
    yield "world light", context_of(cube)
    scene.komorebi.pixel_filter = "BOX"
    scene.world.use_nodes = False
    yield "world without nodes", context_of(cube)
    scene.world = None
    yield "no world", context_of(cube)
