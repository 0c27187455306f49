"""Instances of one object on many points, by geometry nodes: a few bytes a copy in the file."""

from __future__ import annotations

import math

import bpy
from common import add_mesh
from mathutils import Vector


def scatter(
    name: str,
    points: list[Vector],
    thing: bpy.types.Object,
    tilt: float,
    scale: tuple[float, float],
) -> bpy.types.Object:
    """Instances of `thing` on `points`, turned at random about Z and tilted by up to `tilt`
    radians."""
    coarse = [[round(c * 256.0) / 256.0 for c in point] for point in points]  # squeezes better
    carrier = add_mesh(name, coarse, [])
    thing.hide_render = thing.hide_viewport = True
    group = bpy.data.node_groups.new(name, "GeometryNodeTree")
    group.inputs.new("NodeSocketGeometry", "Geometry")
    group.outputs.new("NodeSocketGeometry", "Geometry")
    nodes, links = group.nodes, group.links
    start, end = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
    place = nodes.new("GeometryNodeInstanceOnPoints")
    what = nodes.new("GeometryNodeObjectInfo")
    what.inputs["Object"].default_value = thing
    what.inputs["As Instance"].default_value = True
    turn, size = nodes.new("FunctionNodeRandomValue"), nodes.new("FunctionNodeRandomValue")
    turn.data_type, size.data_type = "FLOAT_VECTOR", "FLOAT"
    turn.inputs[0].default_value, turn.inputs[1].default_value = (
        (-tilt, -tilt, 0.0),
        (tilt, tilt, 2.0 * math.pi),
    )
    size.inputs[2].default_value, size.inputs[3].default_value = scale
    size.inputs["Seed"].default_value = 7
    links.new(start.outputs[0], place.inputs["Points"])
    links.new(what.outputs["Geometry"], place.inputs["Instance"])
    links.new(turn.outputs[0], place.inputs["Rotation"])
    links.new(size.outputs[1], place.inputs["Scale"])
    links.new(place.outputs["Instances"], end.inputs[0])
    carrier.modifiers.new("Scatter", "NODES").node_group = group
    return carrier
