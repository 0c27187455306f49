"""What a million instances take in the core: when they are added, committed and afterwards."""

from __future__ import annotations

import ctypes
from pathlib import Path

import komorebi_core as core
import numpy as np
import pytest
import shapes

COUNT = 1_000_000
CAMERA = shapes.perspective(2.0, 1.0, 0.1, 100.0) @ shapes.look_at((0, -8, 0), (0, 0, 0))


def status(name: str) -> int:
    """VmRSS or VmHWM of this process, in bytes."""
    text = Path("/proc/self/status").read_text(encoding="ascii")
    return 1024 * int(text.partition(f"\n{name}:")[2].split()[0])


def turned_on_a_grid() -> np.ndarray:
    """float32 [COUNT, 4, 4], each with a turn and height of its own."""
    random = np.random.default_rng(1)
    angle = random.uniform(0.0, 6.0, COUNT)
    matrices = np.zeros((COUNT, 4, 4), np.float32)
    matrices[:, 0, 0] = matrices[:, 1, 1] = np.cos(angle)
    matrices[:, 1, 0] = np.sin(angle)
    matrices[:, 0, 1] = -matrices[:, 1, 0]
    matrices[:, 2, 2] = matrices[:, 3, 3] = 1.0
    matrices[:, 0, 3], matrices[:, 1, 3] = np.divmod(3 * np.arange(COUNT), 3000)
    matrices[:, 2, 3] = random.uniform(0.0, 6.0, COUNT)
    return matrices


# Moving ones need two matrices and boxes more, 72 bytes each, and as many poses while they are
# added as there are.
@pytest.mark.parametrize(("poses", "kept", "peak"), [(1, 150, 310), (3, 320, 1200)])
def test_bytes_of_a_million_instances(poses: int, kept: int, peak: int) -> None:
    scene = core.Scene()
    mesh = scene.add_mesh(core.Mesh("cube", *shapes.cube()))
    matrices = turned_on_a_grid()
    motion = None
    if poses > 1:
        motion = np.repeat(matrices[:, None].astype(np.float64), poses, axis=1)
        motion[:, :, 2, 3] += 0.1 * (np.arange(poses) - poses // 2)
    objects = np.zeros(COUNT, np.uint32)
    ctypes.CDLL(None).malloc_trim(0)
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")  # the peak is that from now on
    before = status("VmRSS")
    scene.add_instances(mesh, matrices, objects, motion=motion)
    scene.set_camera("PERSPECTIVE", CAMERA, 0.1, 100.0, 64, 64)
    scene.commit(keep_inputs=False)
    assert 100 < scene.byte_count / COUNT <= kept
    assert kept < (status("VmHWM") - before) / COUNT <= peak
