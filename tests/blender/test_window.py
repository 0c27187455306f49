"""A final render in a window (under Xvfb): tiles appear as they finish, layers and blur are right.

test_render_window.py presses the keys.
"""

import re
import shutil

import bpy
import support
import x_screen

# Runs in a Blender with a window: starts a render and watches it.
WATCH = """
import bpy, sys, time
import komorebi.result
scene = bpy.context.scene
bpy.ops.mesh.primitive_monkey_add()
support.small(scene, size=(320, 240), samples={samples})
{prepare}
state = dict(shown=0, started=None)
write = komorebi.result.ResultWriter._write
def counted(self, session, tile, passes, combined=None):
    write(self, session, tile, passes, combined)
    state["shown"] += 1
    print("SHOWN", tile, len(passes), flush=True)
komorebi.result.ResultWriter._write = counted
def guarded():
    try:
        return step()
    except BaseException:
        import os, traceback
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(3)  # an exception in a timer does not end Blender
def step():
    window = bpy.context.window_manager.windows[0]
    if state["started"] is None:
        state["started"] = time.monotonic()
        with bpy.context.temp_override(window=window):
            bpy.ops.render.render("INVOKE_DEFAULT")
        return 0.05
    if bpy.app.is_job_running("RENDER"):
        return 0.01
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth = "OPEN_EXR", "32"
    bpy.data.images["Render Result"].save_render({picture!r})
    print("FRAME", scene.frame_current, scene.frame_subframe, flush=True)
    print("DONE", state["shown"], flush=True)
    bpy.ops.wm.quit_blender()
bpy.app.timers.register(guarded, first_interval=1.0, persistent=True)
"""


def screen(size="960x540x24", frame_buffer=None):
    """A display of its own; ends with the test. Its pixels are a file in `frame_buffer`, if given."""
    if shutil.which("Xvfb") is None:
        raise support.Skip("Xvfb is not installed")
    return x_screen.screen(size, frame_buffer)


def run(text, folder, size="960x540", timeout=120, **environment):
    """Runs Python text in a Blender with a window of 960 × 540 pixels at the bottom left of a screen
    of `size`, with the add-on on; what it said."""
    if support.IS_MODULE:
        raise support.Skip("Blender as a Python module has no window")
    path = folder / "watch.py"
    path.write_text(
        f"import sys; sys.path.insert(0, {str(support.HERE)!r})\nimport support; support.enable()\n"
        + text
    )
    with screen(f"{size}x24", folder) as display:
        done = support.process(
            [bpy.app.binary_path, "--factory-startup", "--no-window-focus", "-p", "0", "0", "960",
             "540", "--python-exit-code", "3", "-P", path],
            timeout=timeout, DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1",
            KOMOREBI_SCREEN=str(folder / "Xvfb_screen0"), **environment,
        )  # fmt: skip
    assert "DONE" in done.output, done
    return done


def watch(folder, samples, prepare=""):
    picture = folder / "picture.exr"
    done = run(WATCH.format(samples=samples, prepare=prepare, picture=str(picture)), folder)
    return done, support.read(picture)


def test_tiles_appear_while_the_frame_renders(folder):
    done, pixels = watch(folder, samples=512)
    shown = re.findall(r"SHOWN (\(.*\)) (\d)", done.output)
    assert len(shown) >= 3, done
    assert shown[-1][0] == "(0, 0, 320, 240)", done
    assert (pixels[:, :, 3] == 1).all()


MOTION = """
monkey = bpy.context.object
for frame, x in ((9, -3.0), (11, 3.0)):
    monkey.location.x = x
    monkey.keyframe_insert("location", frame=frame)
scene.frame_set(10)
scene.render.use_motion_blur, scene.render.film_transparent = True, True
bpy.data.objects["Cube"].hide_render = True
"""


def test_motion_blur_while_the_interface_lives(folder):
    done, pixels = watch(folder, samples=16, prepare=MOTION)
    assert "FRAME 10 0.0" in done.output, done
    partly = (pixels[:, :, 3] > 0.02) & (pixels[:, :, 3] < 0.98)
    assert partly.sum() > 500, "the monkey is blurred"


# Render Single Layer is heeded where a user presses F12, not on the command line.
SINGLE = """
import bpy
import komorebi.driver
scene = bpy.context.scene
support.small(scene)
scene.view_layers.new("Second")
original = komorebi.driver.export_scene
def export_scene(*arguments, **options):
    depsgraph = next(a for a in arguments if isinstance(a, bpy.types.Depsgraph))
    print("LAYER", single, depsgraph.view_layer.name, flush=True)
    return original(*arguments, **options)
komorebi.driver.export_scene = export_scene
single, started = False, 0
def step():
    global single, started
    if bpy.app.is_job_running("RENDER"):
        return 0.05
    window = bpy.context.window_manager.windows[0]
    if started == 2:
        print("DONE", flush=True)
        bpy.ops.wm.quit_blender()
        return None
    single = scene.render.use_single_layer = started == 1
    window.view_layer = scene.view_layers["Second"]
    started += 1
    with bpy.context.temp_override(window=window):
        bpy.ops.render.render("INVOKE_DEFAULT")
    return 0.5
bpy.app.timers.register(step, first_interval=1.0, persistent=True)
"""


def test_render_single_layer(folder):
    done = run(SINGLE, folder)
    layers = re.findall(r"LAYER (\w+) (\w+)", done.output)
    assert layers == [("False", "ViewLayer"), ("False", "Second"), ("True", "Second")], done
