"""Each tab of the properties editor in a window (under Xvfb): no panel raises, none is empty.

With the environment variable KOMOREBI_KEEP naming a folder, a picture of each tab is kept there.
"""

import os
import re
import threading
import time
from pathlib import Path

import bpy
import numpy as np
import support
from test_window import screen

WIDTH, HEIGHT = 800, 1500
# What Blender prints when a panel raises or names a property, an operator or an icon that is not.
WRONG = re.compile(r"Traceback|Error|not found|unknown (?:icon|operator)|rna_ui", re.IGNORECASE)
NOISE = re.compile(
    r"EGL|libEGL|MESA|XOpenIM|ALSA|mounted file-systems|GHOST|WAYLAND", re.IGNORECASE
)


def frame(folder):
    """The screen [height, width, 3] as bytes, top row first."""
    raw = (folder / "Xvfb_screen0").read_bytes()[-WIDTH * HEIGHT * 4 :]
    return np.frombuffer(raw, np.uint8).reshape(HEIGHT, WIDTH, 4)[:, :, 2::-1]


def keep(pixels, name):
    target = os.environ.get("KOMOREBI_KEEP")
    if not target:
        return
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height)
    rgba = np.ones((height, width, 4), np.float32)
    rgba[:, :, :3] = pixels[::-1] / 255
    image.pixels.foreach_set(rgba.reshape(-1))
    image.filepath_raw, image.file_format = str(Path(target) / f"{name}.png"), "PNG"
    image.save()
    bpy.data.images.remove(image)


def watch(folder, pictures, ended):
    """Takes what each tab shows, and lets the script go on."""
    mark = folder / "shown"
    while not ended.is_set():
        if mark.exists() and (text := mark.read_text()):
            name, *place = text.split()
            x, y, width, height = map(int, place)
            top = HEIGHT - y - height
            pictures[name] = frame(folder)[top : top + height, x : x + width].copy()
            mark.unlink()
        time.sleep(0.02)


def test_every_tab_is_drawn(folder):
    if support.IS_MODULE:
        raise support.Skip("Blender as a Python module has no window")
    pictures, ended = {}, threading.Event()
    with screen(f"{WIDTH}x{HEIGHT}x24", folder) as display:
        watcher = threading.Thread(target=watch, args=(folder, pictures, ended))
        watcher.start()
        try:
            done = support.process(
                [bpy.app.binary_path, "--factory-startup", "--no-window-focus", "-p", "0", "0",
                 str(WIDTH), str(HEIGHT), "--python-exit-code", "3", "-P",
                 support.HERE / "properties_tabs.py", "--", folder],
                timeout=240, DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1",
            )  # fmt: skip
        finally:
            ended.set()
            watcher.join()
    for name, pixels in pictures.items():
        keep(pixels, name)
    assert "DONE" in done.output, done
    wrong = [k for k in done.output.splitlines() if WRONG.search(k) and not NOISE.search(k)]
    assert not wrong, done
    assert len(pictures) == int(re.search(r"DONE (\d+)", done.output)[1]), list(pictures)
    for name, pixels in pictures.items():
        # Words are brighter than anything else below the editor's header and path, beside its tabs.
        words = (pixels[65:, 60:].min(2) > 150).sum()
        assert words > 100, f"{name} is empty: {words} bright pixels"
