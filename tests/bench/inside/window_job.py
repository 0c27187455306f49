"""Runs inside a Blender with a window, started by bench/window.py: sets up scenes and edits them.

    blender -P tests/bench/inside/window_job.py -- SOCKET

A timer calls the functions of this file whose names come over the socket, as ["name", arguments…]
in JSON and a zero byte, and answers with when it began and what they returned.
"""

from __future__ import annotations

import json
import os
import socket
import sys
import time
import traceback
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Quaternion, Vector

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blender"))
sys.path.insert(0, str(Path(__file__).resolve().parent))
import bare_engine
import support

TICK_SECONDS = 0.005
ORBIT_SECONDS = 1.0 / 60.0
LATE_SECONDS = 0.01  # the interval of the timer whose lateness is measured

ticks: list[float] = []  # when the view was turned, or the frame changed
lateness: list[float] = []
on = {"orbit": False, "late": False}


def view() -> dict[str, Any]:
    """Looked up each time: full screen replaces areas and regions."""
    window = bpy.context.window_manager.windows[0]
    area = next(a for a in window.screen.areas if a.type == "VIEW_3D")
    region = next(r for r in area.regions if r.type == "WINDOW")
    return {"window": window, "area": area, "region": region}


def space() -> Any:
    return view()["area"].spaces.active


def full_screen() -> None:
    """The viewport is all of the window."""
    with bpy.context.temp_override(**view()):
        bpy.ops.screen.screen_full_area(use_hide_panels=True)


def set_up(engine: str, method: str) -> None:
    """A viewport in Solid shading; an even white world, no light but its own.

    Without overlays: for them Blender draws all meshes' depth at each redraw, which takes software
    OpenGL longer than all else.
    """
    shown = space()
    shown.shading.type = "SOLID"
    shown.show_gizmo = False
    shown.overlay.show_overlays = False
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.view_settings.view_transform = "Standard"
    scene.world.use_nodes = True
    node = scene.world.node_tree.nodes["Background"]
    node.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    node.inputs["Strength"].default_value = 1.0
    cycles = scene.cycles
    cycles.use_preview_denoising = cycles.use_preview_adaptive_sampling = False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = 0
    cycles.transmission_bounces = cycles.volume_bounces = 0
    scene.komorebi.method, scene.komorebi.bounces = method, 0
    scene.update_tag()


def engine(name: str) -> None:
    bpy.context.scene.render.engine = name


def samples(count: int) -> None:
    scene = bpy.context.scene
    scene.cycles.preview_samples = scene.komorebi.preview_samples = count
    scene.update_tag()  # properties that Python sets do not reach a viewport by themselves


def mesh_object(name: str, positions: Any, corners: Any, smooth: bool) -> Any:
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(positions))
    mesh.vertices.foreach_set("co", np.ascontiguousarray(positions, np.float32).ravel())
    size = corners.shape[1]
    mesh.loops.add(corners.size)
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(corners, np.int32).ravel())
    mesh.polygons.add(len(corners))
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, size, dtype=np.int32))
    if bpy.app.version < (3, 6, 0):
        mesh.polygons.foreach_set("loop_total", np.full(len(corners), size, np.int32))
    mesh.polygons.foreach_set("use_smooth", np.full(len(corners), smooth, np.bool_))
    mesh.update(calc_edges=True)
    mesh.validate()
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def new_scene(kind: str, file: str, faces: int) -> int:
    """`kind` is "file" (a mesh as .npz, upright, 1.44 m high), "grid" (about `faces` smooth
    triangles) or "waves" (a grid that deforms from frame to frame), on a ground. Returns the number
    of triangles."""
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    for mesh in list(bpy.data.meshes):
        bpy.data.meshes.remove(mesh)
    if kind == "file":
        stored = np.load(file)
        points = stored["positions"][:, [0, 2, 1]].astype(np.float64) * [1.0, -1.0, 1.0]
        low, high = points.min(axis=0), points.max(axis=0)
        middle = np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
        subject = mesh_object(
            "Subject", (points - middle) * (1.44 / (high[2] - low[2])), stored["corners"], False
        )
    else:
        subject = mesh_object("Subject", *grid(faces), True)
    if kind == "waves":
        waves = subject.modifiers.new("Waves", "WAVE")
        waves.height, waves.width, waves.speed = 0.2, 0.6, 0.05
    ground = np.array([(-60, -60, 0), (60, -60, 0), (60, 60, 0), (-60, 60, 0)], np.float32)
    mesh_object("Ground", ground - [0.0, 0.0, 0.01], np.array([(0, 1, 2, 3)]), False)
    material = bpy.data.materials.new("White")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    subject.data.materials.append(material)
    look = space().region_3d
    look.view_perspective = "PERSP"
    look.view_rotation = Vector((-1.0, 4.2, -0.4)).to_track_quat("-Z", "Y")
    look.view_location, look.view_distance = (0.0, 0.0, 0.68), 4.4
    space().lens = 80.0
    return len(subject.data.polygons)


def grid(faces: int) -> tuple[Any, Any]:
    """A wavy square of triangles, two metres wide, half a metre above the ground."""
    side = round((faces / 2) ** 0.5)
    y, x = np.mgrid[0 : side + 1, 0 : side + 1].astype(np.float32) / np.float32(side) * 2 - 1
    z = 0.6 + 0.2 * np.sin(5 * x) * np.cos(7 * y)
    index = np.arange((side + 1) ** 2).reshape(side + 1, side + 1)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    corners = np.stack([k.ravel() for k in (a, b, c, a, c, d)], -1).reshape(-1, 3)
    return np.stack([x, y, z], -1).reshape(-1, 3), corners


# The edits.


def shade(kind: str) -> None:
    space().shading.type = kind


def switch() -> None:
    shade("RENDERED")


def move_object() -> None:
    subject = bpy.data.objects["Subject"]
    subject.location.x = 0.1 if subject.location.x < 0.05 else 0.0


def move_view() -> None:
    on["side"] = not on.get("side", False)
    turn = Quaternion((0, 0, 1), 0.03 if on["side"] else -0.03)
    look = space().region_3d
    look.view_rotation = look.view_rotation @ turn


def move_vertex() -> None:
    mesh = bpy.data.objects["Subject"].data
    mesh.vertices[0].co.z += 0.01
    mesh.update()


def change_color() -> None:
    nodes = bpy.data.objects["Subject"].data.materials[0].node_tree.nodes
    color = next(n for n in nodes if n.type == "BSDF_DIFFUSE").inputs["Color"].default_value
    color[1] = 0.5 if color[1] > 0.6 else 0.8


def change_world() -> None:
    strength = bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"]
    strength.default_value = 0.7 if strength.default_value > 0.8 else 1.0


# What goes on by itself.


def start_orbit() -> None:
    ticks.clear()
    on["orbit"] = True
    bpy.app.timers.register(_orbit)


def _orbit() -> float | None:
    if not on["orbit"]:
        return None
    look = space().region_3d
    look.view_rotation = Quaternion((0, 0, 1), 0.02) @ look.view_rotation
    ticks.append(time.monotonic())
    return ORBIT_SECONDS


def start_playback() -> None:
    """Every frame is played, as fast as it goes."""
    ticks.clear()
    scene = bpy.context.scene
    scene.sync_mode, scene.render.fps, scene.frame_end = "NONE", 120, 100000
    bpy.app.handlers.frame_change_post.append(_frame_changed)
    with bpy.context.temp_override(**view()):
        bpy.ops.screen.animation_play()


def _frame_changed(*_: Any) -> None:
    ticks.append(time.monotonic())


def stop() -> list[float]:
    """Ends orbit or playback; when there was a new view or frame."""
    if not on["orbit"]:
        with bpy.context.temp_override(**view()):
            bpy.ops.screen.animation_cancel(restore_frame=False)
        bpy.app.handlers.frame_change_post.remove(_frame_changed)
    on["orbit"] = False
    return list(ticks)


def start_lateness() -> None:
    lateness.clear()
    on["late"], due = True, [time.monotonic()]

    def late() -> float | None:
        now = time.monotonic()
        lateness.append(now - due[0])
        due[0] = time.monotonic() + LATE_SECONDS
        return LATE_SECONDS if on["late"] else None

    bpy.app.timers.register(late)


def late_count() -> int:
    return len(lateness)


def stop_lateness() -> list[float]:
    """Seconds by which a timer came later than it should have."""
    on["late"] = False
    return lateness[1:]


def serve(path: str) -> None:
    """Answers whoever listens at the socket; Blender ends with it."""
    connection = socket.socket(socket.AF_UNIX)
    connection.connect(path)
    connection.setblocking(False)
    received = bytearray()

    def tick() -> float:
        try:
            data = connection.recv(1 << 16)
            if not data:
                os._exit(4)
            received.extend(data)
        except BlockingIOError:
            pass
        while b"\0" in received:
            call, _, rest = bytes(received).partition(b"\0")
            received[:] = rest
            name, *arguments = json.loads(call)
            began = time.monotonic()
            try:
                answer = {"began": began, "value": globals()[name](*arguments)}
            except Exception:
                answer = {"error": traceback.format_exc()}
            connection.sendall(json.dumps(answer).encode() + b"\0")
        return TICK_SECONDS

    bpy.app.timers.register(tick, first_interval=0.5, persistent=True)


if __name__ == "__main__":
    bpy.context.preferences.view.show_splash = False
    support.enable()
    bare_engine.register()
    serve(sys.argv[sys.argv.index("--") + 1])
