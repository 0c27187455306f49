# mypy: disable-error-code="valid-type,override"
"""Operators."""

from typing import Any

import bpy
from bpy.props import StringProperty

from . import dump


class KOMOREBI_OT_dump(bpy.types.Operator):
    """Write this frame, as Komorebi sees it, to a file for benchmarks and bug reports"""

    bl_idname = "komorebi.dump"
    bl_label = "Dump Komorebi Scene"

    filepath: StringProperty(subtype="FILE_PATH")

    @classmethod
    def poll(cls, context: Any) -> bool:
        return bool(context.scene.render.engine == "KOMOREBI")

    def invoke(self, context: Any, event: Any) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Any) -> set[str]:
        if not self.filepath:
            self.report({"ERROR"}, "Komorebi: no file to write the scene to")
            return {"CANCELLED"}
        # Only a render evaluates the scene with render settings.
        path = bpy.path.abspath(self.filepath)
        dump.request(path)
        try:
            bpy.ops.render.render()
        except RuntimeError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            unused = dump.withdraw()
        if unused:
            self.report({"ERROR"}, f"Komorebi: nothing was rendered, {path} is not written")
            return {"CANCELLED"}
        self.report({"INFO"}, f"Komorebi: the scene is in {path}")
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(KOMOREBI_OT_dump)


def unregister() -> None:
    bpy.utils.unregister_class(KOMOREBI_OT_dump)
