"""Rendered views of every kind in windows (under Xvfb), read from the screen and held against final
renders of the same: several views of one area, several areas and windows, cameras, clipping."""

import test_window

BEGIN = """
import bpy, numpy as np
import window_steps as w
import view_steps as v
import x_windows
from mathutils import Euler, Vector
scene = v.prepare()

def rendered():
    for view in v.views():
        space = view["area"].spaces.active
        v.bare(space)
        space.shading.type = "RENDERED"
    yield 0.3
"""


def run(folder, steps, size="960x540"):
    text = BEGIN + "\ndef steps():\n    yield 0.3\n" + steps + "\nw.start(steps())\n"
    return test_window.run(text, folder, size, timeout=300)


def test_quad_view(folder):
    run(folder, """
    yield from w.alone()
    with w.override():
        bpy.ops.screen.region_quadview()
    yield 0.3
    yield from rendered()
    assert (yield from v.expect_all("quad")) == 4
    assert [view["view"].view_perspective for view in v.views()].count("ORTHO") == 3
    bpy.data.objects["Suzanne"].location.x = 1.0  # an edit reaches all four
    yield 0.1
    assert (yield from v.expect_all("quad edited")) == 4
    with w.override():
        bpy.ops.screen.region_quadview()
    yield 0.3
    assert (yield from v.expect_all("single again")) == 1
    assert len(w.viewports()) == 1
""")  # fmt: skip


def test_areas_and_windows_at_once(folder):
    run(folder, """
    display = x_windows.Display()
    with w.override():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.4)
        bpy.ops.wm.window_new_main()  # with a scene of its own
    yield 0.5
    first, second = bpy.context.window_manager.windows
    with w.override({"window": second, "area": second.screen.areas[0]}):
        bpy.ops.screen.screen_full_area(use_hide_panels=True)
    yield 0.3
    second.screen.areas[0].type = "VIEW_3D"
    (other,) = set(display.windows()) - {display.windows()[0]}
    display.place(other, 970, 20, *display.size(other))
    yield 0.5
    yield from rendered()
    v.views()[1]["view"].view_rotation.rotate(Euler((0, 0, 0.7)))
    assert (yield from v.expect_all("three")) == 3
    bpy.data.objects["Cube"].data.vertices[0].co.z += 1.0
    bpy.data.objects["Cube"].data.update()
    yield 0.1
    assert (yield from v.expect_all("three edited")) == 3
    # A window may show another scene, whose settings are its own.
    other_scene = bpy.data.scenes.new("Other")
    other_scene.world = scene.world
    v.settings_of(other_scene)
    for name in ("Suzanne", "Plane"):
        other_scene.collection.objects.link(bpy.data.objects[name])
    other_scene.komorebi.light_samples = 3
    second.scene = other_scene
    yield 0.3
    yield from rendered()  # a scene that a window had not shown yet is looked at anew
    assert (yield from v.expect_all("another scene")) == 3
    with w.override({"window": second}):
        bpy.ops.wm.window_close()
    yield 0.3
    assert (yield from v.expect_all("one window again")) == 2
    assert len(w.viewports()) == 2
""", "1920x600")  # fmt: skip


CAMERA = """
    yield from w.alone()
    yield from rendered()
    scene.render.resolution_x, scene.render.resolution_y = 480, 320
    camera, data = scene.camera, scene.camera.data
    camera.location = (5, -4, 3)
    camera.rotation_euler = Vector((-5, 4, -2.2)).to_track_quat("-Z", "Y").to_euler()
    w.space().region_3d.view_perspective = "CAMERA"
"""


def test_through_the_camera(folder):
    run(folder, CAMERA + """
    yield from v.expect_camera("plain")
    scene.render.use_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.75
    scene.render.border_min_y, scene.render.border_max_y = 0.125, 0.875
    yield from v.expect_camera("border")
    scene.render.use_border = False
    data.shift_x, data.shift_y = 0.1, -0.05
    yield from v.expect_camera("shift")
    data.dof.use_dof, data.dof.focus_distance, data.dof.aperture_fstop = True, 4.0, 0.1
    yield from v.expect_camera("depth of field")
    data.passepartout_alpha = 1.0  # nothing outside of the frame is to be seen, or rendered
    yield from v.expect_camera("passepartout")
    (viewport,) = w.viewports()
    assert viewport.picture.pixels.shape[:2] == (322, 482), viewport.picture.pixels.shape
    data.passepartout_alpha, data.dof.use_dof = 0.5, False
    data.type, data.ortho_scale = "ORTHO", 6.0
    yield from v.expect_camera("orthographic")
    (viewport,) = w.viewports()
    assert viewport.picture.pixels.shape[:2] == (540, 960), viewport.picture.pixels.shape
""")  # fmt: skip


def test_through_panoramas(folder):
    run(folder, CAMERA + """
    data.type = "PANO"
    holder = data if "panorama_type" in data.bl_rna.properties else data.cycles
    for kind in ("EQUIRECTANGULAR", "FISHEYE_EQUIDISTANT", "FISHEYE_EQUISOLID", "MIRRORBALL"):
        holder.panorama_type = kind
        data.update_tag()
        yield from v.expect_camera(kind)
""")  # fmt: skip


def test_a_clipping_region_is_nothing_to_rendered_views(folder):
    """Cycles renders what lies outside of it, too (3.4.1: the same screen to the bit)."""
    run(folder, """
    yield from w.alone()
    yield from rendered()
    yield from w.finished()
    before = v.shown(v.views()[0])
    w.space().shading.type = "SOLID"  # where newer releases let it be chosen
    yield 0.2
    with w.override():
        bpy.ops.view3d.clip_border(xmin=300, xmax=560, ymin=150, ymax=400)
    w.space().shading.type = "RENDERED"
    yield 0.2
    assert w.space().region_3d.use_clip_planes
    yield from v.expect_all("clipped")
    assert np.abs(v.shown(v.views()[0]) - before).max() < 0.01
    bpy.data.objects["Suzanne"].location.x = 1.0
    yield 0.1
    yield from v.expect_all("clipped and edited")
""")  # fmt: skip


def test_render_region_and_local_view(folder):
    run(folder, """
    yield from w.alone()
    yield from rendered()
    space = w.space()
    yield from w.finished()
    whole = v.shown(v.views()[0])
    space.use_render_border = True
    space.render_border_min_x, space.render_border_max_x = 0.25, 0.75
    space.render_border_min_y, space.render_border_max_y = 0.25, 0.75
    w.view()["area"].tag_redraw()
    yield 0.1
    yield from w.finished()
    part = v.shown(v.views()[0])
    inside = np.s_[140:400, 245:715]
    assert np.abs(part[inside] - whole[inside]).max() < 0.01  # a screen's last digit
    part[135:405, 240:720] = whole[135:405, 240:720]
    assert np.abs(part - whole).max() > 0.3  # outside is Blender's own background
    space.use_render_border = False
    for obj in bpy.data.objects:
        obj.select_set(obj.name == "Suzanne")
    with w.override():
        bpy.ops.view3d.localview(frame_selected=False)
    yield 0.3
    yield from w.finished()
    local = v.shown(v.views()[0])
    with w.override():
        bpy.ops.view3d.localview(frame_selected=False)
    yield 0.3
    for obj in bpy.data.objects:
        obj.hide_render = obj.name != "Suzanne"
    finals = [v.final(scene, v.camera_along(v.views()[0]), 960, 540, s) for s in (5, 6)]
    v.compare(local, finals, "local view")
""")  # fmt: skip
