"""Light the open scene with one of the HDR maps that Blender ships as studio lights.

    blender -b SCENE.blend -P blend_scenes/set_studio_light.py -E KOMOREBI -o OUT -f 1 -- [NAME [X
    Y Z]]

NAME is city, courtyard, forest, interior, night, studio, sunrise or sunset; X, Y and Z are the
degrees of the Mapping node's rotation. Without them the scene's own properties "studio_light" and
"studio_light_rotation" are used, else the city as it is. The maps belong to Blender, so that no
picture has to be stored beside the scenes.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import bpy


def studio_light(name: str) -> Path:
    """Where this Blender keeps the studio light `name`; SystemExit names the file if there is
    none."""
    data = bpy.utils.system_resource("DATAFILES") or bpy.utils.resource_path("SYSTEM")
    path = Path(data) / "studiolights" / "world" / f"{name}.exr"
    if not path.is_file():
        sys.exit(f"set_studio_light.py: this Blender has no studio light {path}")
    return path


def light_with(scene: bpy.types.Scene, path: Path, degrees: list[float]) -> None:
    """Give `scene` a new world: the map `path`, turned by `degrees` about X, Y and Z."""
    world = bpy.data.worlds.new("Studio light")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    coordinates, mapping = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeMapping")
    picture = nodes.new("ShaderNodeTexEnvironment")
    picture.image = bpy.data.images.load(str(path), check_existing=True)
    mapping.inputs["Rotation"].default_value = [math.radians(d) for d in degrees]
    links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], picture.inputs["Vector"])
    links.new(picture.outputs["Color"], nodes["Background"].inputs["Color"])
    scene.world = world


def main() -> None:
    """Read NAME and the degrees after `--`, or the scene's own choice, and set the world."""
    scene = bpy.context.scene
    words = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    name = words[0] if words else scene.get("studio_light", "city")
    own = scene.get("studio_light_rotation", (0.0, 0.0, 0.0))
    degrees = [float(word) for word in words[1:4]] if len(words) > 3 else list(own)
    light_with(scene, studio_light(name), degrees)
    print(f"Lit by the studio light {name}, turned by {degrees} degrees")


main()
