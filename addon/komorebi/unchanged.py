"""What Blender has not touched since the last frame, with Persistent Data. No bpy in here.

Then one engine instance renders frame after frame, evaluated data keep their addresses while they
are not evaluated again, and `depsgraph.updates` names those that are. An address alone is no proof:
it may be given again to other data of another object, so that the object counts too.
"""

from __future__ import annotations

from typing import Any

from .scene_data import MeshKey

# Of evaluated data and original object; with UVs, and the names of attributes.
Address = tuple[int, int, bool, frozenset[str]]


class Unchanged:
    """Keys of what an engine instance has exported, until Blender says that it has changed."""

    def __init__(self) -> None:
        self._keys: dict[Address, MeshKey] = {}
        # Of objects that have changed since they were read: how their vertices were joined then,
        # which is as a rule how they are. A copy of all others would take memory for nothing.
        self._topologies: dict[int, Any | None] = {}

    def begin(self, depsgraph: Any) -> None:
        """Forgets what has changed since the last call. To be called for each view layer, as each
        has updates of its own."""
        changed = {
            update.id.original.as_pointer()
            for update in depsgraph.updates
            if update.is_updated_geometry
        }
        if changed:
            for _, original, *_ in self._keys:
                if original in changed:
                    self._topologies.setdefault(original, None)
            self._keys = {a: key for a, key in self._keys.items() if a[1] not in changed}

    def key(self, address: Address) -> MeshKey | None:
        return self._keys.get(address)

    def topology(self, original: int) -> Any | None:
        """A compat.Topology that this object's mesh may have."""
        return self._topologies.get(original)

    def remember_topology(self, original: int, topology: Any) -> None:
        if original in self._topologies:
            self._topologies[original] = topology

    def remember(self, address: Address, key: MeshKey) -> None:
        self._keys[address] = key
