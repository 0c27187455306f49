"""Which material each slot of an object has, and what materials look like."""

from __future__ import annotations

from typing import Any

from ..passes import value_columns
from ..scene_data import MaterialData, Materials, ProgramData
from .aovs import AovReader
from .names import name_of
from .shader.nodes_coordinates import STEPS
from .surface import export_surface, look_of
from .surroundings import surroundings_of

# What Cycles calls the surface of a face without material, and so what a Cryptomatte has.
NO_MATERIAL = "default_surface"


class MaterialExporter:
    """Collects the materials of one view layer; its override takes the place of all."""

    def __init__(self, engine: Any, scene: Any, view_layer: Any, materials: Materials) -> None:
        self._engine = engine
        self._look = look_of(scene)
        self._around = surroundings_of(scene)
        self._override = view_layer.material_override
        self._materials = materials
        self._aovs = AovReader(engine, value_columns(view_layer), self._around)
        materials.value_count = self._aovs.value_count
        self._attributes: list[frozenset[str]] = []  # of each material
        self.asks_random = False  # whether any material so far has another look by instance
        self._index: dict[int, int] = {}  # of materials by address; 0: no material
        self._slots: dict[tuple[int, ...], int] = {}

    def slots_of(self, obj: Any) -> int:
        """The index of the list of slots that an evaluated object of type MESH has."""
        slots = tuple(self._material(m) for m in self._surfaces(obj))
        known = self._slots.setdefault(slots, len(self._slots))
        if known == len(self._materials.slots):
            self._materials.slots.append(slots)
        return known

    def attributes_of(self, obj: Any) -> frozenset[str]:
        """The names of attributes that an object's materials ask for."""
        indices = self._materials.slots[self.slots_of(obj)]
        return frozenset[str]().union(*(self._attributes[i] for i in indices))

    def _surfaces(self, obj: Any) -> list[Any]:
        if self._override is not None:
            return [self._override]
        of_object, of_data = obj.material_slots, obj.data.materials
        surfaces = []
        for i in range(max(1, len(of_object), len(of_data))):
            material = of_data[i] if i < len(of_data) else None
            if i < len(of_object) and of_object[i].link == "OBJECT":
                material = of_object[i].material
            surfaces.append(material)
        return surfaces

    def _material(self, material: Any) -> int:
        pointer = 0 if material is None else material.original.as_pointer()
        index = self._index.get(pointer)
        if index is None:
            index = self._index[pointer] = len(self._materials.materials)
            surface = export_surface(self._engine, material, self._look, self._around)
            data = MaterialData(NO_MATERIAL, 0, surface)
            if material is not None:
                values = self._aovs.of_material(material)
                data = MaterialData(name_of(material), material.pass_index, surface, values)
            self._attributes.append(_attributes(data))
            self.asks_random |= any(_asks_random(p) for p in data.programs())
            self._materials.materials.append(data)
        return index


def _asks_random(program: ProgramData) -> bool:
    return any(op.op == "input" and op.name == "object_random" for op in program.ops)


def _attributes(material: MaterialData) -> frozenset[str]:
    """What of a mesh the programs read; steps aside follow from the same arrays. The Tangent of
    Geometry nodes lies around generated coordinates."""
    names = set()
    for op in (op for program in material.programs() for op in program.ops):
        if op.op == "attribute":
            way, _, rest = op.name.partition(":")
            names.add(rest if way in STEPS else op.name)
        elif op.op == "input" and op.name == "tangent":
            names.add("generated")
    return frozenset(names)
