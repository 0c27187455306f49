"""A plate that shines as a picture does, seen straight on by Cycles, and the same from our look-ups."""

import bpy
import komorebi_core as core
import numpy as np
import support
from komorebi import native_texture
from komorebi.export.texture import export_texture

SIZE = 48  # pixels
LOW, HIGH = -0.77, 1.91  # UVs at the plate's edges


def plate():
    """A scene of one plate of two metres, and the node of its picture."""
    scene = support.fresh_scene("CYCLES", (SIZE, SIZE), 1)
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    scene.cycles.samples = 1
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 0.01
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    mesh = bpy.data.meshes.new("plate")
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    mesh.from_pydata([(x, y, 0) for x, y in corners], [], [(0, 1, 2, 3)])
    uvs = mesh.uv_layers.new()
    for loop, (x, y) in zip(uvs.data, corners, strict=True):
        loop.uv = (LOW + (HIGH - LOW) * (x + 1) / 2, LOW + (HIGH - LOW) * (y + 1) / 2)
    obj = bpy.data.objects.new("plate", mesh)
    scene.collection.objects.link(obj)
    camera = bpy.data.cameras.new("camera")
    camera.type, camera.ortho_scale = "ORTHO", 2.0
    scene.camera = bpy.data.objects.new("camera", camera)
    scene.camera.location.z = 3
    scene.collection.objects.link(scene.camera)
    material = bpy.data.materials.new("plate")
    material.use_nodes = True
    mesh.materials.append(material)
    tree = material.node_tree
    tree.nodes.clear()
    node = tree.nodes.new("ShaderNodeTexImage")
    tree.nodes.new("ShaderNodeEmission")
    tree.nodes.new("ShaderNodeOutputMaterial")
    tree.nodes.new("ShaderNodeVectorMath")
    return scene, node


def show(node, what):
    """COLOR alone, ALPHA alone, or the COLOR of a node of which ALPHA is used as well (BOTH)."""
    tree = node.id_data
    emission, output, add = (
        next(n for n in tree.nodes if n.type == kind)
        for kind in ("EMISSION", "OUTPUT_MATERIAL", "VECT_MATH")
    )
    tree.links.clear()
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    if what == "BOTH":
        add.operation = "MULTIPLY_ADD"
        tree.links.new(node.outputs["Alpha"], add.inputs[0])
        add.inputs[1].default_value = (1e-9, 1e-9, 1e-9)
        tree.links.new(node.outputs["Color"], add.inputs[2])
        tree.links.new(add.outputs[0], emission.inputs["Color"])
    else:
        tree.links.new(node.outputs[what.capitalize()], emission.inputs["Color"])


def places():
    """UVs of the pixels' centres [SIZE · SIZE, 2], row by row from the bottom."""
    at = LOW + (HIGH - LOW) * (np.arange(SIZE) + 0.5) / SIZE
    v, u = np.meshgrid(at, at, indexing="ij")
    return np.stack([u.ravel(), v.ravel()], axis=1).astype(np.float32)


def ours(node, what, warnings=None):
    """What our look-ups give [SIZE · SIZE, 3]."""
    warn = (warnings if warnings is not None else []).append
    image = export_texture(node.image, node.image_user, bpy.context.scene.frame_current, warn)
    if image is None:
        texture = core.Texture.missing("missing")
    else:
        texture = native_texture.load(core, [image], native_texture.LIMIT_BYTES, 1, warn)[image.key]
    values = texture.lookup(
        places(), interpolation=node.interpolation, extension=node.extension,
        straight=what == "BOTH",
    )  # fmt: skip
    return np.repeat(values[:, 3:], 3, axis=1) if what == "ALPHA" else values[:, :3]


def compare(scene, node, what, folder, share=0.995, warnings=None):
    """Asserts that Cycles' pixels and our look-ups are the same, within 1/255 of their range; some
    pixels' centres may lie on the edge of two texels. What alpha hides is left out of BOTH: Cycles
    divides by it, and its halves know no zero."""
    show(node, what)
    theirs = support.render(folder, scene=scene)[:, :, :3].reshape(-1, 3)
    our = ours(node, what, warnings)
    if what == "BOTH":
        seen = ours(node, "ALPHA")[:, 0] > 0.02
        our, theirs = our[seen], theirs[seen]
    spread = max(float(np.ptp(theirs)), float(np.abs(theirs).max()), 1e-3)
    difference = np.abs(our - theirs).max(axis=1) / spread
    far = difference > 1 / 255
    image = node.image
    case = image and (image.name, image.alpha_mode, image.colorspace_settings.name)
    assert 1 - far.mean() >= share, (
        f"{case} {what} {node.interpolation} {node.extension}: {far.mean():.4f} differ, "
        f"e.g. {our[far][:3]} and {theirs[far][:3]}"
    )
