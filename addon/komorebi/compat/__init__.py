"""The only place that knows Blender's releases (3.4 to 5.x)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ..scene_data import FloatArray, IntArray
from .lights import (
    casts_shadow,
    is_soft,
    light_factor,
    light_links,
    light_tint,
    max_bounces,
    normalizes,
)
from .releases import (
    CORNER_NORMALS,
    FLAT_NORMAL_MAPS,
    FLAT_RECTS,
    GENERIC_ATTRIBUTES,
    LONG_PASS_NAMES,
    NOISE_REPEATS,
    NORMALS_AS_DIRECTIONS,
    OLD_LAMPS,
    UNLIMITED_BOUNCES,
    VERSION,
    VORONOI_PCG,
    WHOLE_RESULTS,
    cycles_or,
)
from .topology import Topology, face_offsets, face_order, smooth_faces

__all__ = [
    "CORNER_NORMALS",
    "FLAT_NORMAL_MAPS",
    "FLAT_RECTS",
    "GENERIC_ATTRIBUTES",
    "LONG_PASS_NAMES",
    "NOISE_REPEATS",
    "NORMALS_AS_DIRECTIONS",
    "OLD_LAMPS",
    "UNLIMITED_BOUNCES",
    "VERSION",
    "VORONOI_PCG",
    "WHOLE_RESULTS",
    "Topology",
    "casts_shadow",
    "cycles_or",
    "face_offsets",
    "face_order",
    "is_soft",
    "light_factor",
    "light_links",
    "light_tint",
    "max_bounces",
    "normalizes",
    "smooth_faces",
]  # besides what is here


def world_visibility(world: Any) -> tuple[bool, bool]:
    """Whether camera and diffuse rays see a world: Cycles' settings."""
    settings = getattr(world, "cycles_visibility", None)
    return (True, True) if settings is None else (settings.camera, settings.diffuse)


def shadow_terminator(obj: Any) -> tuple[float, float]:
    """An object's shadow terminator offsets, of geometry and shading; the defaults without Cycles,
    to which they belonged up to 4.1."""
    if hasattr(obj, "shadow_terminator_geometry_offset"):
        return obj.shadow_terminator_geometry_offset, obj.shadow_terminator_shading_offset
    settings = cycles_or(obj, None)
    if settings is None:
        return 0.1, 0.0
    return settings.shadow_terminator_geometry_offset, settings.shadow_terminator_offset


def has_own_ao_distance(obj: Any) -> bool:
    """Whether Cycles' Fast GI has another distance for an object than for the world."""
    return bool(getattr(cycles_or(obj, None), "ao_distance", 0.0) != 0.0)


def set_rect(render_pass: Any, pixels: FloatArray) -> None:
    """Writes float32 `pixels` [height, width, channels] into a render pass of that size."""
    channels = pixels.shape[2]
    flat = np.ascontiguousarray(pixels)
    render_pass.rect.foreach_set(flat.reshape(-1) if FLAT_RECTS else flat.reshape(-1, channels))


def positions(mesh: Any) -> FloatArray:
    """Vertex positions [vertices, 3] in object space."""
    result = np.empty(len(mesh.vertices) * 3, np.float32)
    if GENERIC_ATTRIBUTES:
        mesh.attributes["position"].data.foreach_get("vector", result)
    else:
        mesh.vertices.foreach_get("co", result)
    return result.reshape(-1, 3)


def has_corner_normals(mesh: Any) -> bool:
    """Whether the corners of a vertex differ, as Cycles sees it: by custom normals or sharp edges.

    Flat faces beside smooth ones do not count, though Blender's own corner normals split there.
    """
    if not CORNER_NORMALS:
        return bool(mesh.use_auto_smooth)
    if mesh.has_custom_normals:
        return True
    sharp = mesh.attributes.get("sharp_edge")
    if sharp is None or sharp.domain != "EDGE" or sharp.data_type != "BOOLEAN":
        return False
    result = np.empty(len(mesh.edges), np.bool_)
    sharp.data.foreach_get("value", result)
    return bool(result.any())


def normal_sources(mesh: Any) -> tuple[NDArray[Any] | None, ...] | None:
    """What shading normals follow from besides positions, faces and which of them are smooth; None
    where only the normals themselves can tell."""
    if mesh.has_custom_normals:
        return None
    if CORNER_NORMALS:
        sharp = mesh.attributes.get("sharp_edge")
        if sharp is None or sharp.domain != "EDGE" or sharp.data_type != "BOOLEAN":
            return ()
        flags = np.empty(len(mesh.edges), np.bool_)
        sharp.data.foreach_get("value", flags)
        return (flags,)
    if not mesh.use_auto_smooth:
        return ()
    flags = np.empty(len(mesh.edges), np.bool_)
    mesh.edges.foreach_get("use_edge_sharp", flags)
    return flags, np.array([mesh.auto_smooth_angle], np.float32)


def corner_normals(mesh: Any) -> FloatArray:
    """Shading normals by corner [corners, 3]."""
    result = np.empty(len(mesh.loops) * 3, np.float32)
    if CORNER_NORMALS:
        mesh.corner_normals.foreach_get("vector", result)
    else:
        mesh.calc_normals_split()
        mesh.loops.foreach_get("normal", result)
        mesh.free_normals_split()
    return result.reshape(-1, 3)


def vertex_normals(mesh: Any) -> FloatArray:
    """Shading normals by vertex [vertices, 3]."""
    result = np.empty(len(mesh.vertices) * 3, np.float32)
    mesh.vertex_normals.foreach_get("vector", result)
    return result.reshape(-1, 3)


def face_materials(mesh: Any) -> IntArray | None:
    """Material slot of each face [faces]; None: all are in the first."""
    attribute = mesh.attributes.get("material_index")
    if attribute is None or attribute.domain != "FACE" or attribute.data_type != "INT":
        return None
    result = np.empty(len(mesh.polygons), np.int32)
    attribute.data.foreach_get("value", result)
    return result if result.any() else None


def corner_uvs(mesh: Any) -> FloatArray | None:
    """The UV map that is used for renders [corners, 2]; None: there is none."""
    layer = next((layer for layer in mesh.uv_layers if layer.active_render), None)
    return None if layer is None else uvs_of_layer(mesh, layer)


def uvs_of_layer(mesh: Any, layer: Any) -> FloatArray:
    """One of a mesh's UV maps [corners, 2]."""
    result = np.empty(len(mesh.loops) * 2, np.float32)
    if hasattr(layer, "uv"):  # from 3.5
        layer.uv.foreach_get("vector", result)
    else:
        layer.data.foreach_get("uv", result)
    return result.reshape(-1, 2)


@contextmanager
def mesh_of(obj: Any) -> Iterator[Any]:
    """The evaluated mesh of an object of type MESH; freed afterwards if it is a copy.

    An object in edit mode, or one whose subdivision is left to the graphics card, holds its final
    mesh elsewhere: only `to_mesh` finds it.
    """
    if not is_deferred(obj):
        yield obj.data
        return
    try:
        yield obj.to_mesh()
    finally:
        obj.to_mesh_clear()


def is_deferred(obj: Any) -> bool:
    if obj.mode == "EDIT":
        return True
    modifiers = obj.modifiers
    return not bpy.app.background and len(modifiers) > 0 and modifiers[-1].type == "SUBSURF"


def has_adaptive_subdivision(scene: Any, obj: Any) -> bool:
    """Whether Cycles would subdivide an object by its size in the picture."""
    modifiers = obj.modifiers
    if not len(modifiers) or modifiers[-1].type != "SUBSURF" or not modifiers[-1].show_render:
        return False
    if hasattr(modifiers[-1], "use_adaptive_subdivision"):  # from 5.0
        return bool(modifiers[-1].use_adaptive_subdivision)
    if getattr(cycles_or(scene, None), "feature_set", "") != "EXPERIMENTAL":
        return False
    return bool(getattr(cycles_or(obj, None), "use_adaptive_subdivision", False))


def has_overscan(scene: Any) -> bool:
    """Whether a file was made for EEVEE to render more than the frame."""
    return bool(getattr(scene.eevee, "use_overscan", False))


def shader_nodes(owner: Any) -> Any | None:
    """The node tree that a world or material uses, or None (from 5.0 each has one)."""
    if VERSION < (5, 0, 0) and not owner.use_nodes:
        return None
    return owner.node_tree


def aov_name(node: Any) -> str:
    """Which AOV an AOV Output node writes to; once it was the name of the node itself."""
    return str(node.aov_name if hasattr(node, "aov_name") else node.name)


def compositor_nodes(scene: Any) -> Any | None:
    """The compositor's node tree that a scene uses, or None."""
    if hasattr(scene, "compositing_node_group"):  # from 5.0
        return scene.compositing_node_group
    return scene.node_tree if scene.use_nodes else None


CURVE_SUBDIVISIONS = 2  # Cycles' default
MAX_CURVE_SUBDIVISIONS = 8  # the core's limit; nobody sees the pieces long before


def curve_shape(scene: Any) -> tuple[str, int]:
    """RIBBONS, THICK or, from 5.0, THICK_LINEAR, and the subdivisions of ribbons: Cycles' settings,
    or its defaults where that add-on is off."""
    settings = getattr(scene, "cycles_curves", None)
    if settings is None:
        return "RIBBONS", CURVE_SUBDIVISIONS
    return settings.shape, min(settings.subdivisions, MAX_CURVE_SUBDIVISIONS)


POLY = 1  # of the attribute curve_type


def are_linear(curves: Any) -> bool:
    """Whether Cycles draws Curves data straight from point to point, whatever the scene's shape:
    from 5.0 on, where the first curve is a poly curve."""
    if VERSION < (5, 0, 0):
        return False
    kinds = curves.attributes.get("curve_type")
    return kinds is not None and len(kinds.data) > 0 and kinds.data[0].value == POLY


def point_attribute(data: Any, name: str, kind: str, columns: int) -> FloatArray | None:
    """The attribute of curves' or a cloud's points [points, columns]; None when there is none.

    kind: FLOAT or FLOAT_VECTOR, as Blender's data_type.
    """
    attribute = data.attributes.get(name)
    if attribute is None or attribute.domain != "POINT" or attribute.data_type != kind:
        return None
    result = np.empty(len(attribute.data) * columns, np.float32)
    attribute.data.foreach_get("value" if columns == 1 else "vector", result)
    return result.reshape(-1, columns)


def curve_uvs(data: Any) -> FloatArray | None:
    """The first pair of numbers that each curve has [curves, 2], as Cycles takes it for its UVs."""
    for attribute in data.attributes:
        if attribute.domain == "CURVE" and attribute.data_type == "FLOAT2":
            result = np.empty(len(attribute.data) * 2, np.float32)
            attribute.data.foreach_get("vector", result)
            return result.reshape(-1, 2)
    return None


def curve_offsets(data: Any) -> IntArray:
    """The first point of each curve and, at the end, the number of points [curves + 1]."""
    result = np.zeros(len(data.curves) + 1, np.int32)
    if len(data.curves):
        data.curve_offset_data.foreach_get("value", result)
    return result


def panorama_settings(camera: Any) -> Any | None:
    """What holds a camera's `panorama_type` and its numbers: the camera, or in old releases the
    properties that the Cycles add-on gives it; None when that is switched off."""
    if "panorama_type" in camera.bl_rna.properties:
        return camera
    return getattr(camera, "cycles", None)


def motion_steps(obj: Any) -> int:
    """Cycles' number for how often an object's motion is looked at, 1 without Cycles; 0: its motion
    blur is switched off."""
    settings = cycles_or(obj, None)
    if settings is None:
        return 1
    return max(1, settings.motion_steps) if settings.use_motion_blur else 0


def uses_deform_motion(obj: Any) -> bool:
    """Whether an object is blurred by how it deforms, too."""
    settings = cycles_or(obj, None)
    return settings is None or bool(settings.use_deform_motion)


def motion_blur_position(scene: Any) -> str:
    """START, CENTER or END: what of the shutter's time the frame is."""
    if hasattr(scene.render, "motion_blur_position"):  # from 4.1
        return str(scene.render.motion_blur_position)
    return str(getattr(cycles_or(scene, None), "motion_blur_position", "CENTER"))


def rolling_shutter(scene: Any) -> float | None:
    """The exposure of each row in shutter times, if rows are exposed one after the other."""
    settings = cycles_or(scene, None)
    if settings is None or settings.rolling_shutter_type != "TOP":
        return None
    return float(settings.rolling_shutter_duration)
