"""How trees are walked (groups, reroutes, muted nodes, circles), beside Cycles where it has a picture
of its own, and trees that are broken."""

import bpy
import numpy as np
from node_beside_cycles import Stage, compare


def group(name, scale):
    """A group that multiplies its input by `scale` and, at its second output, hands its default on."""
    tree = bpy.data.node_groups.new(name, "ShaderNodeTree")
    if hasattr(tree, "interface"):
        tree.interface.new_socket("Value", in_out="INPUT", socket_type="NodeSocketFloat")
        other = tree.interface.new_socket("Color", in_out="INPUT", socket_type="NodeSocketColor")
        for name in ("Product", "Rest"):
            tree.interface.new_socket(name, in_out="OUTPUT", socket_type="NodeSocketColor")
    else:
        tree.inputs.new("NodeSocketFloat", "Value")
        other = tree.inputs.new("NodeSocketColor", "Color")
        for name in ("Product", "Rest"):
            tree.outputs.new("NodeSocketColor", name)
    other.default_value = (0.1, 0.2, 0.3, 1.0)
    into, out = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    math = tree.nodes.new("ShaderNodeMath")
    math.operation = "MULTIPLY"
    math.inputs[1].default_value = scale
    tree.links.new(into.outputs[0], math.inputs[0])
    tree.links.new(math.outputs[0], out.inputs[0])
    tree.links.new(into.outputs[1], out.inputs[1])
    return tree


def test_groups():
    stage = Stage()
    inner = group("Inner", 3.0)
    outer = group("Outer", 0.5)
    nested = outer.nodes.new("ShaderNodeGroup")
    nested.node_tree = inner
    math = next(n for n in outer.nodes if n.type == "MATH")
    target = math.outputs[0].links[0].to_socket
    outer.links.new(math.outputs[0], nested.inputs[0])
    outer.links.new(nested.outputs[0], target)
    for k in range(2):

        def build(s, k=k):
            node = s.new("Group", node_tree=outer)
            s.link(s.number(0), node.inputs[0])
            return node.outputs[k]

        compare(stage, build, f"Group output {k}")

    def linked(s):
        node = s.new("Group", node_tree=outer)
        s.link(s.place(), node.inputs[1])
        return node.outputs[1]

    compare(stage, linked, "Group, colour through")


def test_reroutes_and_muted_nodes():
    stage = Stage()

    def rerouted(s):
        reroute = s.tree.nodes.new("NodeReroute")
        s.link(s.place(), reroute.inputs[0])
        return reroute.outputs[0]

    def muted(s):
        node = s.new("VectorMath", operation="MULTIPLY")
        output = s.feed(node, s.place(), (3, 3, 3))
        node.mute = True
        return output

    compare(stage, rerouted, "Reroute")
    compare(stage, muted, "muted")


def test_conversions():
    stage = Stage()
    compare(stage, lambda s: s.number(s.place()), "vector to number")
    compare(stage, lambda s: s.number(s.feed(s.new("Gamma"), s.place(), 1.0)), "colour to number")

    def color_to_vector(s):
        return s.feed(s.new("VectorMath"), s.feed(s.new("Gamma"), s.place(), 1.0), (0, 0, 0))

    compare(stage, color_to_vector, "colour to vector")


def test_a_circle_of_nodes_ends():
    stage = Stage()
    stage.points()
    stage.clear()
    first, second = stage.new("Math"), stage.new("Math")
    stage.link(first.outputs[0], second.inputs[0])
    stage.link(second.outputs[0], first.inputs[0])
    assert np.isfinite(stage.ours(second.outputs[0])).all()


def test_numbers_beyond_floats_are_no_crash():
    stage = Stage()
    stage.points()
    for operation in ("POWER", "EXPONENT", "TANGENT", "COSH"):
        stage.clear()
        node = stage.new("Math", operation=operation)
        values = stage.ours(stage.feed(node, stage.number(0, 1e30), 1e30))
        assert values.shape == (len(stage.points()[0]["position"]), 3)
