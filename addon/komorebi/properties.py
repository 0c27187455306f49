# mypy: disable-error-code="valid-type,attr-defined,func-returns-value"
"""The settings of a scene, `scene.komorebi`. Scripts rely on these names and defaults."""

from math import pi

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from .callbacks import studio_light_names, update_render_passes
from .preview_properties import VIEW_PASSES, PreviewSettings

METHODS = (
    ("AMBIENT_OCCLUSION", "Ambient Occlusion", "How much of a white sky each point sees"),
    ("WORLD_LIGHT", "World Light", "Surfaces in the light of the world"),
)
SURFACES = (
    ("MATERIAL", "Material", "Every surface as its material says"),
    ("CLAY", "Clay", "One colour for all, to see nothing but shape and light"),
)
CLAY_GLASS = (
    ("SKIP", "Skip", "Glass and what else is clear is left out, so that one sees what is behind"),
    ("CLAY", "Clay", "Glass is clay like everything else"),
)
SKIES = (
    ("SCENE", "Scene", "The world of the scene"),
    ("STUDIO", "Studio Light", "One of Blender's studio lights; the scene's world stays as it is"),
    ("WHITE", "White", "The same white light from everywhere"),
)
AO_SAMPLINGS = (
    ("COSINE", "Cosine", "Rays by the cosine of their angle to the normal: the least noise"),
    ("UNIFORM", "Uniform", "Rays evenly over the hemisphere: same result, more noise"),
)
ENVIRONMENT_SAMPLINGS = (
    ("MIS", "Multiple Importance", "The next two together, each where it is good at it"),
    ("COSINE", "Cosine", "Rays by the surface's cosine: good for even skies"),
    ("ENVIRONMENT", "Environment", "Rays by the map's brightness: good for small bright suns"),
    ("PRODUCT", "Product", "In proportion to the light's brightness times the surface's cosine"),
)
FAST_GI_METHODS = (
    ("REPLACE", "Replace", "After some bounces ambient occlusion is all that is left of the light"),
    ("ADD", "Add", "White ambient light comes to every surface besides"),
)
PIXEL_FILTERS = (
    ("BLACKMAN_HARRIS", "Blackman-Harris", "Smooth and sharp"),
    ("GAUSSIAN", "Gaussian", "Smoother"),
    ("BOX", "Box", "Each pixel by itself"),
)


class KomorebiViewSettings(bpy.types.PropertyGroup):
    """Settings of Komorebi in one 3D viewport"""

    render_pass: EnumProperty(
        name="Render Pass", description="What the rendered viewport shows", items=VIEW_PASSES,
        default="COMBINED",
    )  # fmt: skip


class KomorebiSceneSettings(PreviewSettings, bpy.types.PropertyGroup):
    """Settings of the Komorebi render engine"""

    method: EnumProperty(
        name="Method", description="What is computed", items=METHODS, default="AMBIENT_OCCLUSION"
    )
    samples: IntProperty(
        name="Samples",
        description="Camera samples a pixel; with a noise threshold the most that one may take",
        default=32, min=1, max=1 << 24,
    )  # fmt: skip
    # Off, though Cycles has it on: at these few samples it is no sooner at the same error (ambient
    # occlusion, 192 × 108: 0.0047 in 0.78 s both ways; 8 % sooner at 0.0028), and parts of a
    # picture that are to be put together need every sample. The threshold is automatic, for
    # Cycles' 0.01 lies above the error of 64 samples: it would stop everywhere at once.
    use_adaptive_sampling: BoolProperty(
        name="Use Adaptive Sampling",
        description="Stop sampling each part of the picture when its noise is below the threshold",
        default=False,
    )
    adaptive_threshold: FloatProperty(
        name="Noise Threshold",
        description="Noise at which sampling stops: lower values cost more time; "
        "0 chooses it from the number of samples",
        default=0.0, min=0.0, max=1.0, precision=4,
    )  # fmt: skip
    adaptive_min_samples: IntProperty(
        name="Min Samples",
        description="Samples before the first stop, so that small features are not missed; "
        "0 chooses it from the noise threshold",
        default=0, min=0, max=4096,
    )  # fmt: skip
    time_limit: FloatProperty(
        name="Time Limit",
        description="Ends the render after the samples that fit in this time, scene export and "
        "build not counted; 0 is no limit. The log says how many samples there were",
        default=0.0, min=0.0, step=100, unit="TIME_ABSOLUTE",
    )  # fmt: skip
    light_samples: IntProperty(
        name="Light Samples",
        description="Light rays for each camera sample; 0 is automatic: 8, or 4 where "
        "better, with bounces down to 1",
        default=0, min=0, max=1024,
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
    use_denoising: BoolProperty(
        name="Use Denoising",
        description="Denoise the picture with Open Image Denoise, guided by albedo and normal; "
        "the pass Noisy Image keeps it as it was",
        default=False, update=update_render_passes,
    )  # fmt: skip
    ao_distance: FloatProperty(
        name="Distance", description="How far away things still darken a point; 0 is any distance",
        default=0.0, min=0.0, soft_max=100.0, subtype="DISTANCE",
    )  # fmt: skip
    ao_sampling: EnumProperty(
        name="Sampling", description="How rays are spread over the hemisphere",
        items=AO_SAMPLINGS, default="COSINE",
    )  # fmt: skip
    sky: EnumProperty(
        name="Sky", description="What lights the scene, and is seen behind it",
        items=SKIES, default="SCENE",
    )  # fmt: skip
    sky_studio_light: StringProperty(
        name="Studio Light", description="The file of the studio light, as Blender has it",
        default="forest.exr", search=studio_light_names,
    )  # fmt: skip
    sky_rotation: FloatProperty(
        name="Rotation", description="Turns the studio light about the vertical",
        default=0.0, soft_min=-pi, soft_max=pi, subtype="ANGLE",
    )  # fmt: skip
    sky_strength: FloatProperty(
        name="Strength", description="Brightness of the studio light, or of the white",
        default=1.0, min=0.0, soft_max=10.0,
    )  # fmt: skip
    surface: EnumProperty(
        name="Surface", description="What surfaces look like", items=SURFACES, default="MATERIAL"
    )
    clay_glass: EnumProperty(
        name="Glass", description="What becomes of glass under clay",
        items=CLAY_GLASS, default="SKIP",
    )  # fmt: skip
    clay_bump: BoolProperty(
        name="Bump and Normal Maps", description="Clay keeps the relief that materials draw",
        default=False,
    )  # fmt: skip
    clay_color: FloatVectorProperty(
        name="Clay Color", description="Colour of every surface under clay",
        subtype="COLOR", size=3, default=(0.8, 0.8, 0.8), min=0.0, max=1.0,
    )  # fmt: skip
    bounces: IntProperty(
        name="Bounces",
        description="How often light goes from surface to surface under World Light: 0 is what "
        "comes straight from the world; each more brightens what faces other surfaces",
        default=2, min=0, max=1024, soft_max=16,
    )  # fmt: skip
    # Not Blender's ao_bounces, which are those of Fast GI.
    ao_indirect_bounces: IntProperty(
        name="Bounces",
        description="How often the white sky's light goes from surface to surface before it comes "
        "to what is seen: 0 is plain ambient occlusion",
        default=0, min=0, max=1024, soft_max=16,
    )  # fmt: skip
    sample_clamp_direct: FloatProperty(
        name="Direct Light",
        description="Most that a sample may bring without a bounce, to the picture too: takes away "
        "bright specks, and light with them; 0 is no limit",
        default=0.0, min=0.0, max=1e8,
    )  # fmt: skip
    sample_clamp_indirect: FloatProperty(
        name="Indirect Light",
        description="Most that a sample may bring after each bounce: takes away bright specks, and "
        "light with them; 0 is no limit",
        default=10.0, min=0.0, max=1e8,
    )  # fmt: skip
    # Names, meaning and values of these four are those of Cycles; its factor and distance are the
    # world's own.
    use_fast_gi: BoolProperty(
        name="Fast GI Approximation",
        description="For previews under World Light: ambient occlusion, coloured by the world, in "
        "place of light that bounces often, or besides",
        default=False,
    )
    fast_gi_method: EnumProperty(
        name="Method", description="What ambient occlusion does to the light",
        items=FAST_GI_METHODS, default="REPLACE",
    )  # fmt: skip
    ao_bounces: IntProperty(
        name="Viewport Bounces",
        description="Likewise as Render Bounces, in the rendered viewport",
        default=1, min=0, max=1024,
    )  # fmt: skip
    ao_bounces_render: IntProperty(
        name="Render Bounces",
        description="How often light may come from a surface, the last time by ambient occlusion: "
        "1 is ambient occlusion of what is seen; 0 switches the approximation off",
        default=1, min=0, max=1024,
    )  # fmt: skip
    environment_sampling: EnumProperty(
        name="Environment Sampling", description="How rays towards the world are chosen",
        items=ENVIRONMENT_SAMPLINGS, default="PRODUCT",
    )  # fmt: skip
    film_exposure: FloatProperty(
        name="Exposure", description="Brightness of the picture under World Light",
        default=1.0, min=0.0, max=10.0,
    )  # fmt: skip
    pixel_filter: EnumProperty(
        name="Filter", description="How samples around a pixel's centre are weighted",
        items=PIXEL_FILTERS, default="BLACKMAN_HARRIS",
    )  # fmt: skip
    world_resolution: IntProperty(
        name="World Map Resolution",
        description="Columns of pixels of the map that lights the scene where the world is more "
        "than one picture; 0 is automatic: 1024, or as many as its largest picture has",
        default=0, min=0, max=16384,
    )  # fmt: skip
    texture_limit: IntProperty(
        name="Texture Limit",
        description="Memory in MiB that pictures on surfaces may take together; when there are "
        "more, the largest are rendered at half their width, and a warning says so",
        default=1024, min=16, soft_max=65536,
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


class KomorebiMaterialSettings(bpy.types.PropertyGroup):
    """Settings of a material for the Komorebi render engine"""

    exclude_from_clay: BoolProperty(
        name="Exclude from Clay", description="Keeps its own look where all else is clay",
        default=False,
    )  # fmt: skip


class KomorebiViewLayerSettings(bpy.types.PropertyGroup):
    """Settings of a view layer for the Komorebi render engine"""

    pass_debug_sample_count: BoolProperty(
        name="Debug Sample Count",
        description="Camera samples of each pixel, as a fraction of the most that it may have",
        default=False, update=update_render_passes,
    )  # fmt: skip
    use_pass_instance_index: BoolProperty(
        name="Instance Index", description="Another number for each instance, from 1 on",
        default=False, update=update_render_passes,
    )  # fmt: skip
    use_pass_variance: BoolProperty(
        name="Variance", description="Variance of the samples of each pixel",
        default=False, update=update_render_passes,
    )  # fmt: skip
    use_pass_sky_visibility: BoolProperty(
        name="Sky Visibility",
        description="How much of a white sky each point sees, however far away what hides it is",
        default=False, update=update_render_passes,
    )  # fmt: skip
    use_pass_bent_normal: BoolProperty(
        name="Bent Normal", description="Direction from which most light of a white sky comes",
        default=False, update=update_render_passes,
    )  # fmt: skip
    # Cycles has these two of its own, which count where it is enabled.
    denoising_store_passes: BoolProperty(
        name="Denoising Data", description="Normal, albedo and depth for the compositor's denoiser",
        default=False, update=update_render_passes,
    )  # fmt: skip
    use_pass_shadow_catcher: BoolProperty(
        name="Shadow Catcher",
        description="How much light things take from shadow catchers, to multiply a picture by",
        default=False, update=update_render_passes,
    )  # fmt: skip


def register() -> None:
    bpy.utils.register_class(KomorebiSceneSettings)
    bpy.utils.register_class(KomorebiMaterialSettings)
    bpy.utils.register_class(KomorebiViewLayerSettings)
    bpy.utils.register_class(KomorebiViewSettings)
    bpy.types.Scene.komorebi = PointerProperty(name="Komorebi Settings", type=KomorebiSceneSettings)
    bpy.types.Material.komorebi = PointerProperty(
        name="Komorebi Material Settings", type=KomorebiMaterialSettings
    )
    bpy.types.ViewLayer.komorebi = PointerProperty(
        name="Komorebi View Layer Settings", type=KomorebiViewLayerSettings
    )
    bpy.types.View3DShading.komorebi = PointerProperty(
        name="Komorebi View Settings", type=KomorebiViewSettings
    )


def unregister() -> None:
    del bpy.types.View3DShading.komorebi
    del bpy.types.ViewLayer.komorebi
    del bpy.types.Material.komorebi
    del bpy.types.Scene.komorebi
    bpy.utils.unregister_class(KomorebiViewSettings)
    bpy.utils.unregister_class(KomorebiViewLayerSettings)
    bpy.utils.unregister_class(KomorebiMaterialSettings)
    bpy.utils.unregister_class(KomorebiSceneSettings)
