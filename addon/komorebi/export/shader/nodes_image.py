"""Pictures: Image Texture and Environment Texture."""

from __future__ import annotations

from typing import Any

from ...errors import RenderError
from ...scene_data import TextureImage
from ..names import name_of
from ..texture import export_texture
from .compiler import Compiler, Outputs, node
from .texture_inputs import texture_vector
from .values import Value

INTERPOLATIONS = ("Closest", "Linear", "Cubic", "Smart")
EXTENSIONS = ("REPEAT", "EXTEND", "CLIP", "MIRROR")
# What coordinates may be made of to be worked out two more times for a ray's cone.
QUICK = {
    "input", "attribute", "add", "subtract", "multiply", "divide", "multiply_add", "transform",
    "rotate_euler", "to_axes", "from_axes", "wrap_around",
}  # fmt: skip
FINEST: Value = (0.0,)
MAGENTA: Outputs = {"Color": (1.0, 0.0, 1.0), "Alpha": (1.0,)}


@node("TEX_IMAGE")
def image_texture(compiler: Compiler, node: Any) -> Outputs:
    picture = _picture(compiler, node)
    if picture is None:
        return MAGENTA
    b = compiler.builder
    place = _place(compiler, node)
    width = _footprint(compiler, node)
    # Cycles divides colours by alpha where the node's Alpha is used.
    how = (_interpolation(node), float(EXTENSIONS.index(node.extension)),
           float(node.outputs["Alpha"].is_linked))  # fmt: skip
    if node.projection == "BOX":
        operands = (*place, *b.input("object_normal"), *width)
        numbers = (*how, float(node.projection_blend))
        color = b.op("image_box", operands, 4, numbers=numbers, texture=picture)
    else:
        color = b.op("image", (*place[:2], *width), 4, numbers=how, texture=picture)
    return {"Color": color[:3], "Alpha": color[3:]}


@node("TEX_ENVIRONMENT")
def environment_texture(compiler: Compiler, node: Any) -> Outputs:
    picture = _picture(compiler, node)
    if picture is None:
        return {"Color": MAGENTA["Color"]}
    if node.image.source != "TILED":
        compiler.map_size = max(compiler.map_size, node.image.size[0])
    repeat = float(EXTENSIONS.index("REPEAT"))
    numbers = (_interpolation(node), repeat, 0.0, float(node.projection == "MIRROR_BALL"))
    vector = texture_vector(compiler, node)
    color = compiler.builder.op("environment", vector, 4, numbers=numbers, texture=picture)
    return {"Color": color[:3]}


def _place(compiler: Compiler, node: Any) -> Value:
    """Where an Image Texture is looked up: three numbers, of which Box takes all."""
    place = texture_vector(compiler, node)
    if node.projection == "BOX":
        return place
    if node.projection in {"SPHERE", "TUBE"}:
        around = (float(node.projection == "TUBE"),)
        place = compiler.builder.op("wrap_around", place, 2, numbers=around)
    return (*place[:2], 0.0)


def _footprint(compiler: Compiler, node: Any) -> Value:
    """How much of the picture the ray's cone covers."""
    if node.interpolation == "Closest":
        return FINEST
    compiler.has_pictures = True
    if not compiler.averages:
        return FINEST
    b = compiler.builder
    first = len(b.ops)
    with compiler.finest():
        place = _place(compiler, node)
        for way in ("cone_x", "cone_y"):
            with compiler.shifted(way, (1.0,)):
                place += _place(compiler, node)
    quick = all(op.op in QUICK for op in b.ops[first:])
    return b.op("footprint", place) if quick else FINEST


def _interpolation(node: Any) -> float:
    return float(INTERPOLATIONS.index(node.interpolation))


def _picture(compiler: Compiler, node: Any) -> TextureImage | None:
    """The node's picture; None: it has none, and a warning says so. A world whose file is missing
    is no picture to render by: RenderError."""
    said: list[str] = []

    def warn(what: str) -> None:
        said.append(what)
        compiler.warn(node, what)

    picture = export_texture(node.image, node.image_user, compiler.frame, warn)
    if picture is None and node.image is not None and compiler.is_world:
        raise RenderError(f'Image "{name_of(node.image)}" of the world: {said[-1]}')
    return picture
