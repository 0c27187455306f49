# mypy: disable-error-code="valid-type,override"
"""Operators."""

from typing import Any

import bpy
from bpy.props import StringProperty

from . import dump
from .viewport import notices


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


class KOMOREBI_OT_report_warnings(bpy.types.Operator):
    """Reports what the rendered viewport warns of"""

    bl_idname = "komorebi.report_warnings"
    bl_label = "Report Warnings"
    bl_options = {"INTERNAL"}

    _timer: Any = None

    def invoke(self, context: Any, event: Any) -> set[str]:
        self._timer = context.window_manager.event_timer_add(0.01, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: Any, event: Any) -> set[str]:
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self._timer)
        for sentence in notices.taken():
            self.report({"WARNING"}, f"Komorebi: {sentence}")
        return {"FINISHED"}


CLASSES = (KOMOREBI_OT_dump, KOMOREBI_OT_report_warnings)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    notices.drop()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
