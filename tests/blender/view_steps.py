"""What windows show of rendered 3D views, held against final renders of the same views.

Used inside a Blender with a window, as window_steps.py is. Nothing here asks the viewports: what
counts is the screen, and who says what should be on it is the final render.
"""

import os
import struct

import bpy
import numpy as np
import window_steps as w
from mathutils import Matrix

EDGE = 4  # pixels over which Blender draws lines of frames and round corners of areas
SEED = 5  # of the viewports; final renders of other seeds tell how much noise there is


def prepare():
    """A scene with something in every part of a view, that is soon rendered."""
    bpy.context.preferences.view.show_splash = False
    scene = bpy.context.scene
    bpy.ops.mesh.primitive_monkey_add(location=(0, 0, 2))
    bpy.ops.mesh.primitive_plane_add(size=10, location=(0, 0, -1))
    settings_of(scene)
    return scene


def settings_of(scene):
    scene.render.engine = "KOMOREBI"
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_percentage = 100
    scene.world.light_settings.distance = 6.0
    komorebi = scene.komorebi
    komorebi.seed = SEED
    komorebi.preview_samples = komorebi.samples = 4
    komorebi.light_samples = 2
    if hasattr(komorebi, "use_preview_denoising"):
        komorebi.use_preview_denoising = False


def views():
    """Of every 3D view of all windows what to override the context by, and its region_3d."""
    found = []
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type != "VIEW_3D":
                continue
            space = area.spaces.active
            regions = [r for r in area.regions if r.type == "WINDOW" and r.width > 1]
            views_3d = list(space.region_quadviews) or [space.region_3d]
            for region, view in zip(regions, views_3d, strict=True):
                found.append({"window": window, "area": area, "region": region, "view": view})
    return found


def override(view):
    """The part of one of views() that temp_override takes."""
    return {k: view[k] for k in ("window", "area", "region")}


def bare(space):
    """Nothing over the picture."""
    space.overlay.show_overlays = False
    space.show_gizmo = False
    space.show_region_header = space.show_region_tool_header = False
    space.show_region_toolbar = space.show_region_ui = False


def display():
    """All windows, as they lie on the display: [height, width, 3] from 0 to 1, row 0 at the bottom.

    The file is in the X window dump's form, whose numbers are big-endian."""
    with open(os.environ["KOMOREBI_SCREEN"], "rb") as file:
        data = file.read()
    width, height = struct.unpack(">II", data[16:24])
    pixels = np.frombuffer(data[-4 * width * height :], np.uint8).reshape(height, width, 4)
    return pixels[::-1, :, 2::-1].astype(np.float32) / 255


def shown(view):
    """What is on the screen of one of views(), in scene linear colours that were cut at 1."""
    window, region = view["window"], view["region"]
    screen = display()
    # Blender counts a window's y from the bottom of the display.
    x, y = window.x + region.x, window.y + region.y
    cut = screen[y : y + region.height, x : x + region.width]
    assert cut.shape == (region.height, region.width, 3), (cut.shape, window.x, window.y)
    return np.where(cut < 0.04045, cut / 12.92, ((cut + 0.055) / 1.055) ** 2.4)


def final(scene, camera, width, height, seed=SEED):
    """The final render by a camera [height, width, 3], as a screen can show it."""
    before = scene.camera, scene.render.resolution_x, scene.render.resolution_y
    scene.camera, scene.komorebi.seed = camera, seed
    scene.render.resolution_x, scene.render.resolution_y = width, height
    try:
        bpy.ops.render.render(scene=scene.name)
        settings = scene.render.image_settings
        settings.file_format, settings.color_depth = "OPEN_EXR", "32"
        path = os.path.join(os.path.dirname(os.environ["KOMOREBI_SCREEN"]), "final.exr")
        bpy.data.images["Render Result"].save_render(path, scene=scene)
    finally:
        scene.komorebi.seed = SEED
        scene.camera, scene.render.resolution_x, scene.render.resolution_y = before
    image = bpy.data.images.load(path)
    pixels = np.array(image.pixels[:], np.float32).reshape(image.size[1], image.size[0], -1)
    bpy.data.images.remove(image)
    return np.clip(pixels[:, :, :3], 0, 1)


def camera_along(view):
    """A new camera that sees what a free view shows."""
    scene, space, view_3d = view["window"].scene, view["area"].spaces.active, view["view"]
    camera = bpy.data.objects.new("Looks along", bpy.data.cameras.new("Looks along"))
    scene.collection.objects.link(camera)
    camera.matrix_world = view_3d.view_matrix.inverted()
    data = camera.data
    if view_3d.is_perspective:
        # A viewport shows twice as much as a camera with its lens.
        data.lens, data.sensor_width = space.lens, 72.0
        data.clip_start, data.clip_end = space.clip_start, space.clip_end
    else:
        region = view["region"]
        data.type = "ORTHO"
        side = 0 if region.width >= region.height else 1
        data.ortho_scale = 2.0 / view_3d.window_matrix[side][side]
        camera.matrix_world = camera.matrix_world @ Matrix.Translation((0, 0, 200))
        data.clip_start, data.clip_end = 1.0, 1000.0
    return camera


def compare(picture, finals, name, least=0.02):
    """Means of 8 × 8 pixels against those of two final renders of different seeds, whose difference
    tells the noise: their z. `least`: how much there must be to be seen."""
    assert picture.shape == finals[0].shape, (name, picture.shape, finals[0].shape)
    inner = np.s_[EDGE:-EDGE, EDGE:-EDGE]
    picture, finals = picture[inner], [f[inner] for f in finals]
    size = 8
    rows, columns = picture.shape[0] // size, picture.shape[1] // size

    def means(pixels):
        whole = pixels[: rows * size, : columns * size].mean(axis=2)
        return whole.reshape(rows, size, columns, size).mean(axis=(1, 3))

    noise = ((finals[0] - finals[1]) ** 2).mean(axis=2) / 2
    # A screen's 8 bits are an error of their own, and an edge need not be noise to be uncertain.
    error = np.sqrt(means(np.repeat(noise[:, :, None], 3, axis=2)) * 1.5 / size**2) + 0.004
    expected = (means(finals[0]) + means(finals[1])) / 2
    z = (means(picture) - expected) / error
    far = (np.abs(z) > 4).mean()
    mean = abs(picture.mean() - (finals[0].mean() + finals[1].mean()) / 2)
    contrast = expected.std()
    print(f"COMPARED {name}: {far:.4f} of {z.size} blocks are far off, mean {mean:.5f}, "
          f"contrast {contrast:.3f}", flush=True)  # fmt: skip
    if far > 0.01 or mean > 0.004:
        keep(name, picture, finals[0])
    assert contrast >= least, f"{name}: there is nothing to be seen"
    assert far <= 0.01 and mean <= 0.004, f"{name}: z {np.percentile(z, (0, 1, 50, 99, 100))}"


def keep(name, picture, expected):
    """Both side by side, for whoever looks for what is wrong (KOMOREBI_KEEP names the folder)."""
    folder = os.environ.get("KOMOREBI_KEEP")
    if folder:
        np.save(os.path.join(folder, name + ".npy"), np.hstack([picture, expected]))


def expect_final_of(view, name, contrast=0.02):
    """A free view shows what a camera in its place renders."""
    region, scene = view["region"], view["window"].scene
    camera = camera_along(view)
    try:
        finals = [final(scene, camera, region.width, region.height, s) for s in (SEED, SEED + 1)]
    finally:
        data = camera.data
        bpy.data.objects.remove(camera)
        bpy.data.cameras.remove(data)
    yield from w.finished()
    compare(shown(view), finals, name, contrast)


def expect_all(name):
    """The same for every view there is; how many."""
    yield from w.finished()
    number = len(views())
    for index in range(number):
        yield from expect_final_of(views()[index], f"{name}-{index}")
    return number


def threads():
    """All of this process: Blender's, the interpreter's and the core's."""
    return len(os.listdir("/proc/self/task"))


def frame(view):
    """Where the frame of a view's camera lies in its region, in whole pixels: x, y, width, height."""
    from bpy_extras.view3d_utils import location_3d_to_region_2d

    camera = view["window"].scene.camera
    corners = camera.data.view_frame(scene=view["window"].scene)
    matrix = camera.matrix_world.normalized()
    places = [location_3d_to_region_2d(view["region"], view["view"], matrix @ c) for c in corners]
    x, y = min(p.x for p in places), min(p.y for p in places)
    sizes = max(p.x for p in places) - x, max(p.y for p in places) - y
    numbers = [x, y, *sizes]
    print("FRAME", numbers, flush=True)
    assert np.abs(np.array(numbers) - np.round(numbers)).max() < 0.02, numbers
    return [round(n) for n in numbers]


def expect_camera(name):
    """The view through the scene's camera shows its final render, within its frame and border."""
    view = views()[0]
    scene = view["window"].scene
    with w.override(override(view)):
        bpy.ops.view3d.view_center_camera()
        bpy.ops.view3d.zoom_camera_1_to_1()
    yield 0.1
    yield from w.finished()
    width, height = scene.render.resolution_x, scene.render.resolution_y
    finals = [final(scene, scene.camera, width, height, seed) for seed in (SEED, SEED + 1)]
    yield from w.finished()
    x, y, *size = frame(view)
    assert size == [width, height], (size, width, height)
    picture = shown(view)[y : y + height, x : x + width]
    if scene.render.use_border:
        part = finals[0].any(axis=2)  # a render leaves out what lies outside
        rows, columns = np.flatnonzero(part.any(axis=1)), np.flatnonzero(part.any(axis=0))
        inside = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        picture, finals = picture[inside], [f[inside] for f in finals]
    compare(picture, finals, name)
