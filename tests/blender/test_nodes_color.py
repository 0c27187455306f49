"""Nodes that work on colours, beside Cycles."""

import bpy
from node_beside_cycles import Stage, compare

BLENDS = (
    "MIX DARKEN MULTIPLY BURN LIGHTEN SCREEN DODGE ADD OVERLAY SOFT_LIGHT LINEAR_LIGHT DIFFERENCE "
    "EXCLUSION SUBTRACT DIVIDE HUE SATURATION COLOR VALUE"
)


def blends(node):
    known = [i.identifier for i in node.bl_rna.properties["blend_type"].enum_items]
    assert set(known) <= set(BLENDS.split()), known
    return known


def colors(s):
    """Two colours, between 0 and 1 for most points and somewhat beyond for others."""
    return s.vector((0.7,) * 3, (0.5,) * 3), s.vector((0.6, -0.5, 0.7), (0.4, 0.5, 0.6), 1)


def test_mix_rgb():
    stage = Stage()
    for kind in blends(stage.new("MixRGB")):
        for clamp, factor in ((False, 0.8), (True, 1.4)):

            def build(s, kind=kind, clamp=clamp, factor=factor):
                node = s.new("MixRGB", blend_type=kind, use_clamp=clamp)
                return s.feed(node, s.number(2, factor, 0.3), *colors(s))

            compare(stage, build, f"MixRGB {kind} {clamp}")


def test_mix_color():
    stage = Stage()
    for kind in blends(stage.new("Mix")):
        for clamp in (False, True):

            def build(s, kind=kind, clamp=clamp):
                node = s.new("Mix", data_type="RGBA", blend_type=kind)
                node.clamp_factor, node.clamp_result = clamp, not clamp
                return s.feed(node, s.number(2, 1.4, 0.3), *colors(s))

            compare(stage, build, f"Mix {kind} {clamp}")


def test_mix_numbers_and_vectors():
    stage = Stage()
    for kind, mode in (("FLOAT", "UNIFORM"), ("VECTOR", "UNIFORM"), ("VECTOR", "NON_UNIFORM")):
        for clamp in (False, True):

            def build(s, kind=kind, mode=mode, clamp=clamp):
                node = s.new("Mix", data_type=kind, factor_mode=mode, clamp_factor=clamp)
                factor = s.vector((1.2, 1.3, 1.4)) if mode == "NON_UNIFORM" else s.number(1, 1.5)
                if kind == "FLOAT":
                    return s.feed(node, factor, s.number(0, 2.0), s.number(2, 1.0, 3.0))
                return s.feed(node, factor, *colors(s))

            compare(stage, build, f"Mix {kind} {mode} {clamp}")


def test_adjustments():
    stage = Stage()

    def hue(s):
        node = s.new("HueSaturation")
        return s.feed(node, s.number(0, 0.6, 0.5), s.number(1, 1.0, 1.0), s.number(2, 0.6, 0.5),
                      s.number(0, 0.5, 0.6), colors(s)[0])  # fmt: skip

    def contrast(s):
        return s.feed(s.new("BrightContrast"), colors(s)[0], s.number(0), s.number(1, 0.6, 0.5))

    compare(stage, hue, "Hue/Saturation")
    compare(stage, lambda s: s.feed(s.new("Gamma"), colors(s)[0], s.number(0, 1.5, 1.0)), "Gamma")
    compare(stage, lambda s: s.feed(s.new("Gamma"), colors(s)[0], 0.0), "Gamma 0")
    compare(stage, contrast, "Bright/Contrast")
    compare(stage, lambda s: s.feed(s.new("Invert"), s.number(0, 1.2), colors(s)[0]), "Invert")
    compare(stage, lambda s: s.feed(s.new("RGBToBW"), colors(s)[0]), "RGB to BW")


def test_spectrum():
    stage = Stage()
    compare(stage, lambda s: s.feed(s.new("Blackbody"), s.number(0, 7000, 6500)), "Blackbody")
    compare(stage, lambda s: s.feed(s.new("Blackbody"), s.number(0, 800, 1200)), "Blackbody, warm")
    compare(stage, lambda s: s.feed(s.new("Wavelength"), s.number(0, 250, 580)), "Wavelength")


def test_separate_and_combine():
    stage = Stage()
    pairs = [("XYZ", {}), ("RGB", {}), ("HSV", {})]
    pairs += [("Color", {"mode": mode}) for mode in ("RGB", "HSV", "HSL")]
    for name, modes in pairs:
        if not hasattr(bpy.types, f"ShaderNodeSeparate{name}"):
            continue  # the old ones are gone in some releases

        def separated(s, name=name, modes=modes):
            node = s.new(f"Separate{name}", **modes)
            s.feed(node, colors(s)[0])
            combine = s.new("CombineXYZ")
            for source, target in zip(node.outputs, combine.inputs, strict=True):
                s.link(source, target)
            return combine.outputs[0]

        def combined(s, name=name, modes=modes):
            node = s.new(f"Combine{name}", **modes)
            return s.feed(node, *(s.number(k, 0.5, 0.5) for k in range(3)))

        compare(stage, separated, f"Separate {name} {modes}")
        compare(stage, combined, f"Combine {name} {modes}")


def ramp(s, mode, interpolation, alpha):
    node = s.new("ValToRGB")
    band = node.color_ramp
    band.color_mode, band.interpolation = mode, interpolation
    band.elements[0].color, band.elements[0].position = (0.1, 0.9, 0.3, 0.2), 0.1
    band.elements[1].color, band.elements[1].position = (0.8, 0.2, 0.4, 1.0), 0.8
    band.elements.new(0.37).color = (1.5, 0.4, 0.9, 0.6)
    s.feed(node, s.number(0, 0.7, 0.5))
    return node.outputs["Alpha" if alpha else "Color"]


def test_color_ramp():
    stage = Stage()
    for interpolation in ("LINEAR", "EASE", "CARDINAL", "B_SPLINE", "CONSTANT"):
        for alpha in (False, True):

            def build(s, interpolation=interpolation, alpha=alpha):
                return ramp(s, "RGB", interpolation, alpha)

            compare(stage, build, f"Color Ramp {interpolation} {alpha}")
    for mode in ("HSV", "HSL"):
        for interpolation in ("NEAR", "FAR", "CW", "CCW"):

            def build(s, interpolation=interpolation, mode=mode):
                node = s.new("ValToRGB")
                node.color_ramp.color_mode = mode
                node.color_ramp.hue_interpolation = interpolation
                node.color_ramp.elements[0].color = (0.1, 0.9, 0.3, 0.2)
                node.color_ramp.elements[1].color = (0.8, 0.2, 0.4, 0.2)
                return s.feed(node, s.number(0, 0.7, 0.5))

            compare(stage, build, f"Color Ramp {mode} {interpolation}")


def test_curves():
    stage = Stage()
    for kind in ("RGBCurve", "VectorCurve", "FloatCurve"):
        for extend in ("HORIZONTAL", "EXTRAPOLATED"):

            def build(s, kind=kind, extend=extend):
                node = s.new(kind)
                mapping = node.mapping
                mapping.extend = extend
                for k, curve in enumerate(mapping.curves):
                    curve.points.new(0.3, 0.5 + 0.1 * k)
                    curve.points[0].location[1] += 0.05 * k
                mapping.curves[0].points[-1].location = (0.8, 0.7)
                mapping.update()
                sockets = list(node.inputs)[:2]
                value = s.number(0, 1.4) if kind == "FloatCurve" else s.vector((1.4,) * 3)
                return s.feed(node, s.number(1, 0.3, 0.7), value, into=sockets)

            compare(stage, build, f"{kind} {extend}")
