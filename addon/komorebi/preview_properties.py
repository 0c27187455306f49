# mypy: disable-error-code="valid-type"
"""Settings that are the rendered viewport's alone, by Cycles' names where it has them."""

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

# Groups and their order are those of Cycles.
VIEW_PASSES = (
    ("", "General", ""),
    ("COMBINED", "Combined", "The picture"),
    ("EMISSION", "Emission", "What shines"),
    ("ENVIRONMENT", "Environment", "The world behind everything"),
    ("AO", "Ambient Occlusion", "How much of a white sky each point sees, within the distance"),
    ("SKY_VISIBILITY", "Sky Visibility", "The same at any distance"),
    ("SHADOW_CATCHER", "Shadow Catcher", "How much light things take from shadow catchers"),
    ("", "Light", ""),
    ("DIFFUSE_COLOR", "Diffuse Color", "The colour of surfaces"),
    ("BENT_NORMAL", "Bent Normal", "Where most light of a white sky comes from"),
    ("", "Data", ""),
    ("POSITION", "Position", "Where surfaces are"),
    ("NORMAL", "Normal", "Where surfaces face"),
    ("UV", "UV", "The active UV map"),
    ("DEPTH", "Depth", "How far away surfaces are"),
    ("MIST", "Mist", "How far away surfaces are, by the world's mist"),
    ("DENOISING_ALBEDO", "Denoising Albedo", "The colour of surfaces, for the denoiser"),
    ("DENOISING_NORMAL", "Denoising Normal", "Where surfaces face the view, for the denoiser"),
    ("SAMPLE_COUNT", "Sample Count", "Samples of each pixel, of the most that it may have"),
    ("OBJECT_INDEX", "Object Index", "The number that each object has been given"),
    ("MATERIAL_INDEX", "Material Index", "The number that each material has been given"),
    ("INSTANCE_INDEX", "Instance Index", "Another number for each instance"),
)
INPUT_PASSES = (
    ("RGB", "None", "The picture alone"),
    ("RGB_ALBEDO", "Albedo", "The colour of surfaces, too"),
    ("RGB_ALBEDO_NORMAL", "Albedo and Normal", "The colour of surfaces and where they face, too"),
)
PREFILTERS = (
    ("NONE", "None", "Albedo and normal as they are: as sharp as can be, their noise included"),
    ("FAST", "Fast", "Albedo and normal are taken to be as noisy as the picture is"),
    ("ACCURATE", "Accurate", "Albedo and normal are denoised first: the slowest"),
)
QUALITIES = (
    ("HIGH", "High", "The best picture"),
    ("BALANCED", "Balanced", "Between the two"),
    ("FAST", "Fast", "The picture that is there soonest"),
)


class PreviewSettings:
    """A part of KomorebiSceneSettings."""

    preview_samples: IntProperty(
        name="Viewport Samples",
        description="Camera samples a pixel in the viewport, with a noise threshold the most that "
        "one may take; 0 goes on for ever",
        default=64, min=0, max=1 << 24,
    )  # fmt: skip
    preview_start_resolution: IntProperty(
        name="Start Resolution",
        description="Pixels of the viewport's first picture along its longer side, unless more are "
        "quick; finer ones follow",
        default=128, min=8, max=16384, subtype="PIXEL",
    )  # fmt: skip
    preview_pause: BoolProperty(
        name="Pause Preview", description="The rendered viewport stands still", default=False
    )
    # Off and automatic for the reasons of use_adaptive_sampling.
    use_preview_adaptive_sampling: BoolProperty(
        name="Use Adaptive Sampling",
        description="Stop sampling each part of the viewport's picture when its noise is below "
        "the threshold",
        default=False,
    )
    preview_adaptive_threshold: FloatProperty(
        name="Noise Threshold",
        description="Noise at which sampling stops in the viewport: lower values cost more time; "
        "0 chooses it from the number of samples",
        default=0.0, min=0.0, max=1.0, precision=4,
    )  # fmt: skip
    preview_adaptive_min_samples: IntProperty(
        name="Min Samples",
        description="Samples before the first stop in the viewport, so that small features are "
        "not missed; 0 chooses it from the noise threshold",
        default=0, min=0, max=4096,
    )  # fmt: skip
    use_preview_denoising: BoolProperty(
        name="Use Viewport Denoising",
        description="Denoise the picture in the 3D viewport with Open Image Denoise",
        default=False,
    )
    # Of what ambient occlusion shows normals tell more than colours, so that both are the default.
    preview_denoising_input_passes: EnumProperty(
        name="Viewport Denoising Input Passes",
        description="What helps to tell noise from detail of colours and shapes",
        items=INPUT_PASSES, default="RGB_ALBEDO_NORMAL",
    )  # fmt: skip
    preview_denoising_prefilter: EnumProperty(
        name="Viewport Denoising Prefilter",
        description="What becomes of albedo and normal, which have noise where lenses, motion or "
        "fine detail blur them",
        items=PREFILTERS, default="FAST",
    )  # fmt: skip
    preview_denoising_quality: EnumProperty(
        name="Viewport Denoising Quality",
        description="How much time denoising takes for a better picture",
        items=QUALITIES, default="BALANCED",
    )  # fmt: skip
    preview_denoising_start_sample: IntProperty(
        name="Start Denoising", description="Samples before the viewport's picture is denoised",
        default=1, min=0, max=1 << 24,
    )  # fmt: skip
