"""Previews of materials, worlds and objects in a window (under Xvfb), beside Cycles' own."""

import test_window

PREVIEWS = """
import time
import bpy, numpy as np
import window_steps as w
bpy.context.preferences.view.show_splash = False
scene = bpy.context.scene

def previewed(thing, engine):
    "The icon that `engine` makes of something, [height, width, 4] from 0 to 1."
    global last
    scene.render.engine = engine
    before = pixels_of(thing)
    if before.any():  # another engine's, which may look the same
        preview = thing.preview_ensure()
        preview.image_pixels_float = np.zeros(before.size, np.float32)
        preview.is_image_custom = False
        before = pixels_of(thing)
    thing.asset_generate_preview()
    # 3.4 ends by a fault, whatever the engine, when a preview is asked for before the last one is
    # done, and cannot be asked: done is what has appeared and does not change any more.
    end, still = time.monotonic() + 90, 0
    while still < 10:
        yield 0.15
        assert time.monotonic() < end, "no preview"
        now = pixels_of(thing)
        has_come = now.any() and (before.shape != now.shape or not np.array_equal(before, now)
                                  or time.monotonic() > end - 80)
        still = still + 1 if has_come and np.array_equal(last, now) else 0
        last = now
    shown[engine] = now

def pixels_of(thing):
    preview = thing.preview_ensure()
    return np.array(preview.image_pixels_float[:], np.float32).reshape(
        preview.image_size[1], preview.image_size[0], 4)

shown, last = {}, None

def colored(name, color):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*color, 1.0)
    material.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    material.use_fake_user = True
    return material

def expect_alike(within):
    ours, theirs = shown["KOMOREBI"], shown["CYCLES"]
    assert ours.shape == theirs.shape and ours.shape[0] >= 128, (ours.shape, theirs.shape)
    assert np.ptp(ours[..., :3]) > 0.2, "an even picture"
    blocks = [p[:128, :128].reshape(8, 16, 8, 16, 4).mean(axis=(1, 3)) for p in (ours, theirs)]
    off = np.abs(blocks[0] - blocks[1])
    assert np.median(off) < within and off.mean() < 2 * within, (np.median(off), off.mean())
"""


def run(folder, steps):
    text = PREVIEWS + "\ndef steps():\n" + steps + "\nw.start(steps())\n"
    return test_window.run(text, folder)


def test_materials_have_previews(folder):
    done = run(folder, """
    yield 0.5
    material, other = colored("Red", (0.8, 0.1, 0.05)), colored("Broken", (0.0, 0.0, 0.0))
    broken = bpy.data.images.new("Nowhere", 4, 4)
    broken.source, broken.filepath = "FILE", "//nowhere.png"
    texture = other.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = broken
    diffuse = next(n for n in other.node_tree.nodes if n.type == "BSDF_DIFFUSE")
    other.node_tree.links.new(texture.outputs[0], diffuse.inputs["Color"])
    for engine in ("CYCLES", "KOMOREBI"):
        yield from previewed(material, engine)
    expect_alike(0.02)
    middle = shown["KOMOREBI"][48:80, 48:80, :3].mean(axis=(0, 1))
    assert middle[0] > 1.5 * middle[1], middle
    yield from previewed(other, "KOMOREBI")
    assert np.ptp(shown["KOMOREBI"][..., :3]) > 0.2
""")  # fmt: skip
    assert "Komorebi:" not in done.output, done  # previews warn of nothing


def test_lights_have_previews(folder):
    """The floor that they shine on is glossy in Cycles."""
    run(folder, """
    yield 0.5
    for kind, energy in (("POINT", 3.0), ("SUN", 3.0), ("AREA", 3.0), ("SPOT", 10.0)):
        light = bpy.data.lights.new(kind, kind)
        light.energy, light.use_fake_user = energy, True
        for engine in ("CYCLES", "KOMOREBI"):
            yield from previewed(light, engine)

        expect_alike(0.04)
""")  # fmt: skip


def test_what_no_engine_renders_is_the_same_as_with_cycles(folder):
    """Blender itself draws textures, brushes, objects, collections, pictures and actions."""
    run(folder, """
    yield 0.5
    from komorebi.engine import KomorebiRenderEngine as Engine
    updates, update = [], Engine.update
    Engine.update = lambda self, *arguments: (updates.append(1), update(self, *arguments))
    texture = bpy.data.textures.new("Clouds", "CLOUDS")
    brush = bpy.data.brushes.new("Brush", mode="TEXTURE_PAINT")
    image = bpy.data.images.new("Grid", 64, 64)
    image.generated_type = "COLOR_GRID"
    bpy.ops.mesh.primitive_monkey_add()
    monkey = bpy.context.object
    collection = bpy.data.collections.new("Collection")
    scene.collection.children.link(collection)
    collection.objects.link(monkey)
    for thing in (texture, brush, image, monkey, collection):
        thing.use_fake_user = True
        for engine in ("CYCLES", "KOMOREBI"):
            yield from previewed(thing, engine)
        assert np.array_equal(shown["CYCLES"], shown["KOMOREBI"]), thing
        assert np.ptp(shown["KOMOREBI"]) > 0.1 or thing == brush, thing
    assert not updates
""")  # fmt: skip


def test_worlds_have_previews(folder):
    run(folder, """
    yield 0.5
    world = scene.world
    world.use_nodes = True
    tree = world.node_tree
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(
        coordinates.outputs["Generated"], tree.nodes["Background"].inputs["Color"]
    )
    for engine in ("CYCLES", "KOMOREBI"):
        yield from previewed(world, engine)
    expect_alike(0.02)
""")  # fmt: skip
