"""What the tests inside Blender share: scenes, pictures, and Blender as a process of its own."""

import contextlib
import ctypes
import importlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np

HERE = Path(__file__).parent
# How Blender prints what an engine reports.
ERROR = "Komorebi:" if bpy.app.version >= (5, 0, 0) else "Error: Komorebi:"
WARNING = "Komorebi:" if bpy.app.version >= (5, 0, 0) else "Warning: Komorebi:"
IS_MODULE = Path(sys.executable).stem.startswith("python") and not bpy.app.binary_path


class Skip(Exception):
    """The test cannot run here; the text says what is missing."""


def enable():
    import addon_utils  # the bpy module makes it known

    module = addon_utils.enable("komorebi")
    assert module is not None, "the add-on komorebi cannot be enabled"
    return module


def reads_image_files():
    """Whether the core's module for files of pictures loads: that needs the OpenImageIO that it was
    built with."""
    try:
        importlib.import_module("komorebi_core._image")
    except ImportError:
        return False
    return True


def fresh_scene(engine="KOMOREBI", size=(64, 48), samples=4):
    """Blender's own startup scene, small and quick to render."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, load_ui=False)
    scene = bpy.context.scene
    small(scene, engine, size, samples)
    return scene


def small(scene, engine="KOMOREBI", size=(64, 48), samples=4):
    scene.render.engine = engine
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.komorebi.samples = samples
    scene.komorebi.surface = "CLAY"  # what tests of other things have closed forms of
    scene.komorebi.bounces = 0  # light as formulas have it


@contextlib.contextmanager
def folder():
    path = Path(tempfile.mkdtemp(prefix="komorebi-test-"))
    try:
        yield path
    finally:
        shutil.rmtree(path, ignore_errors=True)


def render(folder, name="picture", scene=None):
    """Renders and saves a float EXR; its pixels [height, width, 4], row 0 at the bottom."""
    scene = scene or bpy.context.scene
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "32"
    settings.exr_codec = "NONE"
    path = folder / f"{name}.exr"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True, scene=scene.name)
    return read(path)


def read(path):
    """The linear pixels [height, width, 4] of a picture file, row 0 at the bottom."""
    image = bpy.data.images.load(str(path))
    try:
        width, height = image.size
        pixels = np.empty(width * height * 4, np.float32)
        image.pixels.foreach_get(pixels)
        return pixels.reshape(height, width, 4)
    finally:
        bpy.data.images.remove(image)


def render_layers(folder, name="layers"):
    """Renders into a multilayer EXR: its channels by name ("ViewLayer.Depth.Z"), row 0 at the
    bottom, and its metadata."""
    settings = bpy.context.scene.render.image_settings
    if hasattr(settings, "media_type"):  # from 5.0
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
    settings.exr_codec = "NONE"
    path = folder / f"{name}.exr"
    bpy.context.scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return read_layers(path)


def read_layers(path):
    """The channels of an EXR file by name, row 0 at the bottom, and its metadata."""
    python = HERE.parents[1] / "build" / "venv" / "test" / "bin" / "python"
    done = process([python, HERE / "read_exr.py", path])  # OpenEXR beside Blender's own may clash
    assert done.code == 0, done
    with np.load(path.with_suffix(".npz")) as arrays:
        channels = {name: arrays[name] for name in arrays.files}
    metadata = json.loads(path.with_suffix(".json").read_text())
    return channels, metadata


@contextlib.contextmanager
def captured(name):
    """Collects what the add-on hands to `module.function` ("driver.native_scene.build")."""
    module_name, function_name = name.rsplit(".", 1)
    module = importlib.import_module(f"komorebi.{module_name}")
    original = getattr(module, function_name)
    calls = []

    def wrapper(*args, **kwargs):
        result = original(*args, **kwargs)
        calls.append((args, result))
        return result

    setattr(module, function_name, wrapper)
    try:
        yield calls
    finally:
        setattr(module, function_name, original)


def exported():
    """The SceneData of the scene as a render sees it; nothing is rendered to the end."""
    with captured("driver.export_scene") as calls:
        bpy.context.scene.komorebi.samples = 1
        bpy.ops.render.render()
    assert calls, "the scene was not exported"
    return calls[-1][1]


def exported_whole():
    """What the open scene exports with an empty cache, so that all arrays are there."""
    from komorebi import cache, driver

    cache.clear()
    original, kept = driver.export_scene, []

    def export_scene(*args, **kwargs):
        data = original(*args, **kwargs)
        kept.append((data, list(data.meshes)))  # a render drops each as soon as the core has it
        return data

    driver.export_scene = export_scene
    try:
        bpy.ops.render.render()
    finally:
        driver.export_scene = original
    ((data, meshes),) = kept
    data.meshes[:] = meshes
    return data


def exported_picture(name):
    """The pass `name` of a render as it was handed to Blender [height, width, channels]."""
    from komorebi import passes

    enabled = passes.enabled_passes(bpy.context.scene, bpy.context.view_layer)
    channels = next(p.channels for p in enabled if p.name == name)
    with captured("compat.set_rect") as written:
        bpy.ops.render.render()
    return [pixels for (_, pixels), _ in written if pixels.shape[2] == channels][-1]


@contextlib.contextmanager
def warnings():
    """Collects the sentences of warnings."""
    from komorebi import reporting

    sentences, original = [], reporting.warn

    def warn(engine, sentence):
        sentences.append(sentence)
        original(engine, sentence)

    reporting.warn = warn
    try:
        yield sentences
    finally:
        reporting.warn = original


class Finished:
    """A process that ended: exit code, all it said, seconds it took."""

    def __init__(self, code, output, seconds):
        self.code, self.output, self.seconds = code, output, seconds

    def __repr__(self):
        return f"exit code {self.code} after {self.seconds:.1f} s\n{self.output}"


def process(arguments, timeout=120, **environment):
    """Runs a program in an environment with `environment` set (None: unset)."""
    full = {**os.environ, **{k: v for k, v in environment.items() if v is not None}}
    for key in (k for k, v in environment.items() if v is None):
        full.pop(key, None)
    start = time.monotonic()
    try:
        done = subprocess.run(
            [str(a) for a in arguments], env=full, timeout=timeout, check=False, text=True,
            errors="replace", stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )  # fmt: skip
    except subprocess.TimeoutExpired as error:
        said = (error.stdout or b"").decode(errors="replace")
        return Finished("timeout", said, time.monotonic() - start)
    return Finished(done.returncode, done.stdout, time.monotonic() - start)


def blender_render(file, output, frames="1", extra=(), **environment):
    """`blender -b FILE -E KOMOREBI -o OUTPUT -f FRAMES`, or the same through the bpy module."""
    if IS_MODULE:
        command = [sys.executable, HERE / "render_file.py", file, output, frames, *extra]
    else:
        command = [
            bpy.app.binary_path, "-b", "--factory-startup", file, "--addons", "komorebi",
            "-E", "KOMOREBI", "-o", output, *extra, "-f", frames,
        ]  # fmt: skip
    return process(command, **environment)


def script(text, folder, timeout=120, **environment):
    """Runs Python text in a Blender of its own, with the add-on switched on."""
    path = folder / "script.py"
    path.write_text(
        # Should it hang, it says where.
        f"import faulthandler; faulthandler.dump_traceback_later({timeout - 2})\n"
        f"import sys; sys.path.insert(0, {str(HERE)!r})\nimport support; support.enable()\n" + text
    )
    if IS_MODULE:
        return process([sys.executable, path], timeout, **environment)
    command = [
        bpy.app.binary_path,
        "-b",
        "--factory-startup",
        "--python-exit-code",
        "1",
        "-P",
        path,
    ]
    return process(command, timeout, **environment)


def save(folder, name="scene.blend"):
    """Saves the current file and answers its path."""
    path = folder / name
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True)
    return path


def pictures(folder):
    return sorted(p.name for p in folder.iterdir() if p.suffix in {".png", ".exr"})


def add_object(name, data, location=(0, 0, 0)):
    obj = bpy.data.objects.new(name, data)
    obj.location = location
    bpy.context.scene.collection.objects.link(obj)
    return obj


def spoil(camera):
    """Gives a camera object a lens that no picture can be taken with: the render says "focuses"."""
    camera.data.dof.use_dof, camera.data.dof.focus_distance = True, 0.0


def link_environment(image, world=None):
    """World with an Environment Texture of `image`; answers the texture node."""
    world = world or bpy.context.scene.world
    world.use_nodes = True
    tree = world.node_tree
    node = tree.nodes.new("ShaderNodeTexEnvironment")
    node.image = image
    background = next(n for n in tree.nodes if n.type == "BACKGROUND")
    tree.links.new(node.outputs["Color"], background.inputs["Color"])
    return node


def compositor_tree(scene):
    """The scene's compositing nodes, switched on."""
    if hasattr(scene, "compositing_node_group"):  # from 5.0 on
        scene.compositing_node_group = bpy.data.node_groups.new("Tree", "CompositorNodeTree")
        return scene.compositing_node_group
    scene.use_nodes = True
    return scene.node_tree


def resident_bytes():
    """Memory that this process holds (Linux), without what the allocators keep for later: the C
    library's and Blender's, which may be jemalloc (it keeps pages for ten seconds)."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).malloc_trim(0)
    with contextlib.suppress(OSError, AttributeError):
        jemalloc = ctypes.CDLL("libjemalloc.so.2", os.RTLD_NOLOAD | os.RTLD_NOW)
        jemalloc.mallctl(b"arena.4096.purge", None, None, None, ctypes.c_size_t(0))  # of all
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def slowness():
    """How much longer than promised a busy machine may take: 1 while every process has a core."""
    return max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1))
