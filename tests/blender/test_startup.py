"""F12 on the untouched startup scene: a cube that one can tell from its background."""

import bpy
import numpy as np
import support


def cube_and_background(folder, method):
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 1920, 1080
    scene.render.resolution_percentage = 5
    scene.komorebi.method = method
    pixels = support.render(folder, method)
    assert pixels.shape == (54, 96, 4)
    assert np.isfinite(pixels).all()
    return pixels[27, 48, :3], pixels[2, 2, :3]


def difference_on_screen(folder, method):
    """Difference of cube and background in 8-bit steps of the saved PNG, view transform and all."""
    scene = bpy.context.scene
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_depth = "8"
    path = folder / f"{method}.png"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(path))
    width, height = image.size
    pixels = np.array(image.pixels[:]).reshape(height, width, 4)
    return abs(pixels[27, 48, 1] - pixels[2, 2, 1]) * 255


def test_ambient_occlusion(folder):
    cube, background = cube_and_background(folder, "AMBIENT_OCCLUSION")
    assert np.allclose(cube, 1.0, atol=1e-5), cube  # nothing shades a cube by itself
    assert np.allclose(background, 0.0509, atol=1e-3), background
    assert difference_on_screen(folder, "AMBIENT_OCCLUSION") > 40


def test_world_light(folder):
    lit, background = cube_and_background(folder, "WORLD_LIGHT")
    assert (lit > background).all(), (lit, background)  # the scene's lamp
    bpy.data.objects.remove(bpy.data.objects["Light"])
    cube = support.render(folder, "dark")[27, 48, :3]
    assert np.allclose(cube, 0.8 * background, rtol=1e-3), (cube, background)
    assert difference_on_screen(folder, "WORLD_LIGHT") > 4
