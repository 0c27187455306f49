"""Procedural textures beside Cycles."""

import itertools

import bpy
from node_beside_cycles import MOST, Stage, compare

DIMENSIONS = ("1D", "2D", "3D", "4D")
# Where two cells are equally near the last bit decides: of 1152 points at two.
BORDERS = 2e-3


def has_node(kind):
    return hasattr(bpy.types, "ShaderNode" + kind)


def choices(kind, name):
    """The identifiers that an enumeration of a node has."""
    return [item.identifier for item in getattr(bpy.types, "ShaderNode" + kind).bl_rna
            .properties[name].enum_items]  # fmt: skip


def texture(stage, kind, output=None, given=None, vector=(1, 1, 1), w=0.7, **properties):
    """A texture node that looks at place() · vector, with inputs by identifier; its output."""
    node = stage.new(kind, **properties)
    for socket in node.inputs:
        if not socket.enabled:
            continue
        if socket.identifier == "Vector":
            stage.link(stage.vector(vector, (0.11, -0.23, 0.37)), socket)
        elif socket.identifier == "W":
            stage.link(stage.number(0, w, 0.19), socket)
        elif given and socket.identifier in given:
            value = given[socket.identifier]
            if isinstance(value, bpy.types.NodeSocket):
                stage.link(value, socket)
            else:
                socket.default_value = value
    if output is None:
        return next(s for s in node.outputs if s.enabled)
    return next(s for s in node.outputs if s.identifier == output)


def check(stage, name, kind, *outputs, **more):
    """Compares outputs of a texture; `more` is of texture()."""
    for output in outputs:
        most = BORDERS if kind == "TexVoronoi" and output in {"Color", "Position", "W"} else MOST
        compare(stage, lambda s, output=output: texture(s, kind, output, **more),
                f"{kind} {name} {output}", most)  # fmt: skip


def test_white_noise():
    stage = Stage()
    # Cells in which it is the same, so that the last bit of a coordinate does not matter.
    for dimensions in DIMENSIONS:

        def build(s, dimensions=dimensions, output="Color"):
            node = s.new("TexWhiteNoise", noise_dimensions=dimensions)
            for socket in node.inputs:
                if socket.identifier == "W":
                    s.link(s.feed(s.new("Math", operation="FLOOR"), s.number(0, 5.0)), socket)
                else:
                    floor = s.new("VectorMath", operation="FLOOR")
                    s.link(s.vector((5, 6, 7)), floor.inputs[0])
                    s.link(floor.outputs[0], socket)
            return node.outputs[output]

        for output in ("Color", "Value"):
            compare(stage, lambda s, o=output, f=build: f(s, output=o),
                    f"White Noise {dimensions} {output}")  # fmt: skip


def test_noise():
    stage = Stage()
    for dimensions in DIMENSIONS:
        for detail, roughness, distortion in ((0.0, 0.5, 0.0), (2.0, 0.4, 0.0), (3.6, 0.7, 1.3)):
            given = {"Detail": detail, "Roughness": roughness, "Distortion": distortion,
                     "Scale": 3.0, "Lacunarity": 2.3}  # fmt: skip
            check(stage, f"{dimensions} {detail}", "TexNoise", "Fac", "Color", given=given,
                  noise_dimensions=dimensions)  # fmt: skip


def test_noise_inputs_that_vary():
    stage = Stage()
    for name, scale, offset in (("Detail", 4.0, 3.0), ("Roughness", 0.6, 0.5), ("Scale", 4.0, 3.0),
                                ("Distortion", 2.0, 0.0), ("Lacunarity", 1.0, 2.0)):  # fmt: skip

        def build(s, name=name, scale=scale, offset=offset):
            given = {"Detail": 2.5, name: s.number(2, scale, offset)}
            return texture(s, "TexNoise", "Fac", given=given)

        compare(stage, build, f"Noise with {name} linked")


def test_noise_types():
    if "noise_type" not in bpy.types.ShaderNodeTexNoise.bl_rna.properties:
        return
    stage = Stage()
    for kind, dimensions in itertools.product(choices("TexNoise", "noise_type"), DIMENSIONS):
        for detail in (0.0, 3.0, 2.4):
            given = {"Detail": detail, "Roughness": 0.6, "Lacunarity": 2.2, "Offset": 0.8,
                     "Gain": 1.4, "Scale": 2.5, "Distortion": 0.3}  # fmt: skip
            check(stage, f"{kind} {dimensions} {detail}", "TexNoise", "Fac", given=given,
                  noise_dimensions=dimensions, noise_type=kind, normalize=False)  # fmt: skip


def test_musgrave():
    if not has_node("TexMusgrave"):
        return
    stage = Stage()
    for kind, dimensions in itertools.product(choices("TexMusgrave", "musgrave_type"), DIMENSIONS):
        for detail, dimension in ((0.0, 2.0), (0.6, 1.0), (1.0, 0.5), (3.0, 0.0), (4.3, 0.7)):
            given = {"Detail": detail, "Dimension": dimension, "Lacunarity": 2.2, "Offset": 0.8,
                     "Gain": 1.4, "Scale": 2.5}  # fmt: skip
            check(stage, f"{kind} {dimensions} {detail}", "TexMusgrave", "Fac", given=given,
                  musgrave_dimensions=dimensions, musgrave_type=kind)  # fmt: skip


def test_noise_far_away():
    """Where floats do not tell the places in a cell apart, releases differ."""
    stage = Stage()
    for power in (13, 17, 21, 32):  # of two, so that nothing is rounded

        def build(s, power=power):
            node = s.new("TexNoise")
            node.inputs["Scale"].default_value = 1.0
            node.inputs["Detail"].default_value = 0.0
            s.link(s.vector((2.0**power,) * 3), node.inputs["Vector"])
            return node.outputs[0]

        compare(stage, build, f"Noise at 2^{power}")


def voronoi_outputs(feature, dimensions):
    if feature == "DISTANCE_TO_EDGE":
        return ("Distance",)
    if feature == "N_SPHERE_RADIUS":
        return ("Radius",)
    place = {"1D": ("W",), "4D": ("Position", "W")}.get(dimensions, ("Position",))
    return ("Distance", "Color", *place)


def test_voronoi():
    stage = Stage()
    for feature, dimensions in itertools.product(choices("TexVoronoi", "feature"), DIMENSIONS):
        given = {"Scale": 2.0, "Randomness": 0.9, "Smoothness": 0.7}
        check(stage, f"{feature} {dimensions}", "TexVoronoi",
              *voronoi_outputs(feature, dimensions), given=given, feature=feature,
              voronoi_dimensions=dimensions)  # fmt: skip


def test_voronoi_metrics():
    stage = Stage()
    for metric, feature in itertools.product(choices("TexVoronoi", "distance"),
                                             ("F1", "F2", "SMOOTH_F1")):  # fmt: skip
        for dimensions in ("2D", "3D", "4D"):
            for exponent in (0.5, 3.0) if metric == "MINKOWSKI" else (1.0,):
                given = {"Scale": 2.0, "Exponent": exponent, "Smoothness": 0.4}
                check(stage, f"{metric} {feature} {dimensions} {exponent}", "TexVoronoi",
                      "Distance", "Color", given=given, feature=feature, distance=metric,
                      voronoi_dimensions=dimensions)  # fmt: skip
    given = {"Scale": 2.0, "Exponent": 0.2}  # distances above 8, which 3.4 does not find
    check(stage, "MINKOWSKI 0.2", "TexVoronoi", "Distance", "Color", given=given, feature="F1",
          distance="MINKOWSKI")  # fmt: skip


def test_voronoi_octaves():
    if "normalize" not in bpy.types.ShaderNodeTexVoronoi.bl_rna.properties:
        return
    stage = Stage()
    for feature in ("F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE"):
        for dimensions, normalize in itertools.product(DIMENSIONS, (False, True)):
            for detail, roughness in ((1.0, 0.6), (2.4, 0.4), (2.0, 0.0)):
                given = {"Scale": 2.0, "Detail": detail, "Roughness": roughness,
                         "Lacunarity": 2.2, "Smoothness": 0.5}  # fmt: skip
                check(stage, f"{feature} {dimensions} {normalize} {detail}", "TexVoronoi",
                      *voronoi_outputs(feature, dimensions)[:3], given=given, feature=feature,
                      voronoi_dimensions=dimensions, normalize=normalize)  # fmt: skip


def test_voronoi_inputs_that_vary():
    stage = Stage()
    for name, scale, offset in (("Smoothness", 1.0, 0.3), ("Randomness", 1.2, 0.5),
                                ("Scale", 2.0, 0.0), ("Exponent", 1.0, 1.5),
                                ("Detail", 2.0, 1.5), ("Roughness", 0.7, 0.5)):  # fmt: skip

        def build(s, name=name, scale=scale, offset=offset):
            given = {name: s.number(2, scale, offset)}
            if name == "Roughness":
                given["Detail"] = 1.5
            return texture(s, "TexVoronoi", "Color", given=given, feature="SMOOTH_F1",
                           distance="MINKOWSKI")  # fmt: skip

        compare(stage, build, f"Voronoi with {name} linked", BORDERS)


def test_wave():
    stage = Stage()
    directions = [("BANDS", "bands_direction", d) for d in choices("TexWave", "bands_direction")]
    directions += [("RINGS", "rings_direction", d) for d in choices("TexWave", "rings_direction")]
    for kind, name, direction in directions:
        for profile in choices("TexWave", "wave_profile"):
            given = {"Scale": 0.4, "Phase Offset": 0.3}
            check(stage, f"{kind} {direction} {profile}", "TexWave", "Fac", given=given,
                  wave_type=kind, wave_profile=profile, **{name: direction})  # fmt: skip
    given = {"Scale": 0.4, "Distortion": 2.5, "Detail": 2.6, "Detail Scale": 1.7,
             "Detail Roughness": 0.6}  # fmt: skip
    check(stage, "distorted", "TexWave", "Fac", "Color", given=given)


def test_magic():
    stage = Stage()
    for depth in range(11):
        for distortion in (0.0, 1.0, 1.7):
            given = {"Scale": 1.2, "Distortion": distortion}
            check(stage, f"{depth} {distortion}", "TexMagic", "Color", given=given,
                  turbulence_depth=depth)  # fmt: skip
    check(stage, "mean", "TexMagic", "Fac", given={"Scale": 1.2})
    check(stage, "far", "TexMagic", "Color", given={"Scale": 1.2}, vector=(20, 30, 25))


def test_gradient():
    stage = Stage()
    for kind in choices("TexGradient", "gradient_type"):
        check(stage, kind, "TexGradient", "Fac", "Color", gradient_type=kind)


def test_checker():
    stage = Stage()
    given = {"Scale": 2.7, "Color1": (0.8, 0.1, 0.2, 1.0), "Color2": (0.1, 0.3, 0.9, 1.0)}
    check(stage, "", "TexChecker", "Fac", "Color", given=given)
    check(stage, "without a vector", "TexChecker", "Color", vector=(0, 0, 0))


def test_brick():
    stage = Stage()
    given = {"Scale": 2.7, "Color1": (0.8, 0.1, 0.2, 1.0), "Color2": (0.1, 0.3, 0.9, 1.0),
             "Mortar": (0.3, 0.6, 0.1, 1.0), "Mortar Size": 0.04, "Mortar Smooth": 0.3,
             "Bias": 0.1, "Brick Width": 0.6, "Row Height": 0.27}  # fmt: skip
    check(stage, "", "TexBrick", "Fac", "Color", given=given)
    check(stage, "offset", "TexBrick", "Fac", "Color", given=given, offset=0.3,
          offset_frequency=3, squash=1.6, squash_frequency=2)  # fmt: skip
    check(stage, "frequency 1", "TexBrick", "Color", given=given, offset_frequency=1)
    check(stage, "sharp", "TexBrick", "Color", given={**given, "Mortar Smooth": 0.0})


def test_gabor():
    if not has_node("TexGabor"):
        return
    stage = Stage()
    for kind in choices("TexGabor", "gabor_type"):
        for anisotropy in (1.0, 0.4, 0.0):
            given = {"Scale": 2.0, "Frequency": 1.8, "Anisotropy": anisotropy,
                     "Orientation 2D": 0.7, "Orientation 3D": (0.4, 0.9, -0.6)}  # fmt: skip
            check(stage, f"{kind} {anisotropy}", "TexGabor", "Value", "Phase", "Intensity",
                  given=given, gabor_type=kind)  # fmt: skip


def test_own_mapping():
    stage = Stage()

    def build(s, kind, axes, scale):
        output = texture(s, "TexGradient", "Color")
        own = output.node.texture_mapping
        own.vector_type = kind
        own.translation, own.rotation, own.scale = (0.3, -0.2, 0.5), (0.4, -0.7, 1.1), scale
        own.mapping_x, own.mapping_y, own.mapping_z = axes
        return output

    for kind in ("POINT", "TEXTURE", "VECTOR", "NORMAL"):
        for axes in ("XYZ", "ZXY", ("Y", "NONE", "X")):
            for scale in ((0.5, 2.0, -1.5), (1.0, 0.0, 1.0)):
                if kind in ("TEXTURE", "NORMAL") and 0.0 in scale:
                    continue  # a hundred thousand times as large: floats of all kinds
                compare(
                    stage, lambda s, given=(kind, tuple(axes), scale): build(s, *given),
                    f"{kind} {axes} {scale}",
                )  # fmt: skip


def test_unlinked_vector():
    """Then a world's texture is looked up where it is seen."""
    stage = Stage()
    for kind in ("TexNoise", "TexVoronoi", "TexWave", "TexMagic", "TexGradient", "TexChecker",
                 "TexBrick"):  # fmt: skip
        compare(stage, lambda s, kind=kind: s.new(kind).outputs["Color"], f"{kind}, unlinked")


def test_what_is_not_rendered():
    stage = Stage()
    if has_node("TexPointDensity"):  # until 4.5
        stage.ours(stage.new("TexPointDensity").outputs["Color"])
        assert len(stage.warnings) == 1, stage.warnings
    stage.ours(stage.new("TexIES").outputs[0])
    assert len(stage.warnings) == 1, stage.warnings


def test_bad_input():
    """No number crashes; what comes out need not be the same."""
    stage = Stage()
    for value in (0.0, -1.0, float("inf"), float("nan"), 3e38):
        for kind in ("TexNoise", "TexVoronoi", "TexWave", "TexMagic", "TexBrick", "TexGabor",
                     "TexWhiteNoise", "TexChecker", "TexGradient", "TexMusgrave"):  # fmt: skip
            if not has_node(kind):
                continue
            node = stage.new(kind)
            bad = stage.new("Value")
            bad.outputs[0].default_value = value
            for socket in node.inputs:
                if socket.type in {"VALUE", "VECTOR"}:
                    stage.link(bad.outputs[0], socket)
            for output in node.outputs:
                stage.ours(output)
