"""Lines that Blender draws over the engine's picture, with its own engine on a GPU context.

Each renders in a process of its own: without any GPU, even a software one, Blender cannot.
"""

import numpy as np
import support

# Seconds: EEVEE compiles its shaders anew for each process, without a GPU for minutes.
LIMIT = int(min(240 * support.slowness(), 800))
SCRIPT = """
import bpy, pathlib
folder = pathlib.Path({folder!r})
scene = support.fresh_scene(size=(96, 72))
scene.eevee.taa_render_samples = 1
support.render(folder, "plain")
{change}
support.render(folder, "lines")
print("RENDERED")
"""
FREESTYLE = """
scene.render.use_freestyle = True
layer = scene.view_layers[0]
layer.use_freestyle = True
if not len(layer.freestyle_settings.linesets):
    layer.freestyle_settings.linesets.new("Lines")
"""
GREASE_PENCIL = """
scene.view_layers[0].use_pass_z = True  # by which Blender hides what is behind
before = set(bpy.data.objects)
if hasattr(bpy.ops.object, "grease_pencil_add") and bpy.app.version >= (4, 3, 0):
    bpy.ops.object.grease_pencil_add(type="STROKE", location={location})
else:
    bpy.ops.object.gpencil_add(type="STROKE", location={location})
(pencil,) = set(bpy.data.objects) - before
pencil.scale = (2, 2, 2)
pencil.show_in_front = False
"""

INSTANCE = (
    GREASE_PENCIL
    + """
(before,) = pencil.users_collection
before.objects.unlink(pencil)
stock = bpy.data.collections.new("Stock")
stock.objects.link(pencil)
pencil.location = (0, 0, 0)
empty = support.add_object("Empty", None, {location})
empty.instance_type, empty.instance_collection = "COLLECTION", stock
"""
)


def drawn(folder, change):
    """The picture without and with the lines."""
    done = support.script(
        SCRIPT.format(folder=str(folder), change=change), folder, LIMIT, DISPLAY=None
    )
    if "EGL" in done.output and "RENDERED" not in done.output and done.code in (-6, -11):
        raise support.Skip("Blender has no GPU context here, not even in software")
    assert done.code == 0 and "RENDERED" in done.output, done
    assert "not rendered yet" not in done.output, done
    return support.read(folder / "plain.exr"), support.read(folder / "lines.exr")


def test_freestyle_lines_are_drawn_by_eevee(folder):
    plain, lines = drawn(folder, FREESTYLE)
    changed = np.abs(lines - plain).max(2) > 0.05
    cube = plain[:, :, :3].mean(2) > 0.3
    assert 50 < changed.sum() < 0.5 * changed.size, changed.sum()
    assert (lines[changed][:, :3] < plain[changed][:, :3].max() + 1e-3).all()
    black = (lines[:, :, :3].max(2) < 0.01) & changed
    assert black.sum() > 20, black.sum()
    rim = cube ^ np.roll(cube, 1, 0) | cube ^ np.roll(cube, 1, 1)  # the cube's outline
    assert (changed & rim).sum() > 0.5 * rim.sum(), ((changed & rim).sum(), rim.sum())


def grease_pencil(folder, location, change=GREASE_PENCIL):
    """The picture, and where a grease pencil stroke at `location` changes it."""
    plain, lines = drawn(folder, change.format(location=location))
    return plain, np.abs(lines - plain).max(2) > 0.05


def test_grease_pencil_is_drawn_over_the_picture(folder):
    plain, changed = grease_pencil(folder, (1, -1, 1))
    cube = plain[:, :, :3].mean(2) > 0.3
    assert 5 < changed.sum() < 0.5 * changed.size, changed.sum()
    assert (changed & cube).sum() > 5


def test_grease_pencil_is_hidden_by_what_is_before_it(folder):
    plain, changed = grease_pencil(folder, (-2.2, 2.1, -1.5))
    cube = plain[:, :, :3].mean(2) > 0.3
    for axis in (0, 1):  # its outline is smoothed by both
        cube &= np.roll(cube, 1, axis) & np.roll(cube, -1, axis)
    assert cube.sum() > 100 and not (changed & cube).any()


def test_instances_of_grease_pencil_are_drawn_too(folder):
    _, stroke = grease_pencil(folder, (1, -1, 1))
    _, instance = grease_pencil(folder, (1, -1, 1), INSTANCE)
    assert np.array_equal(stroke, instance)
