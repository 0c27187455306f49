"""Nodes of where a point is and how it lies, beside Cycles, in worlds and on a surface."""

import bpy
from bowl import bowl
from node_beside_cycles import Stage, compare, with_alpha


def test_world_coordinates():
    stage = Stage()
    thing = bpy.data.objects.new("Other", None)
    bpy.context.scene.collection.objects.link(thing)
    thing.location, thing.scale, thing.rotation_euler = (0.2, 0.3, -0.1), (2, 1, 3), (0.4, 1, 2)
    bpy.context.view_layer.update()
    bpy.context.scene.camera.matrix_world = ((0, 0, 1, 1), (1, 0, 0, 2), (0, 1, 0, 3), (0, 0, 0, 1))
    for output in ("View Vector", "View Z Depth", "View Distance"):
        compare(stage, lambda s, o=output: s.new("CameraData").outputs[o], f"World {output}")
    for output in ("Generated", "Normal", "UV", "Object", "Reflection", "Camera"):
        compare(stage, lambda s, o=output: s.new("TexCoord").outputs[o], f"World {output}")
    compare(stage, lambda s: s.new("TexCoord", object=thing).outputs["Object"], "World Other")
    for output in ("Position", "Normal", "True Normal", "Incoming", "Parametric", "Backfacing"):
        compare(stage, lambda s, o=output: s.new("NewGeometry").outputs[o], f"World {output}")
    compare(stage, lambda s: s.new("UVMap").outputs[0], "World UV Map")
    compare(stage, lambda s: s.new("Attribute", attribute_name="x").outputs["Color"], "Attribute")


def test_surface_coordinates():
    thing = bowl()
    stage = Stage(thing)
    other = bpy.data.objects.new("Other", None)
    bpy.context.scene.collection.objects.link(other)
    other.location, other.scale, other.rotation_euler = (0.2, 0.3, -0.1), (2, 1, 3), (0.4, 1, 2)
    bpy.context.view_layer.update()
    compare(stage, lambda s: s.new("TexCoord", object=other).outputs["Object"], "Other")
    for output in ("Generated", "UV", "Object", "Normal", "Camera", "Window", "Reflection"):
        compare(stage, lambda s, o=output: s.new("TexCoord").outputs[o], output)
    for output in ("Location", "Color", "Alpha", "Object Index", "Material Index"):
        if output in stage.new("ObjectInfo").outputs:
            compare(stage, lambda s, o=output: s.new("ObjectInfo").outputs[o], output)
    for output in ("View Vector", "View Z Depth", "View Distance"):
        compare(stage, lambda s, o=output: s.new("CameraData").outputs[o], output)
    inputs, _ = stage.points()
    assert 0.2 < inputs["backfacing"].mean() < 0.8


def test_attributes():
    thing = bowl()
    thing.data.uv_layers[0].name = "Map"
    values = thing.data.attributes.new("Heat", "FLOAT", "POINT")
    values.data.foreach_set("value", [0.3] * len(values.data))
    stage = Stage(thing)
    _, attributes = stage.points()
    attributes["uv:Map"] = attributes["uv:"]
    attributes["Heat"] = with_alpha(attributes["uv:"][:, :3] * 0 + 0.3)
    compare(stage, lambda s: s.new("UVMap", uv_map="Map").outputs[0], "UV Map")
    for output in ("Color", "Vector", "Fac", "Alpha"):
        if output not in stage.new("Attribute").outputs:
            continue
        compare(
            stage, lambda s, o=output: s.new("Attribute", attribute_name="Heat").outputs[o], output
        )


def test_mapping():
    stage = Stage()
    for kind in ("POINT", "TEXTURE", "VECTOR", "NORMAL"):
        for linked in (False, True):
            for scale in ((0.7, 1.5, -2.0), (1.0, 0.0, 2.0)):

                def build(s, kind=kind, linked=linked, scale=scale):
                    node = s.new("Mapping", vector_type=kind)
                    given = [s.vector(), (0.2, -0.1, 0.3), (0.4, -0.9, 2.0), scale]
                    if linked:
                        given[1] = s.vector(offset=(0.2, -0.1, 0.3), turn=1)
                        given[2] = s.vector((0.5, 0.6, 0.9), (0.4, -0.9, 2.0), turn=2)
                        given[3] = s.vector((0.1, 0.0, 0.2), scale)
                    names = ("Vector", "Location", "Rotation", "Scale")
                    pairs = [(node.inputs.get(n), g) for n, g in zip(names, given, strict=True)]
                    pairs = [(n, g) for n, g in pairs if n is not None and n.enabled]
                    return s.feed(node, *(g for _, g in pairs), into=[n for n, _ in pairs])

                compare(stage, build, f"Mapping {kind} {linked} {scale}")


def test_vector_rotate():
    stage = Stage()
    for kind in ("AXIS_ANGLE", "X_AXIS", "Y_AXIS", "Z_AXIS", "EULER_XYZ"):
        for invert in (False, True):

            def build(s, kind=kind, invert=invert):
                node = s.new("VectorRotate", rotation_type=kind, invert=invert)
                given = {"Vector": s.vector(), "Center": s.vector((0.3, 0.2, 0.1), turn=1),
                         "Axis": s.vector((1, 2, 3), (0.5, 0.1, 0.2), 2), "Angle": s.number(1, 3.0),
                         "Rotation": s.vector((2, 1, 3))}  # fmt: skip
                into = [i for i in node.inputs if i.enabled]
                return s.feed(node, *(given[i.name] for i in into), into=into)

            compare(stage, build, f"Vector Rotate {kind} {invert}")
    compare(stage, lambda s: s.feed(s.new("VectorRotate"), s.vector(), (0, 0, 0), (0, 0, 0), 1.0),
            "Vector Rotate about nothing")  # fmt: skip


def test_vector_transform():
    for surface in (None, bowl):
        stage = Stage(surface and surface())
        for kind in ("VECTOR", "POINT", "NORMAL"):
            for source in ("WORLD", "OBJECT", "CAMERA"):
                for target in ("WORLD", "OBJECT", "CAMERA"):

                    def build(s, kind=kind, source=source, target=target):
                        node = s.new("VectorTransform", vector_type=kind)
                        node.convert_from, node.convert_to = source, target
                        return s.feed(node, s.vector(offset=(0.2, 0.1, 0.3)))

                    name = f"Vector Transform {kind} {source} {target} {stage.is_world}"
                    compare(stage, build, name)


def test_normal():
    stage = Stage()
    for output in ("Normal", "Dot"):

        def build(s, output=output):
            node = s.new("Normal")
            node.outputs["Normal"].default_value = (0.6, 0.0, 0.8)
            s.feed(node, s.vector((2, 2, 3)))
            return node.outputs[output]

        compare(stage, build, f"Normal {output}")
