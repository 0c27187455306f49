"""Where the points are that a tree runs over."""

from __future__ import annotations

from typing import Any

from .compiler import Compiler
from .values import Value


def default_vector(compiler: Compiler, _node: Any) -> Value:
    """What a texture takes for coordinates if nothing is linked to it."""
    if compiler.is_world:
        return compiler.builder.input("position")
    return compiler.builder.attribute("generated")[:3]
