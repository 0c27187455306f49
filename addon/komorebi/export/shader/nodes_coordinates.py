"""Where a point is and how it lies: Texture Coordinate, Geometry, Mapping and the like.

A bump's height is compiled for points a bit aside too: Compiler.shift says which way, and what is
read of a point here is what it is there.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ... import compat
from ..mapping import euler_matrix
from .compiler import Compiler, Outputs, node
from .values import Value

ZERO: Value = (0.0, 0.0, 0.0)
STEPS = ("dx", "dy", "cone_x", "cone_y")  # ways of Compiler.shift


def axes(compiler: Compiler) -> Value:
    """The object's X, Y and Z axes in the world: nine numbers."""
    b = compiler.builder
    return b.input("object_x") + b.input("object_y") + b.input("object_z")


def _step(compiler: Compiler) -> Value:
    """How far the point that is compiled for lies from the one that is shaded, in the world."""
    way, width = compiler.shift
    return compiler.builder.multiply(width, compiler.builder.input(way))


def position(compiler: Compiler) -> Value:
    """In the world; of a world the direction."""
    place = compiler.builder.input("position")
    if compiler.shift is None or compiler.is_world:
        return place
    return compiler.builder.add(place, _step(compiler))


def object_point(compiler: Compiler) -> Value:
    b = compiler.builder
    place = b.input("object_point")
    if compiler.shift is None or compiler.is_world:
        return place
    return b.add(place, b.op("to_axes", _step(compiler) + axes(compiler), 3))


def attribute(compiler: Compiler, name: str) -> Value:
    """Red, green, blue and alpha of an attribute; a world has none.

    Aside, "dx:" + name (or another of STEPS) is asked for as well: how much the attribute changes
    from this pixel to the one on its right, to the one above, or across the ray's cone.
    """
    if compiler.is_world:
        return (0.0,) * 4
    value = compiler.builder.attribute(name)
    if compiler.shift is None:
        return value
    way, width = compiler.shift
    change = compiler.builder.attribute(f"{way}:{name}")
    return compiler.builder.add(value, compiler.builder.multiply(width, change))


def generated(compiler: Compiler) -> Value:
    return position(compiler) if compiler.is_world else attribute(compiler, "generated")[:3]


def default_vector(compiler: Compiler, node: Any) -> Value:
    """What a texture whose Vector is not linked takes: images the active UV map, environments the
    direction, all others generated coordinates."""
    if node.type == "TEX_IMAGE":
        return attribute(compiler, "uv:")[:3]
    if node.type == "TEX_ENVIRONMENT":
        return position(compiler)
    return generated(compiler)


def normal_input(compiler: Compiler, node: Any) -> Value:
    """The input Normal; the surface's own where nothing is linked."""
    socket = node.inputs["Normal"]
    if compiler.is_linked(socket):
        return compiler.value(socket)
    return compiler.builder.input("normal")


def _matrix(matrix: Any) -> tuple[float, ...]:
    return tuple(float(x) for row in np.asarray(matrix, np.float64)[:3, :4] for x in row)


@node("TEX_COORD")
def texture_coordinate(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    if getattr(node, "from_instancer", False):
        compiler.warn(node, "coordinates from the instancer are not supported, the own are taken")
    if node.object is not None:
        inverse = node.object.matrix_world.inverted_safe()
        point = b.op("transform", position(compiler), 3, numbers=_matrix(inverse))
    else:
        point = object_point(compiler)
    incoming, normal = b.input("incoming"), b.input("normal")
    mirrored = incoming
    if not compiler.is_world:
        mirrored = b.subtract(ZERO, b.op("reflect", incoming + normal, 3))
    return {
        "Generated": generated(compiler),
        "Normal": normal if compiler.is_world else b.input("object_normal"),
        "UV": attribute(compiler, "uv:")[:3],
        "Object": point,
        "Camera": _in_camera(compiler, is_point=False),
        "Window": b.input("window"),
        "Reflection": mirrored,
    }


@node("NEW_GEOMETRY")
def geometry(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    if node.outputs["Pointiness"].is_linked:
        compiler.warn(node, "Pointiness is not supported, taken as that of a plane")
    if node.outputs["Random Per Island"].is_linked:
        compiler.warn(node, "Random Per Island is not supported, taken as the object's Random")
    return {
        "Position": position(compiler),
        "Normal": b.input("normal"),
        "Tangent": b.input("tangent"),
        "True Normal": b.input("true_normal"),
        "Incoming": b.input("incoming"),
        "Parametric": b.input("parametric"),
        "Backfacing": b.input("backfacing", 1),
        "Pointiness": (0.0,) if compiler.is_world else (0.5,),
        "Random Per Island": b.input("object_random", 1),
    }


@node("UVMAP")
def uv_map(compiler: Compiler, node: Any) -> Outputs:
    if node.from_instancer:
        compiler.warn(node, "coordinates from the instancer are not supported, the own are taken")
    return {"UV": attribute(compiler, f"uv:{node.uv_map}")[:3]}


def _attribute_outputs(compiler: Compiler, value: Value) -> Outputs:
    mean = compiler.builder.convert(value[:3], "VECTOR", "VALUE")
    return {
        "Color": value[:3],
        "Vector": value[:3],
        "Fac": mean,
        "Factor": mean,
        "Alpha": value[3:],
    }


@node("ATTRIBUTE")
def attribute_node(compiler: Compiler, node: Any) -> Outputs:
    name = node.attribute_name
    if node.attribute_type != "GEOMETRY":
        kind = node.bl_rna.properties["attribute_type"].enum_items[node.attribute_type].name
        compiler.warn(node, f'"{name}" of type {kind} is not supported yet, taken as 0')
        return _attribute_outputs(compiler, (0.0,) * 4)
    return _attribute_outputs(compiler, attribute(compiler, name) if name else (0.0,) * 4)


@node("VERTEX_COLOR")
def color_attribute(compiler: Compiler, node: Any) -> Outputs:
    return _attribute_outputs(compiler, attribute(compiler, f"color:{node.layer_name}"))


@node("OBJECT_INFO")
def object_info(compiler: Compiler, _node: Any) -> Outputs:
    b = compiler.builder
    return {
        "Location": b.input("object_location"),
        "Color": b.input("object_color"),
        "Alpha": b.input("object_alpha", 1),
        "Object Index": b.input("object_index", 1),
        "Material Index": b.input("material_index", 1),
        "Random": b.input("object_random", 1),
    }


@node("CAMERA")
def camera_data(compiler: Compiler, _node: Any) -> Outputs:
    b = compiler.builder
    place = _in_camera(compiler, is_point=True)
    return {
        "View Vector": b.op("normalize", place, 3),
        "View Z Depth": place[2:],
        "View Distance": b.op("length", place),
    }


@node("MAPPING")
def mapping(compiler: Compiler, node: Any) -> Outputs:
    b, kind = compiler.builder, node.vector_type
    vector, rotation, scale = compiler.inputs(node, "Vector", "Rotation", "Scale")
    # Vector and Normal have no such input in some releases
    moves = kind in {"POINT", "TEXTURE"}
    location = compiler.value(node.inputs["Location"]) if moves else ZERO
    if kind == "TEXTURE":
        vector = b.subtract(vector, location)
        vector = _turned(compiler, vector, rotation, back=True)
        vector = b.each("divide", vector, scale)
    elif kind == "NORMAL":
        vector = _turned(compiler, b.each("divide", vector, scale), rotation)
        vector = b.op("normalize", vector, 3)
    else:
        vector = b.add(_turned(compiler, b.multiply(vector, scale), rotation), location)
    return {node.outputs[0].identifier: vector}


def _turned(compiler: Compiler, vector: Value, euler: Value, *, back: bool = False) -> Value:
    """By Euler angles about X, Y, Z; a matrix where they are the same at all points."""
    b = compiler.builder
    if all(isinstance(angle, float) for angle in euler):
        if not any(euler):
            return vector
        matrix = euler_matrix(euler)  # type: ignore[arg-type]
        rows = np.column_stack([matrix.T if back else matrix, np.zeros(3)])
        return b.op("transform", vector, 3, numbers=_matrix(rows))
    return b.op("rotate_euler", vector + euler, 3, numbers=(float(back),))


@node("VECTOR_ROTATE")
def vector_rotate(compiler: Compiler, node: Any) -> Outputs:
    b, kind = compiler.builder, node.rotation_type
    vector, center = compiler.inputs(node, "Vector", "Center")
    if kind == "EULER_XYZ":
        arm = b.subtract(vector, center)
        euler = compiler.value(node.inputs["Rotation"])
        result = b.add(_turned(compiler, arm, euler, back=node.invert), center)
    else:
        known = {"X_AXIS": (1.0, 0.0, 0.0), "Y_AXIS": (0.0, 1.0, 0.0), "Z_AXIS": (0.0, 0.0, 1.0)}
        axis: Value = known.get(kind) or compiler.value(node.inputs["Axis"])
        angle = b.multiply(compiler.value(node.inputs["Angle"]), (-1.0 if node.invert else 1.0,))
        result = b.op("rotate_axis", vector + center + axis + angle, 3)
    return {node.outputs[0].identifier: result}


@node("VECT_TRANSFORM")
def vector_transform(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    vector = compiler.value(node.inputs[0])
    is_point, is_normal = (node.vector_type == kind for kind in ("POINT", "NORMAL"))
    source, target = node.convert_from, node.convert_to
    if "CAMERA" in (source, target) and source != target and compiler.camera_from_world is None:
        compiler.warn(node, "the camera is not known here, its space is taken as the world's")
    if source == target:
        if is_normal and compat.NORMALS_AS_DIRECTIONS:
            vector = b.op("normalize", vector, 3)
        return {node.outputs[0].identifier: vector}
    by_transpose = is_normal and not compat.NORMALS_AS_DIRECTIONS
    moved = vector
    if source == "CAMERA":
        moved = _by_camera(compiler, moved, is_point, back=True)
    elif source == "OBJECT" and not compiler.is_world:
        back = "normal_from_axes" if by_transpose else "from_axes"
        moved = b.op(back, moved + axes(compiler), 3)
        if is_point:
            moved = b.add(moved, b.input("object_location"))
    if target == "CAMERA":
        moved = _by_camera(compiler, moved, is_point, back=False)
    elif target == "OBJECT" and not compiler.is_world:
        if is_point:
            moved = b.subtract(moved, b.input("object_location"))
        moved = b.op("normal_to_axes" if by_transpose else "to_axes", moved + axes(compiler), 3)
    if is_normal and (moved is not vector or compat.NORMALS_AS_DIRECTIONS):
        moved = b.op("normalize", moved, 3)
    return {node.outputs[0].identifier: moved}


def _by_camera(compiler: Compiler, vector: Value, is_point: bool, *, back: bool) -> Value:
    if compiler.camera_from_world is None:
        return vector
    matrix = np.eye(4)
    matrix[:3] = np.asarray(compiler.camera_from_world, np.float64)[:3]
    if back:
        matrix = np.linalg.inv(matrix)
    if not is_point:
        matrix[:3, 3] = 0.0
    return compiler.builder.op("transform", vector, 3, numbers=_matrix(matrix))


def _in_camera(compiler: Compiler, *, is_point: bool) -> Value:
    """Where the camera has the point; of a world the direction, or what lies at its end."""
    if compiler.is_world and compiler.camera_from_world is not None:
        return _by_camera(compiler, position(compiler), is_point, back=False)
    place = compiler.builder.input("camera")
    if compiler.shift is None or compiler.is_world or compiler.camera_from_world is None:
        return place
    step = _by_camera(compiler, _step(compiler), False, back=False)
    return compiler.builder.add(place, step)


@node("NORMAL")
def normal(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    direction = b.op("normalize", tuple(map(float, node.outputs["Normal"].default_value)), 3)
    given = b.op("normalize", compiler.value(node.inputs[0]), 3)
    return {"Normal": direction, "Dot": b.dot(direction, given)}
