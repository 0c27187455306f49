"""`blender -b FILE -E KOMOREBI -o OUTPUT -f FRAMES` for the bpy module: FILE OUTPUT FRAMES [-t N].

FRAMES is a number, a list as 1,2 or a range as 1..3 (an animation).
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import support

file, output, frames = sys.argv[1:4]
support.enable()
bpy.ops.wm.open_mainfile(filepath=file)
scene = bpy.context.scene
scene.render.engine = "KOMOREBI"
if "-t" in sys.argv:
    scene.render.threads_mode = "FIXED"
    scene.render.threads = int(sys.argv[sys.argv.index("-t") + 1])
if ".." in frames:
    scene.render.filepath = output
    scene.frame_start, scene.frame_end = (int(f) for f in frames.split(".."))
    bpy.ops.render.render(animation=True)
else:
    for frame in frames.split(","):
        scene.frame_set(int(frame))
        scene.render.filepath = output
        scene.render.filepath = scene.render.frame_path(frame=int(frame))
        bpy.ops.render.render(write_still=True)
