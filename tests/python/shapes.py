"""Meshes, cameras and scenes for the tests, as plain arrays."""

from __future__ import annotations

from typing import Any

import komorebi_core as core
import numpy as np

Arrays = tuple[np.ndarray, np.ndarray, np.ndarray]


def grid(n: int, half: float) -> Arrays:
    """n × n quads in the plane z = 0: positions, corner vertices, face offsets."""
    line = np.linspace(-half, half, n + 1)
    x, y = np.meshgrid(line, line)
    positions = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], 1).astype(np.float32)
    column, row = np.meshgrid(np.arange(n), np.arange(n))
    first = (row * (n + 1) + column).ravel()
    faces = np.stack([first, first + 1, first + n + 2, first + n + 1], 1)
    return positions, faces.astype(np.int32).ravel(), np.arange(0, 4 * n * n + 1, 4, dtype=np.int32)


def cube(half: float = 1.0) -> Arrays:
    """A cube of six quads around the origin."""
    positions = np.array(
        [[x, y, z] for z in (-half, half) for y in (-half, half) for x in (-half, half)], np.float32
    )
    faces = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5]
    return positions, np.array(faces, np.int32), np.arange(0, 25, 4, dtype=np.int32)


def look_at(eye: Any, target: Any) -> np.ndarray:
    """View matrix (4, 4) in doubles, z up."""
    eye = np.asarray(eye, float)
    forward = np.asarray(target, float) - eye
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    view = np.eye(4)
    view[:3, :3] = right, np.cross(right, forward), -forward
    view[:3, 3] = -view[:3, :3] @ eye
    return view


def perspective(focal: float, aspect: float, near: float, far: float) -> np.ndarray:
    """Projection matrix as Blender's and OpenGL's; `focal` over half the picture's height."""
    depth = far - near
    return np.array(
        [
            [focal / aspect, 0, 0, 0],
            [0, focal, 0, 0],
            [0, 0, -(far + near) / depth, -2 * far * near / depth],
            [0, 0, -1, 0],
        ]
    )


def scene(width: int = 64, height: int = 48, committed: bool = True) -> core.Scene:
    """A cube on a plane under a white sky."""
    made = core.Scene()
    one = np.zeros(1, np.uint32)
    lifted = np.eye(4)
    lifted[2, 3] = 1.0
    made.add_instances(made.add_mesh(core.Mesh("ground", *grid(8, 20.0))), np.eye(4)[None], one)
    made.add_instances(made.add_mesh(core.Mesh("cube", *cube())), lifted[None], one)
    made.set_world_color((1.0, 1.0, 1.0))
    camera = perspective(2.2, width / height, 0.1, 100.0) @ look_at((6, -5, 4), (0, 0, 0.7))
    made.set_camera("PERSPECTIVE", camera, 0.1, 100.0, width, height)
    if committed:
        made.commit()
    return made


def finish(session: core.Session) -> core.Session:
    """Waits for the end of a render and raises if it failed."""
    while not session.wait(10.0):
        pass
    assert session.error is None, session.error
    return session
