"""Walking a shader tree: what feeds a socket, past reroutes and muted nodes."""

from __future__ import annotations

from typing import Any

MAX_STEPS = 1000  # no tree of a person is longer; a cycle is


def source(socket: Any) -> Any | None:
    """The output socket that feeds the input `socket`, or None when nothing does."""
    for _ in range(MAX_STEPS):
        link = next((k for k in socket.links if k.is_valid and not k.is_muted), None)
        if link is None:
            return None
        node = link.from_node
        if node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.mute:
            inner = (k for k in node.internal_links if k.to_socket == link.from_socket)
            through = next(inner, None)
            if through is None:
                return None
            socket = through.from_socket
        else:
            return link.from_socket
    return None


def world_output(tree: Any) -> Any | None:
    """The World Output node that counts, or None."""
    return _output(tree, "OUTPUT_WORLD")


def material_output(tree: Any) -> Any | None:
    """The Material Output node that counts, or None."""
    return _output(tree, "OUTPUT_MATERIAL")


def light_output(tree: Any) -> Any | None:
    """The Light Output node that counts, or None."""
    return _output(tree, "OUTPUT_LIGHT")


def _output(tree: Any, kind: str) -> Any | None:
    """What is for Cycles alone comes before what is for all."""
    for target in ("CYCLES", "ALL", "EEVEE"):
        node = tree.get_output_node(target)
        if node is not None and node.type == kind:
            return node
    return None


def find_upstream(node: Any, types: set[str]) -> Any | None:
    """The nearest node of one of `types` that feeds `node`, groups searched as well."""
    seen: set[int] = set()
    queue = [node]
    while queue:
        current = queue.pop(0)
        pointer = current.as_pointer()
        if pointer in seen:
            continue
        seen.add(pointer)
        if current.type in types:
            return current
        if current.type == "GROUP" and current.node_tree:
            queue.extend(n for n in current.node_tree.nodes if n.type == "GROUP_OUTPUT")
        feeding = (source(socket) for socket in current.inputs)
        queue.extend(socket.node for socket in feeding if socket is not None)
    return None
