"""What a material's AOV Output nodes say, as far as it is the same all over the material.

Understood: colours and numbers of the nodes themselves, or of RGB and Value nodes, also through
reroutes, muted nodes and into and out of groups. Everything else is named in a warning, and black.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .. import compat, reporting
from ..passes import ValueColumn
from . import nodes
from .names import name_of

Number = float | tuple[float, float, float]
# Rec. 709, as Blender makes a number of a colour; of a vector it takes the mean.
LUMINANCE = (0.2126729, 0.7151522, 0.0721750)


class AovReader:
    """Fills the columns of values that a view layer's AOVs ask of every material."""

    def __init__(self, engine: Any, columns: list[ValueColumn]) -> None:
        self._engine = engine
        self._columns = columns

    def values_of(self, material: Any | None) -> list[float]:
        """The columns' floats one after the other; null where the material does not say."""
        values = [0.0] * sum(c.channels for c in self._columns)
        tree = None if material is None else compat.shader_nodes(material)
        if tree is None:
            return values
        for node, path in _aov_nodes(tree, ()):
            for column in self._columns:
                if column.aov == compat.aov_name(node):
                    self._add(material, node, path, column, values)
        return values

    def _add(
        self, material: Any, node: Any, path: tuple[Any, ...], column: ValueColumn,
        values: list[float],
    ) -> None:  # fmt: skip
        """Adds what a node says: those of two nodes with the same name add up, as in Cycles."""
        is_color = column.channels == 4
        socket = node.inputs["Color" if is_color else "Value"]
        number = _constant(socket, path)
        if number is None:
            what = (
                f'material "{name_of(material)}", AOV "{column.aov}": its {socket.name} is not '
                f'one for the whole material (node "{name_of(nodes.source(socket).node)}"), '
                "not rendered yet, black"
            )
            reporting.warn(self._engine, what)
            return
        said = (*number, 1.0) if isinstance(number, tuple) else (number,)
        for channel, value in enumerate(said):
            values[column.first + channel] += value


def warn_world(engine: Any, world: Any | None, columns: list[ValueColumn]) -> None:
    """Names the AOVs that the world would show behind everything."""
    tree = None if world is None else compat.shader_nodes(world)
    said = {compat.aov_name(node) for node, _ in _aov_nodes(tree, ())} if tree else set()
    for column in columns:
        if column.aov in said:
            reporting.warn(
                engine,
                f'world "{name_of(world)}", AOV "{column.aov}": not rendered yet, black',
            )


def _aov_nodes(tree: Any, path: tuple[Any, ...]) -> Iterator[tuple[Any, tuple[Any, ...]]]:
    """AOV Output nodes, each with the group nodes that lead to it, the outermost first."""
    for node in tree.nodes:
        if node.mute:
            continue
        if node.type == "OUTPUT_AOV":
            yield node, path
        elif node.type == "GROUP" and node.node_tree is not None:
            yield from _aov_nodes(node.node_tree, (*path, node))


def _constant(socket: Any, path: tuple[Any, ...]) -> Number | None:
    """What reaches an input, or None if it is not the same everywhere."""
    feeding = nodes.source(socket)
    if feeding is None:
        return _converted(socket, socket)
    node = feeding.node
    if node.type in {"RGB", "VALUE"}:
        return _converted(feeding, socket)
    inner: Any | None = None
    if node.type == "GROUP_INPUT" and path:
        inner, path = _same_socket(path[-1].inputs, feeding), path[:-1]
    elif node.type == "GROUP" and node.node_tree is not None:
        output = next((n for n in node.node_tree.nodes if _is_active_output(n)), None)
        inner, path = output and _same_socket(output.inputs, feeding), (*path, node)
    number = None if inner is None else _constant(inner, path)
    return None if number is None else _as(number, inner.type, socket.type)


def _is_active_output(node: Any) -> bool:
    return node.type == "GROUP_OUTPUT" and node.is_active_output


def _same_socket(sockets: Any, other: Any) -> Any | None:
    return next((s for s in sockets if s.identifier == other.identifier), None)


def _converted(source: Any, target: Any) -> Number | None:
    value = getattr(source, "default_value", None)
    if source.type in {"RGBA", "VECTOR"}:
        return _as((value[0], value[1], value[2]), source.type, target.type)
    if source.type in {"VALUE", "INT", "BOOLEAN"}:
        return _as(float(value), source.type, target.type)
    return None


def _as(number: Number, kind: str, wanted: str) -> Number:
    """A socket's number as Cycles hands it to one of another type."""
    if wanted in {"RGBA", "VECTOR"}:
        return (number, number, number) if isinstance(number, float) else number
    if isinstance(number, float):
        return number
    if kind == "RGBA":
        return sum(w * c for w, c in zip(LUMINANCE, number, strict=True))
    return sum(number) / 3.0
