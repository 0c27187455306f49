"""Shader nodes → programs of the core (native/shader)."""

from . import (  # noqa: F401  they register functions of nodes
    nodes_basic,
    nodes_color,
    nodes_coordinates,
    nodes_curves,
    nodes_displacement,
    nodes_image,
    nodes_math,
    nodes_noise,
    nodes_patterns,
    nodes_shading,
    nodes_sky,
    nodes_surface,
    nodes_voronoi,
)
from .compiler import Compiler, Ray

__all__ = ["Compiler", "Ray"]
