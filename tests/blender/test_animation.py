"""Long animations: memory stays, and a script that renders picture by picture pays no more."""

import json

import support

FRAMES = 300
SETTLED = range(40, 100)  # by then every buffer has been there, and the allocator has its reserve

# A deforming mesh, instances of a collection, hair that is combed by the wave, and passes.
SCENE = """
import bpy, json, time
scene = support.fresh_scene(size=(32, 24), samples=1)
scene.render.use_persistent_data = {persistent}
scene.frame_end = {frames}
scene.render.image_settings.file_format = "PNG"
scene.render.filepath = {folder!r} + "/frame"
layer = scene.view_layers[0]
for name in ("z", "normal", "mist", "object_index", "cryptomatte_object"):
    setattr(layer, "use_pass_" + name, True)
bpy.ops.mesh.primitive_grid_add(x_subdivisions=60, y_subdivisions=60, size=4)
sea = bpy.context.object
wave = sea.modifiers.new("Wave", "WAVE")
wave.height, wave.time_offset, wave.speed = 0.3, -50, 0.1
sea.modifiers.new("Hair", "PARTICLE_SYSTEM")
hair = sea.particle_systems[0].settings
hair.type, hair.count, hair.hair_length, hair.display_step, hair.render_step = "HAIR", 50, 0.3, 2, 2
stock = bpy.data.collections.new("Stock")
stock.objects.link(bpy.data.objects["Cube"])
for k in range(100):
    copy = support.add_object("Copy", None, (k % 10 - 5, k // 10 - 5, -1))
    copy.instance_type, copy.instance_collection, copy.scale = "COLLECTION", stock, (0.2,) * 3
scene.camera.keyframe_insert("location", frame=1)
scene.camera.location.x += 1
scene.camera.keyframe_insert("location", frame={frames})
sizes, times = [], []
def note(*_):
    sizes.append(support.resident_bytes())
    times.append(time.process_time())
"""
ANIMATION = (
    SCENE
    + """
bpy.app.handlers.render_write.append(note)
bpy.ops.render.render(animation=True)
bpy.app.handlers.render_write.remove(note)  # a bpy module that has one left does not end
print("NOTED", json.dumps([sizes, times]))
"""
)
# As data sets are made: a moved camera, a render, files by the compositor.
DATA_SET = (
    SCENE
    + """
import compositing, pathlib
tree = support.compositor_tree(scene)
outputs = compositing.layers_node(tree).outputs
files = {{name: outputs[name] for name in ("Image", "Depth", "Normal")}}
compositing.file_output(tree, pathlib.Path({folder!r}), files)
scene.camera.animation_data_clear()
for frame in range(1, {frames} + 1):
    scene.frame_set(frame)
    scene.camera.location.x = 7 + 0.01 * frame
    bpy.ops.render.render()
    note()
print("NOTED", json.dumps([sizes, times]))
"""
)


def noted(script, folder, persistent):
    """Memory (bytes) and processor time (s) after each frame."""
    text = script.format(persistent=persistent, frames=FRAMES, folder=str(folder))
    done = support.script(text, folder, timeout=300, MALLOC_ARENA_MAX="1")
    assert done.code == 0 and "NOTED" in done.output, done
    said = next(k for k in done.output.splitlines() if k.startswith("NOTED "))
    return json.loads(said.removeprefix("NOTED "))


def grown(sizes):
    """By which share the memory grows in 200 frames; the least of sixty frames tells, since
    allocators keep some for later, now more and now less: 1 % up and down, over 2,400 frames too.
    """
    early, late = sizes[SETTLED.start : SETTLED.stop], sizes[-len(SETTLED) :]
    return (min(late) / min(early) - 1) * 200 / (FRAMES - SETTLED.stop)


def growing_cost(times):
    """How often the early frames' processor time a late frame takes."""
    part = len(SETTLED)
    return (times[-1] - times[-1 - part]) / (times[SETTLED.stop] - times[SETTLED.start])


def animation_and_data_set(persistent):
    costs = {}
    for name, script, files in (("animation", ANIMATION, 1), ("data set", DATA_SET, 3)):
        with support.folder() as folder:
            sizes, times = noted(script, folder, persistent)
            assert len(sizes) == FRAMES
            assert len(list(folder.glob("*0[0-9][0-9][0-9]*.*"))) == files * FRAMES
        assert grown(sizes) < 0.01, (name, [size >> 10 for size in sizes[::10]])
        assert growing_cost(times) < 3, (name, times[::10])
        costs[name] = times[-1] - times[SETTLED.start]
    # The data set has three files a frame where the animation has one.
    assert costs["data set"] < 4 * costs["animation"], costs


def test_memory_and_cost_stay_with_persistent_data():
    animation_and_data_set(persistent=True)


def test_memory_and_cost_stay_without_persistent_data():
    animation_and_data_set(persistent=False)
