"""Renders a propeller that stands still, turns or deforms, and is seen by a camera that moves.

    PYTHONPATH=build/release/package:tests/python python tests/bench/motion_job.py [ROUNDS [SIDE]]

Three twisted blades of 2·SIDE² triangles each (SIDE 131: 102,966) at 256 × 256 pixels, 64 samples.
Cases take turns; prints processor seconds of the session alone, a list a case, as JSON.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable

import komorebi_core as core
import numpy as np
import shapes

SIZE = 256
VIEW = shapes.look_at((0.0, -2.6, 0.9), (0.0, 0.0, 0.0))
PROJECTION = shapes.perspective(3.0, 1.0, 0.1, 100.0)


def turned(angle: float) -> np.ndarray:
    """About the propeller's axis, y."""
    matrix = np.eye(4)
    c, s = np.cos(angle), np.sin(angle)
    matrix[0, 0], matrix[0, 2], matrix[2, 0], matrix[2, 2] = c, s, -s, c
    return matrix


def blade(side: int) -> tuple[np.ndarray, np.ndarray]:
    """Positions [V, 3] and corners [T, 3] of one, along x."""
    u, v = np.meshgrid(np.linspace(0.0, 1.0, side + 1), np.linspace(-1.0, 1.0, side + 1))
    twist, width = 1.2 - 0.9 * u, 0.25 * np.sin(np.pi * (0.1 + 0.85 * u))
    ripple = 0.01 * np.sin(40.0 * u) * np.cos(9.0 * v)
    x, across = 0.08 + 0.92 * u, width * v
    at = np.stack([x, across * np.sin(twist) + ripple, across * np.cos(twist)], axis=-1)
    index = np.arange((side + 1) ** 2).reshape(side + 1, side + 1)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    corners = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return at.reshape(-1, 3), corners


def propeller(side: int) -> tuple[np.ndarray, np.ndarray]:
    """Positions float32 [V, 3] and corners int32 [T, 3]."""
    at, corners = blade(side)
    turns = [turned(2.0 * np.pi * k / 3.0)[:3, :3] for k in range(3)]
    return (
        np.concatenate([at @ turn.T for turn in turns]).astype(np.float32),
        np.concatenate([corners + k * len(at) for k in range(3)]).astype(np.int32),
    )


def scene(side: int, turn: float = 0.0, bend: float = 0.0, pan: float = 0.0) -> core.Scene:
    """`turn`: radians of the object while the shutter is open; `bend`: metres by which the blades'
    tips do; `pan`: metres of the camera, to the side."""
    positions, corners = propeller(side)
    offsets = np.arange(0, corners.size + 1, 3, dtype=np.int32)
    deformed = None
    if bend:
        step = np.zeros_like(positions)
        step[:, 1] = bend / 2.0 * (positions[:, 0] ** 2 + positions[:, 2] ** 2)
        deformed = np.stack([positions - step, positions + step])
    made = core.Scene()
    mesh = core.Mesh(
        "propeller", positions, corners.reshape(-1), offsets, builder="SAH",
        motion_positions=deformed,
    )  # fmt: skip
    times = np.linspace(-0.5, 0.5, 33)
    poses = np.array([turned(turn * t) for t in times])[None]
    made.add_instances(
        made.add_mesh(mesh), poses[:, 16], np.zeros(1, np.uint32), motion=poses if turn else None
    )
    camera = {}
    if pan:
        world_from_camera = np.repeat(np.linalg.inv(VIEW)[None], 3, axis=0)
        world_from_camera[:, 0, 3] += pan * np.array([-0.5, 0.0, 0.5])
        camera["motion"] = {"matrices": world_from_camera}
    made.set_camera("PERSPECTIVE", PROJECTION @ VIEW, 0.1, 100.0, SIZE, SIZE, **camera)
    made.set_world_color((1.0, 1.0, 1.0))
    made.commit(keep_inputs=False)
    return made


CASES: dict[str, Callable[[int], core.Scene]] = {
    "nothing moves": scene,
    "camera moves by 0.2 m": lambda side: scene(side, pan=0.2),
    "object turns by 10°": lambda side: scene(side, turn=np.radians(10.0)),
    "object turns by 360°": lambda side: scene(side, turn=np.radians(360.0)),
    "mesh deforms by 0.2 m": lambda side: scene(side, bend=0.2),
}


def main(rounds: int, side: int) -> None:
    settings = core.Settings(samples=64, light_samples=8, film_transparent=True)
    scenes = {name: make(side) for name, make in CASES.items()}
    seconds: dict[str, list[float]] = {name: [] for name in scenes}
    for _ in range(rounds):
        for name, made in scenes.items():
            start = time.process_time()
            picture = shapes.finish(core.Session(made, settings)).read("Combined")
            seconds[name].append(time.process_time() - start)
            assert picture.max() > 0.1, f"{name}: the picture is empty"
    triangles = 6 * side * side
    rows = [{"case": n, "triangles": triangles, "seconds": s} for n, s in seconds.items()]
    print(json.dumps(rows))


if __name__ == "__main__":
    numbers = [int(word) for word in sys.argv[1:]]
    main(*numbers, *(5, 131)[len(numbers) :])
