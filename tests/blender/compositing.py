"""The compositor's nodes by the names of each release."""

import bpy
import support


def layers_node(tree):
    return tree.nodes.new("CompositorNodeRLayers")


def file_output(tree, folder, sockets):
    """A node that writes each of `sockets` (name → output socket) to float EXR files in `folder`:
    NAME####.exr, from 5.0 on ####_NAME.exr."""
    node = tree.nodes.new("CompositorNodeOutputFile")
    settings = node.format
    if hasattr(settings, "media_type"):  # from 5.0
        settings.media_type = "IMAGE"
    settings.file_format = "OPEN_EXR"
    settings.color_depth, settings.exr_codec = "32", "NONE"
    if hasattr(node, "file_output_items"):
        node.directory, node.file_name = str(folder), "####_"
        for name, socket in sockets.items():
            kind = {"VALUE": "FLOAT"}.get(socket.type, socket.type)
            node.file_output_items.new(kind, name)
    else:
        node.base_path = str(folder)
        node.file_slots.clear()
        for name in sockets:
            node.file_slots.new(name)
    for name, socket in sockets.items():
        tree.links.new(socket, node.inputs[name])
    return node


def render_files(folder, names):
    """Renders once; the pixels that each of the File Output's files holds."""
    frame = bpy.context.scene.frame_current
    bpy.ops.render.render()
    found = {}
    for name in names:
        paths = [*folder.glob(f"{name}{frame:04d}.exr"), *folder.glob(f"{frame:04d}_{name}.exr")]
        (path,) = paths
        found[name] = support.read(path)
    return found
