"""Nodes of how a surface is looked at and where its normal points, beside Cycles."""

import bpy
import numpy as np
from bowl import bowl, look_down, steps
from node_beside_cycles import Stage, compare, with_alpha


def test_fresnel_and_layer_weight():
    for surface in (None, bowl):
        stage = Stage(surface and surface())
        for linked in (False, True):

            def normal(s, linked=linked):
                return s.vector((1, 2, 1), (0, 0, 0.3), 1) if linked else None

            def fresnel(s):
                return s.feed(s.new("Fresnel"), s.number(0, 0.5, 1.3), normal(s))

            compare(stage, fresnel, f"Fresnel {linked}")
            for output in ("Fresnel", "Facing"):

                def weight(s, output=output):
                    node = s.new("LayerWeight")
                    s.feed(node, s.number(0, 0.5, 0.5), normal(s))
                    return node.outputs[output]

                compare(stage, weight, f"Layer Weight {output} {linked}")


def test_geometry_of_both_sides():
    stage = Stage(bowl(smooth=False))
    for output in ("Position", "Normal", "True Normal", "Incoming", "Parametric", "Backfacing"):
        compare(stage, lambda s, o=output: s.new("NewGeometry").outputs[o], output)


def test_normal_map():
    for space in ("OBJECT", "WORLD", "BLENDER_OBJECT", "BLENDER_WORLD"):
        stage = Stage(bowl())
        for strength in (1.0, 0.4, 1.7, -1.0):

            def build(s, space=space, strength=strength):
                node = s.new("NormalMap", space=space)
                return s.feed(node, strength, s.vector((0.5,) * 3, (0.6, 0.5, 0.7)))

            compare(stage, build, f"Normal Map {space} {strength}")


def plate():
    """A plane from −1 to 1, turned about, whose UV map is (x + 1, y + 1) / 2."""
    bpy.ops.mesh.primitive_plane_add(size=2.0)
    thing = bpy.context.object
    thing.rotation_euler, thing.scale = (0.5, -0.4, 0.9), (1.5, 1.2, 1.0)
    look_down(2.0)
    return thing


def test_normal_map_in_tangent_space():
    for turned in (False, True):
        thing = plate()
        if turned:
            thing.rotation_euler = (2.8, 0.3, 0.4)
            bpy.context.view_layer.update()
        stage = Stage(thing)
        inputs, attributes = stage.points()
        assert inputs["backfacing"].mean() == turned
        row = np.array([1.0, 0.0, 0.0, 1.0], np.float32)  # U runs along X, V along Y
        attributes["tangent:"] = np.tile(row, (len(inputs["normal"]), 1))
        for strength in (1.0, 0.3, 1.8):

            def build(s, strength=strength):
                node = s.new("NormalMap")
                return s.feed(node, strength, s.vector((0.3,) * 3, (0.6, 0.5, 0.8)))

            compare(stage, build, f"Normal Map TANGENT {turned} {strength}")
        compare(stage, lambda s: s.new("Tangent", direction_type="UV_MAP").outputs[0], "Tangent UV")


def test_radial_tangent():
    stage = Stage(bowl())
    for axis in "XYZ":
        compare(stage, lambda s, a=axis: s.new("Tangent", axis=a).outputs[0], f"Tangent {axis}")


def waves(s, source):
    """A height that waves along a coordinate's X and Y."""
    parts = s.feed_parts(source)
    both = s.feed(s.new("Math"), s.number(parts[0], 0.6), s.number(parts[1], 1.0))
    return s.feed(s.new("Math", operation="SINE"), both)


def bump_stage(thing):
    stage = Stage(thing)
    inputs, attributes = stage.points()
    inputs["dx"], inputs["dy"] = steps(stage)
    to_object = np.linalg.inv(np.array(thing.matrix_world)[:3, :3]).T
    for way in ("dx", "dy"):  # of the plate both are (object's point + 1) / 2
        change = with_alpha(0.5 * inputs[way] @ to_object)
        change[:, 3] = 0.0
        attributes[f"{way}:uv:"] = attributes[f"{way}:generated"] = change
    return stage


def test_bump():
    for thing, outputs in ((plate, ("Generated", "UV", "Object")), (bowl, ("Object", "Camera"))):
        stage = bump_stage(thing())
        for output in (*outputs, "Position"):
            for strength, distance, invert in ((1.0, 0.2, False), (0.4, 0.6, True)):

                def build(s, output=output, strength=strength, distance=distance, invert=invert):
                    node = s.new("Bump", invert=invert)
                    kind = "NewGeometry" if output == "Position" else "TexCoord"
                    s.link(waves(s, s.new(kind).outputs[output]), node.inputs["Height"])
                    node.inputs["Strength"].default_value = strength
                    node.inputs["Distance"].default_value = distance
                    return node.outputs[0]

                name = f"Bump {thing.__name__} {output} {strength} {invert}"
                compare(stage, build, name, most=1.0 / 255.0)


def test_bump_without_height_and_over_another():
    stage = bump_stage(plate())
    compare(stage, lambda s: s.new("Bump").outputs[0], "Bump of nothing")

    def twice(s):
        first, second = s.new("Bump"), s.new("Bump")
        s.link(waves(s, s.new("TexCoord").outputs["Object"]), first.inputs["Height"])
        s.link(waves(s, s.new("TexCoord").outputs["UV"]), second.inputs["Height"])
        s.link(first.outputs[0], second.inputs["Normal"])
        for node in (first, second):
            node.inputs["Distance"].default_value = 0.15
        return second.outputs[0]

    compare(stage, twice, "Bump on Bump", most=1.0 / 255.0)


def test_what_is_not_known_is_named():
    stage = Stage(bowl())
    stage.points()
    for kind, count in (("AmbientOcclusion", 1), ("Bevel", 1), ("Wireframe", 1), ("ParticleInfo", 1),
                        ("Script", 1)):  # fmt: skip
        stage.clear()
        node = stage.new(kind)
        if not len(node.outputs):
            continue
        values = stage.ours(node.outputs[0])
        assert np.isfinite(values).all()
        assert len(stage.warnings) == count, (kind, stage.warnings)
        assert node.name in stage.warnings[0]
