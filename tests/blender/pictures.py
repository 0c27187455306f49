"""Pictures of Blender's window for the documents: a window under Xvfb, set up and read back.

    python pictures.py BLENDER USER_FOLDER OUTPUT_FOLDER [NAME...]

`./run pictures` calls it, with a Python that has Pillow. What is in each picture is a function of
picture_steps.py, which runs inside Blender; without NAMEs all are made.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import x_screen
from PIL import Image

HERE = Path(__file__).parent
SCENES = HERE.parents[1] / "blend_scenes"

# Name: the scene, the window's size (Blender's smallest is 640 × 480), and the file that comes of it.
PICTURES = {
    "viewport": ("demo", (1280, 800), "viewport.jpg"),
    "refines": ("demo", (960, 540), "viewport_refines.jpg"),
    "passes": ("demo", (960, 540), "viewport_passes.jpg"),
    "studio": ("demo", (960, 600), "viewport_studio.jpg"),
    "render": ("demo", (1280, 800), "render_window.jpg"),
    "turntable": ("demo", (640, 480), "turntable.webp"),
}
FRAME_MILLISECONDS = 90


def denoiser():
    """The library that denoises: KOMOREBI_OIDN, or that of the tests' Blender 4.5."""
    found = sorted(
        (HERE.parents[1] / "build" / "venv" / "bpy").glob(
            "lib/python*/site-packages/bpy/lib/libOpenImageDenoise.so*"
        )
    )
    named = os.environ.get("KOMOREBI_OIDN") or (str(found[0]) if found else "")
    return named or sys.exit("there is no Open Image Denoise: name a library by KOMOREBI_OIDN")


def take(blender, user, name, folder):
    """Runs Blender; the screens that it has read, in their order: uint8 [height, width, 3]."""
    scene, (width, height), _ = PICTURES[name]
    with x_screen.screen(f"{width}x{height}x24", folder) as display:
        log = folder / "log.txt"
        environment = {
            **os.environ, "DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1",
            "KOMOREBI_SCREEN": str(folder / "Xvfb_screen0"), "PYTHONDONTWRITEBYTECODE": "1",
            "KOMOREBI_OIDN": denoiser(),
            "BLENDER_USER_CONFIG": str(user / "config"),
            "BLENDER_USER_SCRIPTS": str(user / "scripts"),
            "BLENDER_USER_DATAFILES": str(user / "datafiles"),
        }  # fmt: skip
        with open(log, "w") as said:
            code = subprocess.run(
                [blender, "--factory-startup", "--no-window-focus", "-p", "0", "0", str(width),
                 str(height), "--python-exit-code", "3", SCENES / f"{scene}.blend", "--addons",
                 "komorebi", "-P", HERE / "picture_steps.py", "--", name, folder],
                env=environment, stdout=said, stderr=said, stdin=subprocess.DEVNULL, check=False,
            ).returncode  # fmt: skip
        if code != 0 or "DONE" not in log.read_text():
            sys.exit(f"{name}: Blender ended with code {code}:\n{log.read_text()[:6000]}")
    return [np.load(path) for path in sorted(folder.glob("screen_*.npy"))]


def bands(screens):
    """One picture of vertical bands, each of the next screen, with a thin line between."""
    width = screens[0].shape[1]
    whole = screens[-1].copy()
    for k, screen in enumerate(screens):
        first, end = width * k // len(screens), width * (k + 1) // len(screens)
        whole[:, first:end] = screen[:, first:end]
        if k > 0:
            whole[:, first - 1 : first + 1] = 255
    return whole


def mosaic(screens):
    """Two rows at half the size."""
    small = [
        np.asarray(Image.fromarray(s).resize((s.shape[1] // 2, s.shape[0] // 2), Image.LANCZOS))
        for s in screens
    ]
    half = len(small) // 2
    return np.vstack([np.hstack(small[:half]), np.hstack(small[half:])])


def write(path, name, screens):
    if path.suffix == ".webp":
        # The band in the middle is what was rendered, without its dashed border; smaller, it has less
        # noise.
        frames = [
            Image.fromarray(s[62:418, 4:-4]).resize((560, 316), Image.LANCZOS) for s in screens
        ]
        frames[0].save(
            path, save_all=True, append_images=frames[1:], duration=FRAME_MILLISECONDS, loop=0,
            quality=55, method=6,
        )  # fmt: skip
        return
    compose = {"refines": bands, "passes": mosaic}.get(name, lambda screens: screens[-1])
    Image.fromarray(compose(screens)).save(path, quality=90, optimize=True, progressive=True)


def main(blender, user, output, *names):
    for name in names or PICTURES:
        if name not in PICTURES:
            sys.exit(f"there is no picture {name}: {', '.join(PICTURES)}")
        path = Path(output) / PICTURES[name][2]
        with tempfile.TemporaryDirectory(prefix="komorebi-pictures-") as folder:
            write(path, name, take(blender, Path(user).resolve(), name, Path(folder)))
        print(f"{path}: {path.stat().st_size / 1000:.0f} kB", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
