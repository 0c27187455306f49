"""Shader nodes → programs of the core (native/shader)."""

from . import nodes_basic, nodes_math, nodes_sky  # noqa: F401  they register functions of nodes
from .compiler import Compiler, Ray

__all__ = ["Compiler", "Ray"]
