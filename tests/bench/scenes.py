"""The scenes of `./run bench pictures`, made once into build/bench/blends."""

from __future__ import annotations

import hashlib
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from compare import launch

from bench import meshes

MAKER = Path(__file__).resolve().parent / "inside" / "make_scene.py"
MAP = "hdri/rooitou_park_1k.hdr"
PYTHON = str(meshes.PROJECT / "build" / "venv" / "bpy" / "bin" / "python")


@dataclass(frozen=True)
class Scene:
    """One row of the table: what is rendered, and under which sky."""

    name: str
    says: str
    mode: str  # ao: white sky; world: the map
    kind: str  # of make_scene.py, or "file"
    source: str  # below the shared data; "": made of nothing
    samples: int = 64  # Cycles', which set the error to be met
    views: int = 0
    size: tuple[int, int] = (1280, 720)
    bounces: int = 0
    materials: bool = False  # its own, made matt, in place of clay
    own_world: bool = False  # in place of the map


SCENES = (
    Scene("dragon-ao", "dragon on a ground, white sky", "ao", "dragon", "meshes/dragon_vrip.ply.gz"),
    Scene("dragon-map", "dragon on a ground, map", "world", "dragon", "meshes/dragon_vrip.ply.gz"),
    Scene("interior-ao", "sponza inside, white sky", "ao", "interior", "meshes/sponza_dabrovic.ply"),
    Scene("interior-map", "sponza inside, map", "world", "interior", "meshes/sponza_dabrovic.ply"),
    Scene("interior-bounces", "sponza inside, map, 4 bounces", "world", "interior", "meshes/sponza_dabrovic.ply", bounces=4),
    Scene("instances-map", "10,000 instances of the dragon, map", "world", "instances", "meshes/dragon_vrip.ply.gz", 16),
    Scene("bmw-ao", "BMW, white sky", "ao", "file", "blends/bmw27_cpu.blend"),
    Scene("leaves-textured", "8,000 cut-out leaves, textures, map", "world", "leaves", "", materials=True),
    Scene("leaves-bounces", "8,000 cut-out leaves, textures, map, 2 bounces", "world", "leaves", "", 32, bounces=2, materials=True),
    Scene("sky-textured", "dragon on tiles under a Sky Texture", "world", "sky", "meshes/dragon_vrip.ply.gz", materials=True, own_world=True),
    Scene("views-map", "24 views of the dragon, map, one process", "world", "dragon", "meshes/dragon_vrip.ply.gz", 32, 24, (512, 512)),
)  # fmt: skip


def blend_file(scene: Scene) -> Path:
    """The .blend of a scene, made now if it is not there or its maker has changed since."""
    if scene.kind == "file":
        return meshes.shared_file(scene.source)
    made = meshes.FOLDER / "blends" / f"{scene.kind}-{version(scene)}.blend"
    if not made.is_file():
        made.parent.mkdir(parents=True, exist_ok=True)
        packed = made.with_suffix(".npz")
        arrays: dict[str, np.ndarray] = {}
        if scene.source:
            mesh = meshes.read(meshes.shared_file(scene.source))
            arrays = {"positions": mesh.positions, "corners": mesh.corners.astype(np.int32)}
        np.savez(packed, **arrays)
        command = [PYTHON, str(MAKER), "--", scene.kind, str(packed), str(made)]
        subprocess.run(command, check=True, capture_output=True, env=launch.environment())
        packed.unlink()
    return made


def version(scene: Scene) -> str:
    """Changes when the scene's picture may."""
    digest = hashlib.sha1(MAKER.read_bytes())
    digest.update(f"{scene.kind} {scene.source}".encode())
    return digest.hexdigest()[:8]
