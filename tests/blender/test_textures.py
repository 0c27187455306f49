"""Pictures of Image Texture nodes beside Cycles, pixel by pixel, and what becomes of bad ones."""

import struct
from pathlib import Path

import bpy
import komorebi_core as core
import numpy as np
import support
import textures
from komorebi import native_texture
from komorebi.export.exr import chromaticities
from komorebi.export.texture import export_texture, numbered, sequence_frame

INTERPOLATIONS = ("Closest", "Linear", "Cubic", "Smart")


def pixels_of(width, height, seed=1, alpha=True):
    values = np.random.default_rng(seed).random((height, width, 4)).astype(np.float32)
    values[0, :, 3] = 0.0
    values[-1, :, 3] = 1.0
    if not alpha:
        values[:, :, 3] = 1.0
    return values


def picture(name="picture", width=7, height=5, is_float=False, alpha=True, seed=1, space=None):
    """A generated image of random pixels."""
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=is_float)
    if space:
        image.colorspace_settings.name = space
    pixels = pixels_of(width, height, seed, alpha)
    if is_float:  # weighed by alpha
        pixels[:, :, :3] *= pixels[:, :, 3:]
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    return image


def saved(folder, name, file_format="PNG", depth="8", mode="RGBA", space=None, **more):
    """A random picture as a file that is loaded anew; its numbers are what the file has."""
    image = picture(name, is_float=depth != "8", space="Non-Color", **more)
    scene = bpy.data.scenes.new("for saving")
    settings = scene.render.image_settings
    settings.file_format = file_format
    settings.color_mode = mode
    settings.color_depth = depth
    scene.view_settings.view_transform = "Raw"
    ending = {"PNG": "png", "OPEN_EXR": "exr", "TIFF": "tif", "JPEG": "jpg", "HDR": "hdr"}
    path = folder / f"{name}.{ending[file_format]}"
    image.save_render(str(path), scene=scene)
    bpy.data.scenes.remove(scene)
    bpy.data.images.remove(image)
    image = bpy.data.images.load(str(path))
    if space:
        image.colorspace_settings.name = space
    return image


def spaces(*names):
    known = bpy.types.ColorManagedInputColorspaceSettings.bl_rna.properties["name"]
    return [name for name in names if name in set(known.enum_items.keys())]


def test_interpolations_and_extensions():
    with support.folder() as folder:
        scene, node = textures.plate()
        extensions = type(node).bl_rna.properties["extension"].enum_items.keys()
        for node.image in (saved(folder, "bytes"), saved(folder, "floats", "OPEN_EXR", "32")):
            for node.interpolation in INTERPOLATIONS:
                for node.extension in extensions:
                    textures.compare(scene, node, "COLOR", folder, 0.97)


def test_alpha_modes_and_spaces():
    with support.folder() as folder:
        scene, node = textures.plate()
        node.interpolation, node.extension = "Linear", "CLIP"
        names = spaces(
            "sRGB", "Non-Color", "Linear", "Linear Rec.709", "Linear ACEScg", "ACEScg", "XYZ",
            "Linear Rec.2020", "Display P3", "Linear CIE-XYZ E",
        )  # fmt: skip
        for make in (
            lambda: saved(folder, "png"),
            lambda: saved(folder, "png16", depth="16"),
            lambda: saved(folder, "exr", "OPEN_EXR", "32"),
        ):
            node.image = make()
            for name in names:
                node.image.colorspace_settings.name = name
                for node.image.alpha_mode in ("STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"):
                    if (name, node.image.alpha_mode) == ("Display P3", "CHANNEL_PACKED"):
                        continue  # some of Cycles' halves become huge there
                    for what in ("COLOR", "BOTH"):
                        textures.compare(scene, node, what, folder)
        node.image.alpha_mode = "STRAIGHT"
        textures.compare(scene, node, "ALPHA", folder)


def test_kinds_of_files():
    with support.folder() as folder:
        scene, node = textures.plate()
        for image in (
            saved(folder, "grey", mode="BW"),
            saved(folder, "grey16", depth="16", mode="BW"),
            saved(folder, "rgb", mode="RGB"),
            saved(folder, "half", "OPEN_EXR", "16"),
            saved(folder, "tiff", "TIFF"),
            saved(folder, "tiff16", "TIFF", "16"),
            saved(folder, "jpeg", "JPEG", mode="RGB"),
            saved(folder, "light", "HDR", "32", mode="RGB"),
        ):
            node.image = image
            for what in ("COLOR", "BOTH", "ALPHA"):
                textures.compare(scene, node, what, folder)


def test_packed_and_generated():
    with support.folder() as folder:
        scene, node = textures.plate()
        node.extension = "EXTEND"
        packed = [
            saved(folder, "a"), saved(folder, "b", depth="16"), saved(folder, "c", "OPEN_EXR", "32"),
            saved(folder, "d", mode="BW"), saved(folder, "e", "JPEG", mode="RGB"),
        ]  # fmt: skip
        for image in packed:
            image.pack()
        made = [picture("f"), picture("g", is_float=True), picture("h", space="Non-Color")]
        for image in [*packed, *made]:
            node.image = image
            for image.alpha_mode in ("STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"):
                for what in ("COLOR", "BOTH"):
                    textures.compare(scene, node, what, folder)


def test_tiles():
    with support.folder() as folder:
        scene, node = textures.plate()
        for tile, seed in ((1001, 1), (1002, 2), (1011, 3)):
            saved(folder, f"udim.{tile}", seed=seed)
        node.image = bpy.data.images.load(str(folder / "udim.1001.png"))
        node.image.source = "TILED"
        node.image.filepath = str(folder / "udim.<UDIM>.png")
        for tile in (1002, 1011, 1012):
            if tile not in [t.number for t in node.image.tiles]:
                node.image.tiles.new(tile_number=tile)
        warnings = []
        for node.extension in ("REPEAT", "EXTEND"):
            textures.compare(scene, node, "COLOR", folder, warnings=warnings)
        assert any("udim.1012.png is missing" in w for w in warnings), warnings
        # magenta where there is no tile
        values = textures.ours(node, "COLOR").reshape(textures.SIZE, textures.SIZE, 3)
        assert np.allclose(values[-1, -1], (1, 0, 1))


def test_sequences():
    with support.folder() as folder:
        scene, node = textures.plate()
        for number in (1, 2, 3):
            saved(folder, f"shot_{number:04d}", seed=number)
        node.image = bpy.data.images.load(str(folder / "shot_0001.png"))
        node.image.source = "SEQUENCE"
        user = node.image_user
        user.frame_duration, user.frame_start = 3, 1
        for user.use_cyclic, user.frame_offset, frames in (
            (False, 0, (1, 2, 3, 7)), (True, 0, (1, 4, 5, 0)), (False, 1, (1, 2)),
        ):  # fmt: skip
            for frame in frames:
                scene.frame_set(frame)
                textures.compare(scene, node, "COLOR", folder)
        scene.frame_set(9)
        user.frame_duration, user.use_cyclic, user.frame_offset = 9, False, 0
        warnings = []
        textures.compare(scene, node, "COLOR", folder, warnings=warnings)
        assert "shot_0009.png is missing" in warnings[0], warnings
    assert sequence_frame(user, 3) == 3
    assert numbered("/a1/b2_003x.png", -4) == "/a1/b2_-004x.png"
    assert numbered("/a1/none.png", 4) == "/a1/none.png"


def test_films():
    with support.folder() as folder:
        scene, node = textures.plate()
        node.interpolation = "Closest"
        for number in (1, 2, 3):
            saved(folder, f"shot_{number:04d}", seed=number)
        node.image = bpy.data.images.load(str(folder / "shot_0001.png"))
        node.image.source = "SEQUENCE"
        node.image_user.frame_duration = 3
        node.image_user.use_auto_refresh = True
        textures.show(node, "COLOR")
        settings = scene.render.image_settings
        before = settings.file_format
        if hasattr(settings, "media_type"):
            settings.media_type = "VIDEO"
        settings.file_format = "FFMPEG"
        scene.render.ffmpeg.format, scene.render.ffmpeg.codec = "AVI", "PNG"
        scene.render.use_file_extension = False
        scene.render.filepath = str(folder / "film.avi")
        scene.frame_start, scene.frame_end = 1, 3
        bpy.ops.render.render(animation=True)
        if hasattr(settings, "media_type"):
            settings.media_type = "IMAGE"
        settings.file_format = before
        film = bpy.data.images.load(str(folder / "film.avi"))
        assert film.source == "MOVIE" and film.frame_duration == 3
        node.image = film
        user, seen, warnings = node.image_user, {}, []
        for user.use_cyclic, user.frame_offset, frames in (
            (False, 0, (1, 2, 3, 7, 2)), (True, 0, (4, 5)), (False, 1, (1, 2)),
        ):  # fmt: skip
            user.frame_duration = 3
            for frame in frames:
                scene.frame_set(frame)
                textures.compare(scene, node, "COLOR", folder, warnings=warnings)
                seen.setdefault(frame, textures.ours(node, "COLOR"))
        assert not warnings and not np.allclose(seen[2], seen[7])
        assert not bpy.data.textures.keys()
        (folder / "film.avi").write_bytes(b"no film")
        node.image = bpy.data.images.load(str(folder / "film.avi"))
        node.image.source = "MOVIE"
        assert np.allclose(textures.ours(node, "COLOR", warnings), (1, 0, 1))
        assert "film" in warnings[0] and "magenta" in warnings[0], warnings


def test_primaries_of_files():
    with support.folder() as folder:
        image = saved(folder, "wide", "OPEN_EXR", "32")
        path = folder / "wide.exr"
        data = path.read_bytes()
        warnings = []
        export_texture(image, None, 1, warnings.append)
        assert not warnings
        aces = struct.pack("<8f", 0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767)
        name = b"chromaticities\0"
        at = data.find(name)
        if at >= 0:
            at += 2 * len(name) + 4
            data = data[:at] + aces + data[at + 32 :]
        else:
            data = data[:8] + 2 * name + struct.pack("<i", 32) + aces + data[8:]
        path.write_bytes(data)
        assert chromaticities(data)[0] == np.float32(0.713)
        for cut in range(0, 400, 7):
            chromaticities(data[:cut])
        image.colorspace_settings.name = spaces("Linear", "Linear Rec.709")[0]
        export_texture(image, None, 1, warnings.append)
        assert "wide.exr has other primaries" in warnings[0], warnings
        image.colorspace_settings.name = "Non-Color"
        warnings.clear()
        export_texture(image, None, 1, warnings.append)
        assert not warnings


def test_missing_and_broken():
    with support.folder() as folder:
        scene, node = textures.plate()
        whole = saved(folder, "cut", depth="16", width=300, height=200)
        path = folder / "cut.png"
        path.write_bytes(path.read_bytes()[:20000])
        node.image = whole
        warnings = []
        values = textures.ours(node, "COLOR", warnings)
        assert np.allclose(values, (1, 0, 1)) and "cut.png" in warnings[0], warnings
        path.unlink()
        warnings.clear()
        textures.compare(scene, node, "COLOR", folder, warnings=warnings)
        assert "cut.png is missing, rendered in magenta" in warnings[0], warnings
        node.image = None
        textures.compare(scene, node, "COLOR", folder)
        node.image = picture("agx")
        odd = spaces("Filmic Log", "AgX Log")[0]
        node.image.colorspace_settings.name = odd
        warnings.clear()
        export_texture(node.image, node.image_user, 1, warnings.append)
        assert odd in warnings[0], warnings


def test_files_cut_short():
    with support.folder() as folder:
        _, node = textures.plate()
        for name, *kind in (("a", "PNG", "8"), ("b", "OPEN_EXR", "16"), ("c", "HDR", "32")):
            mode = "RGB" if name == "c" else "RGBA"
            node.image = saved(folder, name, *kind, width=70, height=50, mode=mode)
            path = Path(node.image.filepath)
            whole = path.read_bytes()
            for size in (0, 3, 60, 400, len(whole) // 2):
                path.write_bytes(whole[:size])
                warnings = []
                assert np.allclose(textures.ours(node, "COLOR", warnings), (1, 0, 1)), (name, size)
                assert path.name in warnings[0] and "magenta" in warnings[0], warnings
                try:
                    core.Environment.from_file(str(path))
                except RuntimeError as error:
                    assert path.name in str(error)
                else:
                    raise AssertionError(f"{path.name} of {size} bytes must not pass")


def test_limit_and_cache():
    from komorebi import cache

    big, small = picture("big", 256, 256), picture("small", 64, 64)
    images = [export_texture(i, None, 1, print) for i in (big, small)]
    cache.clear()
    warnings = []
    free = native_texture.load(core, images, 1 << 30, 1, warnings.append)
    assert not warnings and free[images[0].key].width == 256
    again = native_texture.load(core, images, 1 << 30, 1, warnings.append)
    assert again[images[0].key] is free[images[0].key]
    tight = native_texture.load(core, images, 1 << 17, 1, warnings.append)
    assert tight[images[0].key].width == 128 and tight[images[1].key].width == 64
    assert '"big"' in warnings[0] and "1/2 of its width" in warnings[0], warnings
    assert sum(t.byte_count for t in tight.values()) <= 1 << 17
