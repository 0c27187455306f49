"""Render settings that both engines share: size, format, and all that would touch the pixels
afterwards."""

from __future__ import annotations

from typing import Any

from compare.inside.settle import settle, settle_all


def set_size(scene: Any, longest: int) -> list[str]:
    """Full frame in pixels at 100 %, its longest side at most `longest`; returns notes on what
    changed."""
    render = scene.render
    width = max(1, render.resolution_x * render.resolution_percentage // 100)
    height = max(1, render.resolution_y * render.resolution_percentage // 100)
    factor = min(1.0, longest / max(width, height))
    new_width, new_height = max(4, round(width * factor)), max(4, round(height * factor))
    settle_all(render, resolution_x=new_width, resolution_y=new_height, resolution_percentage=100)
    if (new_width, new_height) == (width, height):
        return []
    return [f"resolution {width} × {height} made {new_width} × {new_height}"]


def set_output(scene: Any) -> None:
    """A linear 32-bit EXR of the Combined pass, with nothing applied after the engine."""
    render = scene.render
    settle_all(
        render,
        use_compositing=False,
        use_sequencer=False,
        use_freestyle=False,
        use_multiview=False,
        use_single_layer=False,
        use_stamp=False,
        use_file_extension=True,
        use_overwrite=True,
        use_placeholder=False,
        dither_intensity=0.0,
        use_persistent_data=False,
        use_high_quality_normals=False,
        threads_mode="AUTO",
    )
    image = render.image_settings
    settle(image, "media_type", "IMAGE")  # 5.0 lists EXR only under its media type
    settle_all(image, file_format="OPEN_EXR", color_mode="RGBA", color_depth="32", exr_codec="ZIP")
    settle(image, "color_management", "FOLLOW_SCENE")
    if render.use_border:
        settle(render, "use_crop_to_border", True)


def choose_view_layer(scene: Any, name: str | None) -> tuple[Any, list[str]]:
    """Render one view layer alone: `name`, or the first that renders. Raises KeyError for an
    unknown name."""
    layers = scene.view_layers
    if name is not None and name not in layers:
        known = ", ".join(layer.name for layer in layers)
        raise KeyError(f"the scene has no view layer {name!r}; it has {known}")
    chosen = (
        layers[name]
        if name is not None
        else next((layer for layer in layers if layer.use), layers[0])
    )
    for layer in layers:
        settle(layer, "use", layer == chosen)
    notes = []
    for flag, text in (
        ("use_sky", "sky off"),
        ("use_solid", "surfaces off"),
        ("use_ao", "ambient occlusion off"),
    ):
        if flag in chosen.bl_rna.properties and not getattr(chosen, flag):
            settle(chosen, flag, True)
            notes.append(f"view layer {chosen.name}: {text} undone")
    settle_all(chosen, samples=0)
    settle_all(getattr(chosen, "cycles", None), use_denoising=False)
    return chosen, notes
