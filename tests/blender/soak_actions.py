"""What a person does around a rendered viewport, at random: each action is a function of a
random.Random, and the same numbers do the same. Used inside a Blender with a window.

An action leaves what the next one needs: a window with a 3D view, a scene with a mesh and a world.
"""

import addon_utils
import bmesh
import bpy
import view_steps as v
import window_steps as w
import x_windows
from mathutils import Euler, Vector

MESHES = 12  # no more of them: what grows is to be our own

ACTIONS = []


def action(weight=1):
    """Registers an action, `weight` times as likely as others."""

    def register(function):
        ACTIONS.extend([function] * weight)
        return function

    return register


def scene():
    return bpy.context.window_manager.windows[0].scene


def komorebi():
    return scene().komorebi


def meshes():
    return [o for o in scene().objects if o.type == "MESH"]


def set_mode(name):
    """Whether that could be: an object may be hidden, in all views or in this one alone."""
    with w.override():
        if not bpy.ops.object.mode_set.poll():
            return False
        bpy.ops.object.mode_set(mode=name)
    return True


def object_mode():
    active = bpy.context.window_manager.windows[0].view_layer.objects.active
    if active is not None and active.mode != "OBJECT":
        set_mode("OBJECT")


def active_mesh(random):
    """A mesh object that is active and selected alone, in object mode."""
    object_mode()
    chosen = random.choice(meshes())
    layer = bpy.context.window_manager.windows[0].view_layer
    for obj in layer.objects:
        obj.select_set(obj is chosen, view_layer=layer)
    layer.objects.active = chosen
    return chosen


def place(random, size=3.0):
    return [random.uniform(-size, size) for _ in range(3)]


@action(6)
def turn(random):
    view = random.choice(v.views())["view"]
    view.view_rotation.rotate(Euler((random.uniform(-0.3, 0.3), 0, random.uniform(-1, 1))))
    view.view_distance = random.uniform(8, 25)


@action(2)
def view_kind(random):
    view = random.choice(v.views())["view"]
    view.view_perspective = random.choice(("PERSP", "ORTHO", "CAMERA"))


@action(3)
def shading(random):
    space = random.choice(v.views())["area"].spaces.active
    space.shading.type = random.choice(("SOLID", "RENDERED", "RENDERED"))


@action(1)
def lights_of_shading(random):
    shading = w.space().shading
    shading.use_scene_world_render = random.random() < 0.6
    shading.use_scene_lights_render = random.random() < 0.6
    shading.studiolight_rotate_z = random.uniform(-3, 3)
    shading.studiolight_background_alpha = random.choice((0.0, 0.5, 1.0))


@action(2)
def render_pass(random):
    settings = w.space().shading.komorebi
    names = [i.identifier for i in settings.bl_rna.properties["render_pass"].enum_items]
    settings.render_pass = random.choice(names)


@action(6)
def move(random):
    obj = random.choice(meshes())
    obj.location, obj.rotation_euler = place(random), place(random)


@action(4)
def edit_mesh(random):
    object_mode()
    mesh = random.choice(meshes()).data
    for vertex in random.sample(list(mesh.vertices), min(8, len(mesh.vertices))):
        vertex.co += Vector(place(random, 0.05))
    mesh.update()


@action(2)
def add(random):
    object_mode()
    if len(meshes()) >= MESHES:
        remove(random)
        return
    with w.override():
        kind = random.choice(("monkey", "cube", "ico_sphere", "torus"))
        getattr(bpy.ops.mesh, f"primitive_{kind}_add")(location=place(random))


@action(1)
def remove(random):
    object_mode()
    if len(meshes()) > 2:
        bpy.data.objects.remove(random.choice(meshes()))
        bpy.data.orphans_purge()


@action(1)
def hide(random):
    obj = random.choice(meshes())
    obj.hide_viewport = not obj.hide_viewport


@action(1)
def subdivide(random):
    object_mode()
    obj = random.choice(meshes())
    if obj.modifiers:
        obj.modifiers.clear()
    elif len(obj.data.vertices) < 1000:
        obj.modifiers.new("Subdivision", "SUBSURF").levels = random.choice((1, 2))


@action(2)
def material(random):
    obj = random.choice(meshes())
    if not obj.data.materials:
        made = bpy.data.materials.new("Made")
        made.use_nodes = True
        obj.data.materials.append(made)
    made = obj.data.materials[0]
    nodes = [n for n in made.node_tree.nodes if n.type == "BSDF_PRINCIPLED"] if made else []
    for node in nodes:
        node.inputs["Base Color"].default_value = [random.random() for _ in range(3)] + [1]


@action(1)
def world(random):
    tree = scene().world.node_tree
    for node in tree.nodes if tree else ():
        if node.type == "BACKGROUND":
            node.inputs["Strength"].default_value = random.uniform(0, 2)


@action(1)
def lamp(random):
    lamps = [o for o in scene().objects if o.type == "LIGHT"]
    if len(lamps) > 3:
        bpy.data.objects.remove(lamps[0])
        return
    data = bpy.data.lights.new("Made", random.choice(("POINT", "SUN", "SPOT", "AREA")))
    obj = bpy.data.objects.new("Made", data)
    obj.location = place(random, 5)
    scene().collection.objects.link(obj)


@action(3)
def settings(random):
    chosen = komorebi()
    chosen.method = random.choice(("AMBIENT_OCCLUSION", "WORLD_LIGHT"))
    chosen.preview_samples = random.choice((1, 2, 16, 0))
    chosen.light_samples = random.choice((0, 1, 4))
    chosen.bounces = random.choice((0, 0, 2))
    scene().render.film_transparent = random.random() < 0.3
    scene().render.preview_pixel_size = random.choice(("AUTO", "2", "8"))
    scene().update_tag()


@action(1)
def pause(random):
    komorebi().preview_pause = random.random() < 0.3


@action(1)
def frame(random):
    scene().frame_set(random.randrange(1, 20))


@action(2)
def border(random):
    space = w.space()
    space.use_render_border = random.random() < 0.5
    space.render_border_min_x, space.render_border_min_y = random.random(), random.random()
    space.render_border_max_x, space.render_border_max_y = random.random(), random.random()
    scene().render.use_border = random.random() < 0.3
    w.view()["area"].tag_redraw()


@action(1)
def local_view(random):
    active_mesh(random)
    with w.override():
        bpy.ops.view3d.localview(frame_selected=False)


@action(1)
def quad_view(_random):
    with w.override():
        bpy.ops.screen.region_quadview()


@action(2)
def split_or_close(random):
    with w.override():
        areas = [a for a in bpy.context.screen.areas if a.type == "VIEW_3D"]
        if bpy.context.screen.show_fullscreen or not bpy.ops.screen.area_split.poll():
            return  # also just after a full screen
        if len(areas) > 1:
            bpy.ops.screen.area_close()
        else:
            direction = random.choice(("VERTICAL", "HORIZONTAL"))
            bpy.ops.screen.area_split(direction=direction, factor=random.uniform(0.3, 0.7))


@action(2)
def full_screen(random):
    with w.override():
        bpy.ops.screen.screen_full_area(use_hide_panels=random.random() < 0.5)


@action(3)
def resize(random):
    display = x_windows.Display()
    window = display.windows()[0]
    display.place(window, 0, 0, random.randrange(300, 960), random.randrange(250, 540))


@action(1)
def minimise(random):
    display = x_windows.Display()
    window = display.windows()[0]
    display.hide(window)
    yield random.uniform(0, 0.3)
    display.show(window)


@action(3)
def mode(random):
    active_mesh(random)
    set_mode(random.choice(("EDIT", "SCULPT", "WEIGHT_PAINT", "OBJECT")))


@action(2)
def edit_in_edit_mode(random):
    obj = active_mesh(random)
    if not set_mode("EDIT"):
        return
    yield 0.02
    edited = bmesh.from_edit_mesh(obj.data)
    for vertex in edited.verts:
        vertex.co.z += random.uniform(-0.02, 0.02)
    bmesh.update_edit_mesh(obj.data)
    yield 0.02


@action(1)
def undo_step(_random):
    bpy.ops.ed.undo_push(message="soak")


@action(2)
def undo(random):
    with w.override():
        step = random.choice((bpy.ops.ed.undo, bpy.ops.ed.undo, bpy.ops.ed.redo))
        if step.poll():
            step()


@action(1)
def other_engine(random):
    scene().render.engine = "BLENDER_WORKBENCH"
    yield random.uniform(0, 0.1)
    scene().render.engine = "KOMOREBI"


@action(1)
def add_on(random):
    addon_utils.disable("komorebi")
    yield random.uniform(0, 0.1)
    addon_utils.enable("komorebi")
    for each in bpy.data.scenes:
        each.render.engine = "KOMOREBI"


@action(1)
def other_scene(random):
    object_mode()
    window = bpy.context.window_manager.windows[0]
    with w.override():
        bpy.ops.scene.new(type=random.choice(("LINK_COPY", "FULL_COPY", "EMPTY")))
    yield random.uniform(0, 0.1)
    made = window.scene
    if len(bpy.data.scenes) > 1:
        bpy.data.scenes.remove(made)  # under the view that shows it
    bpy.data.orphans_purge()


@action(1)
def camera(random):
    if scene().camera is not None:
        bpy.data.objects.remove(scene().camera)
        return
    made = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene().collection.objects.link(made)
    made.location = place(random, 8)
    made.rotation_euler = (-made.location).to_track_quat("-Z", "Y").to_euler()
    made.data.type = random.choice(("PERSP", "ORTHO", "PANO"))
    made.data.dof.use_dof = random.random() < 0.3
    scene().camera = made


@action(1)
def final_render(_random):
    if scene().camera is None:
        return
    scene().render.resolution_x, scene().render.resolution_y = 64, 48
    komorebi().samples = 1
    with w.override({"window": bpy.context.window_manager.windows[0]}):
        bpy.ops.render.render()
