"""The engine, its properties and its panels, as scripts and users find them."""

import bpy
import komorebi
import support

DEFAULTS = {
    "method": "AMBIENT_OCCLUSION", "samples": 32, "light_samples": 0, "sample_offset": 0,
    "use_adaptive_sampling": False, "adaptive_threshold": 0.0, "adaptive_min_samples": 0,
    "use_preview_adaptive_sampling": False, "preview_adaptive_threshold": 0.0,
    "preview_adaptive_min_samples": 0, "use_preview_denoising": False,
    "preview_denoising_input_passes": "RGB_ALBEDO_NORMAL", "preview_denoising_prefilter": "FAST",
    "preview_denoising_quality": "BALANCED", "preview_denoising_start_sample": 1,
    "time_limit": 0.0, "use_denoising": False,
    "seed": 0, "use_animated_seed": False, "ao_distance": 0.0, "ao_sampling": "COSINE",
    "environment_sampling": "PRODUCT", "pixel_filter": "BLACKMAN_HARRIS", "filter_width": 1.5,
    "use_progressive": True, "bounces": 2, "ao_indirect_bounces": 0, "sample_clamp_direct": 0.0,
    "sample_clamp_indirect": 10.0, "use_fast_gi": False, "fast_gi_method": "REPLACE",
    "ao_bounces": 1, "ao_bounces_render": 1,
}  # fmt: skip
ITEMS = {
    "method": ["AMBIENT_OCCLUSION", "WORLD_LIGHT"],
    "ao_sampling": ["COSINE", "UNIFORM"],
    "fast_gi_method": ["REPLACE", "ADD"],
    "environment_sampling": ["MIS", "COSINE", "ENVIRONMENT", "PRODUCT"],
    "pixel_filter": ["BLACKMAN_HARRIS", "GAUSSIAN", "BOX"],
}

INHERITED = (
    "DATA_PT_lens", "DATA_PT_camera", "RENDER_PT_format", "RENDER_PT_color_management",
    "WORLD_PT_context_world", "VIEWLAYER_PT_layer", "DATA_PT_camera_dof",
    "DATA_PT_camera_stereoscopy", "PARTICLE_PT_render", "PARTICLE_PT_hair_shape", "RENDER_PT_gpencil",
    "RENDER_PT_freestyle", "VIEWLAYER_PT_freestyle", "MATERIAL_PT_freestyle_line",
    "EEVEE_MATERIAL_PT_context_material", "RENDER_PT_post_processing",
)  # fmt: skip


def panels():
    return bpy.types.Panel.__subclasses__()


def test_defaults_are_the_fixed_ones():
    settings = bpy.data.scenes.new("Fresh").komorebi
    for name, value in DEFAULTS.items():
        assert getattr(settings, name) == value, (name, getattr(settings, name))
    assert all(abs(c - 0.8) < 1e-6 for c in settings.clay_color)
    for name, items in ITEMS.items():
        assert [i.identifier for i in settings.bl_rna.properties[name].enum_items] == items


def test_engine_can_be_chosen():
    scene = bpy.context.scene
    scene.render.engine = "KOMOREBI"
    assert scene.render.engine == "KOMOREBI"
    labels = {
        getattr(e, "bl_idname", ""): getattr(e, "bl_label", "")
        for e in bpy.types.RenderEngine.__subclasses__()
    }
    assert labels["KOMOREBI"] == "Komorebi"


def test_own_panels_show_in_no_other_engine():
    own = [p for p in panels() if p.__name__.startswith("KOMOREBI_")]
    assert len(own) >= 9
    for panel in own:
        assert {"KOMOREBI"} == panel.COMPAT_ENGINES, panel


def test_blenders_panels_are_inherited():
    ours = {p.__name__ for p in panels() if "KOMOREBI" in getattr(p, "COMPAT_ENGINES", ())}
    for name in INHERITED:
        assert name in ours, name
    for name in ("OBJECT_PT_visibility", "VIEWLAYER_PT_layer_passes", "DATA_PT_light"):
        assert name not in ours, name


def test_unregister_takes_everything_out_and_register_brings_it_back():
    before = {p.__name__ for p in panels() if "KOMOREBI" in getattr(p, "COMPAT_ENGINES", ())}
    komorebi.unregister()
    try:
        left = {p.__name__ for p in panels() if "KOMOREBI" in getattr(p, "COMPAT_ENGINES", ())}
        assert all(name.startswith("KOMOREBI_") for name in left), left
        assert not [name for name in dir(bpy.types) if name.startswith("KOMOREBI_")]
        assert not hasattr(bpy.types.Scene, "komorebi")
        for name in dir(bpy.app.handlers):
            functions = getattr(bpy.app.handlers, name)
            if isinstance(functions, list):
                assert not [f for f in functions if f.__module__.startswith("komorebi")], name
        komorebi.unregister()  # a second time changes nothing
    finally:
        komorebi.register()
        komorebi.register()
    after = {p.__name__ for p in panels() if "KOMOREBI" in getattr(p, "COMPAT_ENGINES", ())}
    assert before == after


def test_works_without_cycles(folder):
    done = support.script(
        "import addon_utils, bpy\naddon_utils.disable('cycles')\n"
        "assert not hasattr(bpy.types.Scene, 'cycles')\n"
        "support.small(bpy.context.scene)\n"
        f"bpy.context.scene.render.filepath = {str(folder / 'picture.png')!r}\n"
        "bpy.ops.render.render(write_still=True)\n",
        folder,
    )
    assert done.code == 0 and support.pictures(folder) == ["picture.png"], done


def test_callbacks_of_properties_keep_nothing_alive():
    """What they know lives to the end of the process; a `bpy` module up to 4.2 crashes there."""
    import types

    from komorebi import properties

    found = set()
    for group in (properties.KomorebiSceneSettings, properties.KomorebiViewLayerSettings):
        for declared in group.__annotations__.values():
            found |= {v for v in declared.keywords.values() if isinstance(v, types.FunctionType)}
    assert found, "properties have callbacks, and keywords tell them"
    for function in found:
        known = [k for k in function.__globals__ if not k.startswith("__")]
        assert known == ["update_render_passes", "studio_light_names"], (
            f"{function.__module__} knows {known}"
        )


def test_a_process_ends_in_success(folder):
    for text in ("", "import bpy\nsupport.small(bpy.context.scene)\nbpy.ops.render.render()\n"):
        done = support.script(text, folder)
        assert done.code == 0, done
