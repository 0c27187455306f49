"""Rebuild the scenes of this folder.

    blender -b --factory-startup -P blend_scenes/build.py -- [NAME ...]

Every scene is made from nothing, so that its .blend file is a product, not a source. Files are
written by the oldest release that Komorebi supports (3.4); a later one would write files that the
oldest cannot open.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bounces
import cameras
import closed_forms
import deforming
import demo
import features
import instancing
import materials
import motion
import settings
import strands
import visibility
from common import save

SCENES: dict[str, Callable[[], None]] = {
    "demo": demo.build,
    **closed_forms.SCENES,
    **features.SCENES,
    **settings.SCENES,
    **visibility.SCENES,
    **strands.SCENES,
    **cameras.SCENES,
    **bounces.SCENES,
    **materials.SCENES,
    **instancing.SCENES,
    **deforming.SCENES,
    **motion.SCENES,
}


def main(names: list[str]) -> None:
    """Build the named scenes, or all; end with an error for a name that is not known."""
    unknown = sorted(set(names) - set(SCENES))
    if unknown:
        sys.exit(
            f"build.py: no scene is called {', '.join(unknown)}; there are {', '.join(SCENES)}"
        )
    if bpy.app.version >= (3, 5):
        sys.exit("build.py: run it with Blender 3.4, so that every release can open what it writes")
    for name in names or SCENES:
        SCENES[name]()
        path = save(name)
        print(f"{path.name}: {path.stat().st_size // 1024} KiB")


main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
