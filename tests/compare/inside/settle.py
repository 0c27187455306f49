"""Setting properties so that they stay set while Blender renders.

A render evaluates the frame anew, so an animated or driven property would take its old value back.
`settle` therefore removes the curves and drivers of what it sets. Linked data can be set too:
nothing here is saved.
"""

from __future__ import annotations

from contextlib import suppress
from typing import Any


def safe_name(thing: Any) -> str:
    """The name of a data-block, also where the file holds bytes that are not UTF-8."""
    try:
        return str(thing.name)
    except UnicodeDecodeError:
        return "(a name that is not UTF-8)"


def forget_animation(owner: Any, path: str) -> None:
    """Remove every driver and curve of the data-block `owner` that sets `path`."""
    data = getattr(owner, "animation_data", None)
    if data is None:
        return
    for curve in [c for c in data.drivers if c.data_path == path]:
        data.drivers.remove(curve)
    with suppress(AttributeError):  # an action of layers only (5.0) has no curves of its own
        for curve in [c for c in data.action.fcurves if c.data_path == path] if data.action else []:
            data.action.fcurves.remove(curve)


def settle(holder: Any, name: str, value: Any) -> bool:
    """Set `holder.name` for good. False when this release has no such property; True when it holds
    `value` now."""
    if holder is None or name not in holder.bl_rna.properties:
        return False
    owner = holder.id_data
    path = name
    with suppress(ValueError):
        prefix = holder.path_from_id()
        path = f"{prefix}.{name}" if prefix else name
    forget_animation(owner, path)
    setattr(holder, name, value)
    return True


def settle_all(holder: Any, **values: Any) -> None:
    """`settle` for several properties; those that this release does not have are left out."""
    for name, value in values.items():
        settle(holder, name, value)


def require(holder: Any, **values: Any) -> None:
    """`settle` for properties that must exist; raises KeyError naming the first that does not."""
    for name, value in values.items():
        if not settle(holder, name, value):
            raise KeyError(f"{holder.bl_rna.identifier} has no property {name}")
