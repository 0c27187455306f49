"""Math, Vector Math, Clamp and Map Range beside Cycles."""

import bpy
from node_beside_cycles import Stage, compare


def operations(kind):
    node = bpy.data.worlds.new("Any")
    node.use_nodes = True
    node = node.node_tree.nodes.new(kind)
    return [item.identifier for item in node.bl_rna.properties["operation"].enum_items]


def test_math():
    stage = Stage()
    for operation in operations("ShaderNodeMath"):
        for clamp in (False, True):

            def build(s, operation=operation, clamp=clamp):
                node = s.new("Math", operation=operation, use_clamp=clamp)
                scale = 1.2 if operation in {"ARCSINE", "ARCCOSINE"} else 3.1
                return s.feed(node, s.number(0, scale), s.number(1, 2.3, 0.1), s.number(2, 1.7))

            compare(stage, build, f"Math {operation} {clamp}")


def test_math_with_zeros_and_whole_numbers():
    stage = Stage()
    for operation in operations("ShaderNodeMath"):
        for second in (0.0, 1.0, -2.0):

            def build(s, operation=operation, second=second):
                first = s.feed(s.new("Math", operation="ROUND"), s.number(0, 3.0))
                return s.feed(s.new("Math", operation=operation), first, second, 0.0)

            compare(stage, build, f"Math {operation} {second}")


def test_vector_math():
    stage = Stage()
    for operation in operations("ShaderNodeVectorMath"):

        def build(s, operation=operation):
            node = s.new("VectorMath", operation=operation)
            sockets = [i for i in node.inputs if i.enabled]
            vectors = [s.vector((3, 2, 4)), s.vector((1, 2, 3), (0.2, 0, 0.1), 1),
                       s.vector((2, 1, 2), (0, 0.3, 0), 2)]  # fmt: skip
            given = [s.number(2, 1.5) if i.type == "VALUE" else vectors.pop(0) for i in sockets]
            return s.feed(node, *given, into=sockets)

        compare(stage, build, f"Vector Math {operation}")


def test_vector_math_of_zeros():
    stage = Stage()
    for operation in operations("ShaderNodeVectorMath"):
        if operation in {"REFLECT", "REFRACT"} and bpy.app.version < (4, 0, 0):
            continue  # NaN there

        def build(s, operation=operation):
            node = s.new("VectorMath", operation=operation)
            first = next(i for i in node.inputs if i.enabled)
            return s.feed(node, s.vector(), into=[first])

        compare(stage, build, f"Vector Math {operation}, rest 0")


def test_clamp():
    stage = Stage()
    for kind in ("MINMAX", "RANGE"):
        for low, high in ((-0.3, 0.4), (0.5, -0.2)):

            def build(s, kind=kind, low=low, high=high):
                node = s.new("Clamp", clamp_type=kind)
                return s.feed(node, s.number(0, 2.0), low, high)

            compare(stage, build, f"Clamp {kind} {low} {high}")


def test_map_range():
    stage = Stage()
    for data in ("FLOAT", "FLOAT_VECTOR"):
        for kind in ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP"):
            for clamp in (False, True):
                for numbers in ((-0.5, 0.6, 0.1, 0.9, 4.0), (0.7, -0.4, 2.0, -1.0, 2.5),
                                (0.3, 0.3, 0.2, 1.0, 0.0)):  # fmt: skip

                    def build(s, data=data, kind=kind, clamp=clamp, numbers=numbers):
                        node = s.new("MapRange", data_type=data, interpolation_type=kind)
                        node.clamp = clamp
                        if data == "FLOAT":
                            given = numbers if kind == "STEPPED" else numbers[:4]
                            return s.feed(node, s.number(0, 1.5), *given)
                        sockets = [i for i in node.inputs if i.type == "VECTOR"]
                        given = [(n, n * 0.9, n * 1.1) for n in numbers]
                        s.feed(node, s.vector((1.5, 1.5, 1.5)), *given, into=sockets)
                        return node.outputs["Vector"]

                    compare(stage, build, f"Map Range {data} {kind} {clamp} {numbers}")
