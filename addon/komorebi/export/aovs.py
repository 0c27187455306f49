"""What AOV Output nodes of materials and the world say, as programs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .. import compat
from ..passes import ValueColumn
from ..scene_data import ProgramData, Value
from .names import name_of
from .shader import Compiler, Ray
from .surroundings import Surroundings


class AovReader:
    """Reads the columns of values that a view layer's AOVs ask of all materials."""

    def __init__(self, engine: Any, columns: list[ValueColumn], around: Surroundings) -> None:
        self._engine = engine
        self._columns = columns
        self._around = around

    @property
    def value_count(self) -> int:
        """Outputs of the programs."""
        return sum(column.channels for column in self._columns)

    def of_material(self, material: Any | None) -> ProgramData | None:
        """The columns' values one after the other; None where the material says nothing."""
        return None if material is None else self._read(material, f'material "{name_of(material)}"')

    def of_world(self, world: Any | None) -> ProgramData | None:
        """What stands where a ray meets nothing."""
        return None if world is None else self._read(world, f'world "{name_of(world)}"', True)

    def _read(self, owner: Any, called: str, is_world: bool = False) -> ProgramData | None:
        tree = compat.shader_nodes(owner) if self._columns else None
        said = {} if tree is None else dict(self._said_in(tree))
        if not said:
            return None
        compiler = Compiler(
            self._engine, called, Ray("CAMERA"), is_world=is_world, surroundings=self._around
        )
        b = compiler.builder
        outputs: Value = ()
        for column in self._columns:
            value: Value = (0.0,) * column.channels
            # What two nodes of the same name say adds up, as in Cycles.
            for node, groups in said.get(column, ()):
                socket = node.inputs["Color" if column.channels == 4 else "Value"]
                with compiler.within(groups):
                    found = compiler.value(socket)
                value = b.add(value, (*found, 1.0) if column.channels == 4 else found)
            outputs += value
        return ProgramData(called, b.ops, outputs)

    def _said_in(self, tree: Any) -> Iterator[tuple[ValueColumn, list[tuple[Any, Any]]]]:
        found = list(_aov_nodes(tree, ()))
        for column in self._columns:
            own = [pair for pair in found if compat.aov_name(pair[0]) == column.aov]
            if own:
                yield column, own


def _aov_nodes(tree: Any, path: tuple[Any, ...]) -> Iterator[tuple[Any, tuple[Any, ...]]]:
    """AOV Output nodes, each with the group nodes that lead to it, the outermost first."""
    for node in tree.nodes:
        if node.mute:
            continue
        if node.type == "OUTPUT_AOV":
            yield node, path
        elif node.type == "GROUP" and node.node_tree is not None:
            yield from _aov_nodes(node.node_tree, (*path, node))
