# mypy: disable-error-code="valid-type,attr-defined,func-returns-value"
"""The settings of a scene, `scene.komorebi`. Scripts rely on these names and defaults."""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
)

METHODS = (
    ("AMBIENT_OCCLUSION", "Ambient Occlusion", "How much of a white sky each point sees"),
    ("WORLD_LIGHT", "World Light", "Clay-coloured surfaces in the light of the world"),
)
AO_SAMPLINGS = (
    ("COSINE", "Cosine", "Rays by the cosine of their angle to the normal: the least noise"),
    ("UNIFORM", "Uniform", "Rays evenly over the hemisphere: same result, more noise"),
)
ENVIRONMENT_SAMPLINGS = (
    ("MIS", "Multiple Importance", "Both of the others, each where it is good at it"),
    ("COSINE", "Cosine", "Rays by the surface's cosine: good for even skies"),
    ("ENVIRONMENT", "Environment", "Rays by the map's brightness: good for small bright suns"),
)
PIXEL_FILTERS = (
    ("BLACKMAN_HARRIS", "Blackman-Harris", "Smooth and sharp"),
    ("GAUSSIAN", "Gaussian", "Smoother"),
    ("BOX", "Box", "Each pixel by itself"),
)


class KomorebiSceneSettings(bpy.types.PropertyGroup):
    """Settings of the Komorebi render engine"""

    method: EnumProperty(
        name="Method", description="What is computed", items=METHODS, default="AMBIENT_OCCLUSION"
    )
    samples: IntProperty(
        name="Samples", description="Camera samples a pixel", default=128, min=1, max=1 << 24
    )
    light_samples: IntProperty(
        name="Light Samples", description="Light rays for each camera sample",
        default=1, min=1, max=1024,
    )  # fmt: skip
    sample_offset: IntProperty(
        name="Sample Offset",
        description="First sample, to render one picture in parts on several machines",
        default=0, min=0, max=1 << 24,
    )  # fmt: skip
    seed: IntProperty(
        name="Seed", description="Another seed gives another pattern of noise",
        default=0, min=0, max=(1 << 31) - 1,
    )  # fmt: skip
    use_animated_seed: BoolProperty(
        name="Use Animated Seed", description="Another seed, and so another noise, in each frame",
        default=False,
    )  # fmt: skip
    ao_distance: FloatProperty(
        name="Distance", description="How far away things still darken a point; 0 is any distance",
        default=0.0, min=0.0, soft_max=100.0, subtype="DISTANCE",
    )  # fmt: skip
    ao_sampling: EnumProperty(
        name="Sampling", description="How rays are spread over the hemisphere",
        items=AO_SAMPLINGS, default="COSINE",
    )  # fmt: skip
    clay_color: FloatVectorProperty(
        name="Surface Color", description="Colour of every surface",
        subtype="COLOR", size=3, default=(0.8, 0.8, 0.8), min=0.0, max=1.0,
    )  # fmt: skip
    environment_sampling: EnumProperty(
        name="Environment Sampling", description="How rays towards the world are chosen",
        items=ENVIRONMENT_SAMPLINGS, default="MIS",
    )  # fmt: skip
    pixel_filter: EnumProperty(
        name="Filter", description="How samples around a pixel's centre are weighted",
        items=PIXEL_FILTERS, default="BLACKMAN_HARRIS",
    )  # fmt: skip
    filter_width: FloatProperty(
        name="Width", description="Width of the pixel filter",
        default=1.5, min=0.01, max=10.0, subtype="PIXEL",
    )  # fmt: skip
    use_progressive: BoolProperty(
        name="Progressive",
        description="Refine the whole frame step by step; off: finish one tile after the other",
        default=True,
    )  # fmt: skip


def register() -> None:
    bpy.utils.register_class(KomorebiSceneSettings)
    bpy.types.Scene.komorebi = PointerProperty(name="Komorebi Settings", type=KomorebiSceneSettings)


def unregister() -> None:
    del bpy.types.Scene.komorebi
    bpy.utils.unregister_class(KomorebiSceneSettings)
