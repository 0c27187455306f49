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
    mode: str  # ao: white sky; world: the map; nodes: the file's world
    kind: str  # of make_scene.py, or "file"
    source: str  # below the shared data
    samples: int = 64  # Cycles', which set the error to be met
    views: int = 0
    size: tuple[int, int] = (1280, 720)
    bounces: int = 0
    materials: bool = False  # the file's own, and its world where the mode is "nodes"

    @property
    def has_map(self) -> bool:
        return self.mode == "world"


SCENES = (
    Scene("dragon-ao", "dragon on a ground, white sky", "ao", "dragon", "meshes/dragon_vrip.ply.gz"),
    Scene("dragon-map", "dragon on a ground, map", "world", "dragon", "meshes/dragon_vrip.ply.gz"),
    Scene("interior-ao", "sponza inside, white sky", "ao", "interior", "meshes/sponza_dabrovic.ply"),
    Scene("interior-map", "sponza inside, map", "world", "interior", "meshes/sponza_dabrovic.ply"),
    Scene("interior-bounces", "sponza inside, map, 4 bounces", "world", "interior", "meshes/sponza_dabrovic.ply", bounces=4),
    Scene("leaves-textured", "a grove of pictures on cards, map", "world", "leaves", "meshes/dragon_vrip.ply.gz", 32, materials=True),
    Scene("leaves-bounces", "the same, 4 bounces", "world", "leaves", "meshes/dragon_vrip.ply.gz", 32, bounces=4, materials=True),
    Scene("dragon-sky", "dragon on tiles, Sky Texture with its sun", "nodes", "sky", "meshes/dragon_vrip.ply.gz", materials=True),
    Scene("instances-map", "10,000 instances of the dragon, map", "world", "instances", "meshes/dragon_vrip.ply.gz", 16),
    Scene("bmw-ao", "BMW, white sky", "ao", "file", "blends/bmw27_cpu.blend"),
    Scene("views-map", "24 views of the dragon, map, one process", "world", "dragon", "meshes/dragon_vrip.ply.gz", 32, 24, (512, 512)),
)  # fmt: skip


def blend_file(scene: Scene) -> Path:
    """The .blend of a scene, made now if it is not there or its maker has changed since."""
    source = meshes.shared_file(scene.source)
    if scene.kind == "file":
        return source
    made = meshes.FOLDER / "blends" / f"{scene.kind}-{version(scene)}.blend"
    if not made.is_file():
        made.parent.mkdir(parents=True, exist_ok=True)
        mesh, packed = meshes.read(source), made.with_suffix(".npz")
        np.savez(packed, positions=mesh.positions, corners=mesh.corners.astype(np.int32))
        command = [PYTHON, str(MAKER), "--", scene.kind, str(packed), str(made)]
        subprocess.run(command, check=True, capture_output=True, env=launch.environment())
        packed.unlink()
    return made


def version(scene: Scene) -> str:
    """Changes when the scene's picture may."""
    digest = hashlib.sha1(MAKER.read_bytes())
    digest.update(f"{scene.kind} {scene.source}".encode())
    return digest.hexdigest()[:8]
