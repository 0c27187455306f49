"""What Blender calls when a property changes.

Not beside the properties: up to 4.2 Python's garbage collector does not see into a property of a
class, so that a callback whose module knows the class, or bpy, keeps both alive to the end. Blender
as a Python module then crashes there. So nothing is imported here.
"""


def update_render_passes(_: object, context) -> None:  # type: ignore[no-untyped-def]
    """Lets the compositor's sockets follow a pass that is switched on or off."""
    if context.view_layer is not None:
        context.view_layer.update_render_passes()


def studio_light_names(_self: object, _context: object, text: str) -> list[str]:
    """The studio lights whose names hold `text`."""
    from .export.sky_choice import studio_lights

    return [name for name in studio_lights() if text.lower() in name.lower()]
