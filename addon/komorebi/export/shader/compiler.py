"""A tree of shader nodes → operations. Walks from an output socket to what feeds it.

Each kind of node has a function in one of the files beside this one, registered by @node; it is
given the Compiler and the node, and answers with a value or closures for every output socket that
it knows. What is not known is named in a warning and replaced by the closest thing that is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from ... import reporting
from .. import nodes
from ..names import name_of
from ..surroundings import Surroundings
from .closures import Closure, Closures
from .values import VECTORS, Builder, Value

# An output's identifier or name → what leaves it.
Outputs = dict[str, "Value | Closures"]
NodeFunction = Callable[["Compiler", Any], Outputs]
_NODES: dict[str, NodeFunction] = {}

MAX_DEPTH = 150  # nodes in a row; Python's own limit on calls within calls is not far beyond
NOWHERE = Surroundings()
GREY: Value = (0.5, 0.5, 0.5)


def node(*types: str) -> Callable[[NodeFunction], NodeFunction]:
    """Registers the function of these types of nodes (`bpy.types.Node.type`)."""

    def register(function: NodeFunction) -> NodeFunction:
        for kind in types:
            _NODES[kind] = function
        return function

    return register


@dataclass(frozen=True, slots=True)
class Ray:
    """The kind of ray that a tree is compiled for: Light Path is a constant then."""

    kind: str = "CAMERA"  # CAMERA, DIFFUSE, SHADOW; SUN: DIFFUSE towards the disc of a sky's sun
    sun: int = 0  # which of Compiler.suns


class Compiler:
    """Compiles sockets of one tree for one kind of ray into one Builder."""

    def __init__(
        self,
        engine: Any,
        owner: str,
        ray: Ray,
        *,
        is_world: bool = False,
        surroundings: Surroundings = NOWHERE,
    ) -> None:
        self.builder = Builder()
        self._ray = ray
        self.heeds_ray = False  # whether another kind of ray would be answered otherwise
        self.is_world = is_world
        self.frame = surroundings.frame  # of the scene, for sequences of pictures
        self.owner = owner  # how warnings begin: world "World"
        self.map_size = 0  # columns of the largest environment map
        # [3, 4] rows of the matrix into the camera's space (right, up, depth; a
        # panorama's: depth, left, up), where it is known
        self.camera_from_world = surroundings.camera_from_world
        # what is compiled for a point aside: "dx" or "dy", and how many such steps
        self.shift: tuple[str, Value] | None = None
        # whether pictures may be averaged within a ray's cone; else they are read as they are
        self.averages = False
        self.has_pictures = False  # whether any is read that could be averaged
        self.notes: set[str] = set()  # what is rendered as something simpler, by design
        self.suns: list[Any] = []  # nodes_sky.SkySun: discs that a map of the world leaves out
        self._engine = engine
        self._groups: tuple[Any, ...] = ()  # group nodes that we are inside of, the outermost first
        self._done: dict[tuple[Any, ...], Outputs] = {}
        self._open: set[tuple[Any, ...]] = set()  # nodes that are being compiled: a cycle meets one

    # What functions of nodes call.

    @property
    def ray(self) -> Ray:
        """The kind of ray; whoever asks makes the outcome depend on it."""
        self.heeds_ray = True
        return self._ray

    def warn(self, node: Any, what: str) -> None:
        label = node.bl_label or node.type
        reporting.warn(self._engine, f'{self.owner}, node "{name_of(node)}" ({label}): {what}')

    def note(self, what: str) -> None:
        """For the statistics, not a warning: the engine means to render it as something simpler."""
        self.notes.add(what)

    def is_linked(self, socket: Any) -> bool:
        return self._source(socket) is not None

    def value(self, socket: Any) -> Value:
        """What arrives at an input, as a value of its own type."""
        found = self._source(socket)
        if found is None:
            return self._default(socket)
        value, kind = found
        if value and isinstance(value[0], Closure):
            return (0.0, 0.0, 0.0) if socket.type in VECTORS else (0.0,)
        return self.builder.convert(value, kind, socket.type)  # type: ignore[arg-type]

    def inputs(self, node: Any, *names: str) -> list[Value]:
        """The values of inputs by name."""
        return [self.value(node.inputs[name]) for name in names]

    def closures(self, socket: Any) -> Closures:
        """What arrives at a shader input; a colour there shines, as in Cycles."""
        found = self._source(socket)
        if found is None:
            return ()
        value, kind = found
        if kind == "SHADER":
            return value  # type: ignore[return-value]
        weight = self.builder.convert(value, kind, "RGBA")  # type: ignore[arg-type]
        return (Closure("EMISSION", weight),)

    @contextmanager
    def shifted(self, way: str, width: Value) -> Iterator[None]:
        """What is compiled meanwhile is for a point aside: `width` pixels along "dx" or "dy"."""
        before, self.shift = self.shift, (way, width)
        try:
            yield
        finally:
            self.shift = before

    @contextmanager
    def finest(self) -> Iterator[None]:
        """What is compiled meanwhile reads pictures as they are."""
        before, self.averages = self.averages, False
        try:
            yield
        finally:
            self.averages = before

    # The walk.

    def _source(self, socket: Any) -> tuple[Value | Closures, str] | None:
        """What leaves the output that feeds an input, and its type; None when nothing does."""
        feeding = nodes.source(socket)
        if feeding is None:
            return None
        node = feeding.node
        if node.type == "GROUP_INPUT":
            return self._outside(feeding)
        if node.type == "GROUP" and node.node_tree is not None:
            return self._inside(node, feeding)
        outputs = self._outputs(node)
        if outputs is None:
            return None
        value = outputs.get(feeding.identifier, outputs.get(feeding.name))
        if value is None:
            self.warn(node, f"its output {feeding.name} is not supported yet")
            value = () if feeding.type == "SHADER" else self._zero(feeding)
        return value, feeding.type

    def _outside(self, feeding: Any) -> tuple[Value | Closures, str] | None:
        if not self._groups:
            return None
        group, rest = self._groups[-1], self._groups[:-1]
        outer = next((s for s in group.inputs if s.identifier == feeding.identifier), None)
        if outer is None:
            return None
        with self.within(rest):
            found = self._source(outer)
            if found is not None:
                return found
            if outer.type == "SHADER":
                return None
            return self._default(outer), outer.type

    def _inside(self, group: Any, feeding: Any) -> tuple[Value | Closures, str] | None:
        output = next(
            (n for n in group.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output),
            None,
        )
        inner = output and next(
            (s for s in output.inputs if s.identifier == feeding.identifier), None
        )
        if inner is None:
            return None
        key = (*self._path(), group.as_pointer(), feeding.identifier, self.shift, self.averages)
        if key in self._open or len(self._open) > MAX_DEPTH:
            self.warn(group, "is part of a circle or of too long a row of nodes, and left out")
            return None
        self._open.add(key)
        try:
            with self.within((*self._groups, group)):
                found = self._source(inner)
                if found is None:
                    return None if inner.type == "SHADER" else (self._default(inner), inner.type)
        finally:
            self._open.discard(key)
        value, kind = found
        if kind == "SHADER" or inner.type == "SHADER" or kind == inner.type:
            return found
        return self.builder.convert(value, kind, inner.type), inner.type  # type: ignore[arg-type]

    def _outputs(self, node: Any) -> Outputs | None:
        key = (*self._path(), node.as_pointer(), self.shift, self.averages)
        known = self._done.get(key)
        if known is not None:
            return known
        if key in self._open or len(self._open) > MAX_DEPTH:
            self.warn(node, "is part of a circle or of too long a row of nodes, and left out")
            return None
        self._open.add(key)
        try:
            function = _NODES.get(node.type)
            outputs = self._unknown(node) if function is None else function(self, node)
        finally:
            self._open.discard(key)
        self._done[key] = outputs
        return outputs

    def _unknown(self, node: Any) -> Outputs:
        """A node that nobody knows passes on an input of the same type, or all its shaders."""
        outputs: Outputs = {}
        for socket in node.outputs:
            if socket.type == "SHADER":
                self.warn(node, "not supported yet, rendered as the shaders that enter it")
                outputs[socket.identifier] = tuple(
                    closure
                    for s in node.inputs
                    if s.type == "SHADER"
                    for closure in self.closures(s)
                )
                continue
            same = next(
                (s for s in node.inputs if s.type == socket.type and self.is_linked(s)),
                next((s for s in node.inputs if s.type == socket.type), None),
            )
            what = "as an even value" if same is None else f"as its input {same.name}"
            self.warn(node, f"not supported yet, rendered {what}")
            outputs[socket.identifier] = (
                self._stand_in(socket) if same is None else self.value(same)
            )
        return outputs

    @staticmethod
    def _zero(socket: Any) -> Value:
        return (0.0, 0.0, 0.0) if socket.type in VECTORS else (0.0,)

    @classmethod
    def _stand_in(cls, socket: Any) -> Value:
        return GREY if socket.type == "RGBA" else cls._zero(socket)

    @staticmethod
    def _default(socket: Any) -> Value:
        value = getattr(socket, "default_value", None)
        if socket.type in VECTORS:
            return (0.0,) * 3 if value is None else tuple(float(c) for c in value[:3])
        if value is None or socket.type not in {"VALUE", "INT", "BOOLEAN"}:
            return (0.0,)
        return (float(value),)

    def _path(self) -> tuple[int, ...]:
        return tuple(group.as_pointer() for group in self._groups)

    @contextmanager
    def within(self, groups: tuple[Any, ...]) -> Iterator[None]:
        """What is compiled meanwhile is inside of these group nodes, the outermost first."""
        before, self._groups = self._groups, groups
        try:
            yield
        finally:
            self._groups = before
