# mypy: disable-error-code="valid-type"
"""The add-on's preferences, of the user and not of a scene."""

from typing import Any

import bpy
from bpy.props import StringProperty


class KomorebiPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    oidn_path: StringProperty(
        name="Open Image Denoise",
        description="Library to denoise with, or its folder; empty looks for Blender's own, the "
        "Python package pyoidn and the system's",
        subtype="FILE_PATH", default="",
    )  # fmt: skip

    def draw(self, _context: Any) -> None:
        self.layout.prop(self, "oidn_path")


def register() -> None:
    bpy.utils.register_class(KomorebiPreferences)


def unregister() -> None:
    bpy.utils.unregister_class(KomorebiPreferences)
