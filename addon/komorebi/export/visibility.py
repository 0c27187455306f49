"""Which rays see an object, and what else it is (holdout, shadow catcher)."""

from __future__ import annotations

from typing import Any

from ..scene_data import (
    FLAG_HOLDOUT,
    FLAG_SHADOW_CATCHER,
    RAY_ALL,
    RAY_CAMERA,
    RAY_DIFFUSE,
    RAY_SHADOW,
)

NEVER_SEEN = {"LIGHT", "CAMERA"}  # whose flags mean nothing to a ray
_RAYS = (
    ("visible_camera", RAY_CAMERA),
    ("visible_diffuse", RAY_DIFFUSE),
    ("visible_shadow", RAY_SHADOW),
)


class Visibility:
    """Answers for one depsgraph; `matters` is False when every object is a plain one."""

    def __init__(self, depsgraph: Any) -> None:
        self._view_layer = depsgraph.view_layer
        self._known: dict[Any, tuple[int, int]] = {}
        self.matters = _layer_matters(self._view_layer.layer_collection) or any(
            _object_matters(obj) for obj in depsgraph.objects if obj.type not in NEVER_SEEN
        )

    def of(self, instance: Any, original: Any) -> tuple[int, int]:
        """Bits RAY_* and FLAG_* of an instance of `original`, its instancer's included."""
        mask, flags = self._of_known(original)
        if instance.is_instance and instance.parent:
            parent_mask, parent_flags = self._of_known(instance.parent.original)
            mask &= parent_mask
            flags |= parent_flags
        return mask, flags

    def _of_known(self, original: Any) -> tuple[int, int]:
        known = self._known.get(original)
        if known is None:
            known = self._known[original] = self._of_object(original)
        return known

    def _of_object(self, obj: Any) -> tuple[int, int]:
        mask = RAY_ALL
        for name, bit in _RAYS:
            if not getattr(obj, name):
                mask &= ~bit
        flags = FLAG_SHADOW_CATCHER if obj.is_shadow_catcher else 0
        if obj.is_holdout or obj.holdout_get(view_layer=self._view_layer):
            flags |= FLAG_HOLDOUT
        elif obj.indirect_only_get(view_layer=self._view_layer):  # a holdout is never that
            mask &= ~RAY_CAMERA
        return mask, flags


def _layer_matters(layer: Any) -> bool:
    if layer.holdout or layer.indirect_only:
        return True
    return any(_layer_matters(child) for child in layer.children)


def _object_matters(obj: Any) -> bool:
    return (
        obj.is_holdout
        or obj.is_shadow_catcher
        or not (obj.visible_camera and obj.visible_diffuse and obj.visible_shadow)
    )
