"""What stands for each panel, menu and header of Cycles while Komorebi is chosen.

docs/panels.md is made from these tables (panels_document.py), and test_panels.py holds them against
Cycles' own `ui.py` in every release.
"""

VOLUMES = "volumes are not rendered"
LINKING = "lamps light all objects"
LAMP_NODES = "a light's nodes are edited in the node editor"
LAMP_SETTINGS = "one strategy finds lamps, and its choice among many has no settings"
GUIDING = "light rays are guided by what surfaces see of the sky, bounces by the cosine alone"
OWN_DISTANCE = "all objects have the world's AO distance"
VIEWPORT = "presets, hair and debugging of the viewport are not there"
BAKING = "there is no baking"
MATERIALS = "displacement is always relief, and surfaces that shine light nothing else yet"
COPY = "a copy for the node editor of what the properties editor shows"
DEBUG = "for developers of Cycles"
LIGHT_GROUPS = "there are no light groups: all light is in one picture"

# Cycles' class (or function that it appends to one of Blender's) → ours.
REPLACED = {
    "CYCLES_RENDER_PT_sampling": "KOMOREBI_RENDER_PT_sampling",
    "CYCLES_RENDER_PT_sampling_render": "KOMOREBI_RENDER_PT_sampling_render",
    "CYCLES_RENDER_PT_sampling_render_denoise": "KOMOREBI_RENDER_PT_sampling_render_denoise",
    "CYCLES_RENDER_PT_sampling_viewport_denoise": ("KOMOREBI_RENDER_PT_sampling_viewport_denoise"),
    "CYCLES_RENDER_PT_sampling_advanced": "KOMOREBI_RENDER_PT_sampling_advanced",
    "CYCLES_RENDER_PT_sampling_advanced_sample_subset": "KOMOREBI_RENDER_PT_sampling_advanced",
    "CYCLES_RENDER_PT_light_paths": "KOMOREBI_RENDER_PT_light_paths",
    "CYCLES_RENDER_PT_light_paths_max_bounces": "KOMOREBI_RENDER_PT_light_paths_max_bounces",
    "CYCLES_RENDER_PT_light_paths_clamping": "KOMOREBI_RENDER_PT_light_paths_clamping",
    "CYCLES_RENDER_PT_light_paths_fast_gi": "KOMOREBI_RENDER_PT_light_paths_fast_gi",
    "CYCLES_RENDER_PT_curves": "KOMOREBI_RENDER_PT_curves",
    "CYCLES_RENDER_PT_simplify": "KOMOREBI_RENDER_PT_simplify",
    "CYCLES_RENDER_PT_simplify_viewport": "KOMOREBI_RENDER_PT_simplify_viewport",
    "CYCLES_RENDER_PT_simplify_render": "KOMOREBI_RENDER_PT_simplify_render",
    "CYCLES_VIEW3D_PT_simplify_greasepencil": "KOMOREBI_RENDER_PT_simplify_greasepencil",
    "CYCLES_RENDER_PT_motion_blur": "KOMOREBI_RENDER_PT_motion_blur",
    "CYCLES_RENDER_PT_motion_blur_curve": "KOMOREBI_RENDER_PT_motion_blur_curve",
    "CYCLES_RENDER_PT_film": "KOMOREBI_RENDER_PT_film",
    "CYCLES_RENDER_PT_film_pixel_filter": "KOMOREBI_RENDER_PT_film_pixel_filter",
    "CYCLES_RENDER_PT_film_transparency": "KOMOREBI_RENDER_PT_film",
    "CYCLES_RENDER_PT_performance": "KOMOREBI_RENDER_PT_performance",
    "CYCLES_RENDER_PT_performance_threads": "KOMOREBI_RENDER_PT_performance",
    "CYCLES_RENDER_PT_performance_final_render": "KOMOREBI_RENDER_PT_performance",
    "CYCLES_RENDER_PT_performance_compositor": "KOMOREBI_RENDER_PT_performance_compositor",
    "CYCLES_RENDER_PT_performance_compositor_denoise_settings": (
        "KOMOREBI_RENDER_PT_performance_compositor"
    ),
    "CYCLES_RENDER_PT_passes": "KOMOREBI_VIEWLAYER_PT_passes",
    "CYCLES_RENDER_PT_passes_data": "KOMOREBI_VIEWLAYER_PT_passes_data",
    "CYCLES_RENDER_PT_passes_light": "KOMOREBI_VIEWLAYER_PT_passes_light",
    "CYCLES_RENDER_PT_passes_crypto": "KOMOREBI_VIEWLAYER_PT_passes_cryptomatte",
    "CYCLES_RENDER_PT_passes_aov": "KOMOREBI_VIEWLAYER_PT_passes_aov",
    "CYCLES_RENDER_PT_filter": "KOMOREBI_VIEWLAYER_PT_filter",
    "CYCLES_RENDER_PT_override": "KOMOREBI_VIEWLAYER_PT_override",
    "CYCLES_OBJECT_PT_motion_blur": "KOMOREBI_OBJECT_PT_motion_blur",
    "CYCLES_OBJECT_PT_shading": "KOMOREBI_OBJECT_PT_shading",
    "CYCLES_OBJECT_PT_shading_shadow_terminator": "KOMOREBI_OBJECT_PT_shading_shadow_terminator",
    "CYCLES_OBJECT_PT_visibility": "KOMOREBI_OBJECT_PT_visibility",
    "CYCLES_OBJECT_PT_visibility_ray_visibility": "KOMOREBI_OBJECT_PT_visibility_ray_visibility",
    "CYCLES_LIGHT_PT_light": "KOMOREBI_LIGHT_PT_light",
    "CYCLES_LIGHT_PT_beam_shape": "KOMOREBI_LIGHT_PT_light",
    "CYCLES_WORLD_PT_surface": "KOMOREBI_WORLD_PT_surface",
    "CYCLES_WORLD_PT_settings": "KOMOREBI_WORLD_PT_settings",
    "CYCLES_WORLD_PT_settings_surface": "KOMOREBI_WORLD_PT_settings",
    "CYCLES_WORLD_PT_mist": "KOMOREBI_WORLD_PT_mist",
    "CYCLES_WORLD_PT_ray_visibility": "KOMOREBI_WORLD_PT_ray_visibility",
    "CYCLES_MATERIAL_PT_surface": "KOMOREBI_MATERIAL_PT_surface",
    "CYCLES_MATERIAL_PT_settings": "KOMOREBI_MATERIAL_PT_settings",
    "draw_device": "draw_method",
    "CYCLES_MATERIAL_PT_preview": "KOMOREBI_MATERIAL_PT_preview",
    "CYCLES_WORLD_PT_preview": "KOMOREBI_WORLD_PT_preview",
    "draw_pause": "draw_pause",
    "CYCLES_RENDER_PT_sampling_viewport": "KOMOREBI_RENDER_PT_sampling_viewport",
    "CYCLES_RENDER_PT_performance_viewport": "KOMOREBI_RENDER_PT_performance_viewport",
    "CYCLES_VIEW3D_PT_shading_lighting": "KOMOREBI_VIEW3D_PT_shading_lighting",
    "CYCLES_VIEW3D_PT_shading_render_pass": "KOMOREBI_VIEW3D_PT_shading_render_pass",
}
# Cycles' class → Blender's own, which we show as well.
ADOPTED = {
    "CYCLES_PT_post_processing": "RENDER_PT_post_processing",
    "CYCLES_CAMERA_PT_dof": "DATA_PT_camera_dof",
    "CYCLES_CAMERA_PT_dof_aperture": "DATA_PT_camera_dof_aperture",
    "CYCLES_LIGHT_PT_preview": "DATA_PT_preview",
    "CYCLES_PT_context_material": "EEVEE_MATERIAL_PT_context_material",
}
LEFT_OUT = {
    "CYCLES_PT_sampling_presets": "presets of Cycles' settings",
    "CYCLES_PT_viewport_sampling_presets": VIEWPORT,
    "CYCLES_PT_integrator_presets": "presets of Cycles' settings",
    "CYCLES_PT_performance_presets": "presets of Cycles' settings",
    "CYCLES_RENDER_PT_sampling_path_guiding": GUIDING,
    "CYCLES_RENDER_PT_sampling_path_guiding_debug": GUIDING,
    "CYCLES_RENDER_PT_sampling_lights": LAMP_SETTINGS,
    "CYCLES_RENDER_PT_light_paths_caustics": "all surfaces are matt: there are no caustics",
    "CYCLES_RENDER_PT_volumes": VOLUMES,
    "CYCLES_RENDER_PT_subdivision": "adaptive subdivision is not rendered: Blender subdivides",
    "CYCLES_RENDER_PT_curves_viewport_display": VIEWPORT,
    "CYCLES_RENDER_PT_simplify_culling": "what is far or outside of the view is rendered too",
    "CYCLES_VIEW3D_PT_shading_debug": VIEWPORT,
    "CYCLES_RENDER_PT_performance_memory": "no tiles that a user would choose: Progressive does",
    "CYCLES_RENDER_PT_performance_acceleration_structure": "the tree is chosen by itself",
    "CYCLES_RENDER_PT_performance_texture_cache": "there is no cache of textures",
    "CYCLES_RENDER_PT_passes_lightgroups": LIGHT_GROUPS,
    "CYCLES_CAMERA_PT_lens_custom_parameters": "cameras by OSL shaders are not rendered",
    "CYCLES_OBJECT_PT_shading_gi_approximation": OWN_DISTANCE,
    "CYCLES_OBJECT_PT_shading_caustics": "all surfaces are matt: there are no caustics",
    "CYCLES_OBJECT_PT_lightgroup": LIGHT_GROUPS,
    "CYCLES_OBJECT_PT_visibility_culling": "what is far or outside of the view is rendered too",
    "CYCLES_OBJECT_PT_light_linking": LINKING,
    "CYCLES_OBJECT_PT_shadow_linking": LINKING,
    "CYCLES_OBJECT_MT_light_linking_context_menu": LINKING,
    "CYCLES_OBJECT_MT_shadow_linking_context_menu": LINKING,
    "CYCLES_LIGHT_PT_nodes": LAMP_NODES,
    "CYCLES_LIGHT_PT_settings": LAMP_SETTINGS,
    "CYCLES_WORLD_PT_volume": VOLUMES,
    "CYCLES_WORLD_PT_settings_volume": VOLUMES,
    "CYCLES_WORLD_PT_settings_light_group": LIGHT_GROUPS,
    "CYCLES_MATERIAL_PT_volume": VOLUMES,
    "CYCLES_MATERIAL_PT_displacement": MATERIALS,
    "CYCLES_MATERIAL_PT_settings_surface": MATERIALS,
    "CYCLES_MATERIAL_PT_settings_volume": VOLUMES,
    "CYCLES_RENDER_PT_bake": BAKING,
    "CYCLES_RENDER_PT_bake_influence": BAKING,
    "CYCLES_RENDER_PT_bake_selected_to_active": BAKING,
    "CYCLES_RENDER_PT_bake_output": BAKING,
    "CYCLES_RENDER_PT_bake_output_margin": BAKING,
    "CYCLES_RENDER_PT_debug": DEBUG,
    "NODE_CYCLES_MATERIAL_PT_settings": COPY,
    "NODE_CYCLES_MATERIAL_PT_settings_surface": MATERIALS,
    "NODE_CYCLES_MATERIAL_PT_settings_volume": VOLUMES,
    "NODE_CYCLES_WORLD_PT_ray_visibility": COPY,
    "NODE_CYCLES_WORLD_PT_settings": COPY,
    "NODE_CYCLES_WORLD_PT_settings_surface": COPY,
    "NODE_CYCLES_WORLD_PT_settings_volume": VOLUMES,
    "NODE_CYCLES_LIGHT_PT_light": COPY,
    "NODE_CYCLES_LIGHT_PT_beam_shape": COPY,
    "NODE_CYCLES_LIGHT_PT_settings": LAMP_SETTINGS,
    "draw_make_links": LINKING,
}
# Blender's own panels that Cycles shows and we do not, beside those that the add-on excludes.
NOT_SHOWN = {
    "OBJECT_PT_shadow_terminator": "KOMOREBI_OBJECT_PT_shading_shadow_terminator is in its place",
    "VIEWLAYER_PT_layer_passes_lightgroups": LIGHT_GROUPS,
}
# What Blender shows, or hides, by asking for Cycles or EEVEE in the middle of a panel or menu.
INSIDE = (
    ("DATA_PT_lens", "the kinds and angles of panoramas", "KOMOREBI_CAMERA_PT_panorama"),
    ("OUTLINER_MT_collection_view_layer", "Set and Clear Indirect Only", "draw_indirect_only"),
    ("RENDER_PT_context", "Cycles' device", "draw_method"),
    ("the node editor's Add menu and search, in 3.4", "shaders", "node_menu.py"),
    (
        "VIEW3D_PT_shading_lighting",
        "lights of the rendered view",
        "KOMOREBI_VIEW3D_PT_shading_lighting",
    ),
    ("DATA_PT_volume_render", "Cycles' space of steps", "left out: " + VOLUMES),
)
