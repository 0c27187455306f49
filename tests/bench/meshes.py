"""The meshes that the bench measures, and where they are found."""

from __future__ import annotations

import gzip
import json
import os
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
FOLDER = PROJECT / "build" / "bench"
GLTF_TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
PLY_TYPES = {"float": "<f4", "float32": "<f4", "double": "<f8", "int": "<i4", "uint": "<u4"}


class Missing(RuntimeError):
    """A file that the bench needs is not there; the message names it."""


def shared_folder() -> Path:
    """Meshes, maps and scenes too large for the repository: $KOMOREBI_SHARED or ../shared."""
    return Path(os.environ.get("KOMOREBI_SHARED") or PROJECT.parent / "shared") / "data"


def shared_file(name: str) -> Path:
    """A file of the shared data, `meshes/bunny_hr.obj`; raises Missing when it is not there."""
    path = shared_folder() / name
    if not path.is_file():
        raise Missing(f"{path} is not there (KOMOREBI_SHARED names another folder)")
    return path


@dataclass(frozen=True)
class Mesh:
    """Triangles: float32 [V, 3] positions in metres, uint32 [T, 3] corners."""

    positions: np.ndarray
    corners: np.ndarray


def read_glb(path: Path) -> Mesh:
    """All triangles of a binary glTF without node transforms, extensions or sparse accessors."""
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    content: dict[str, Any] = json.loads(data[20 : 20 + length])
    binary = memoryview(data)[28 + length :]
    if any({"matrix", "translation", "rotation", "scale"} & set(n) for n in content["nodes"]):
        raise ValueError(f"{path}: nodes with transforms are not read")

    def values(index: int, width: int) -> np.ndarray:
        accessor = content["accessors"][index]
        view = content["bufferViews"][accessor["bufferView"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        kind = np.dtype(GLTF_TYPES[accessor["componentType"]])
        shape = (accessor["count"], width)
        strides = (view.get("byteStride", width * kind.itemsize), kind.itemsize)
        return np.ndarray(shape, kind, binary, start, strides)

    positions, corners, first = [], [], 0
    for mesh in content["meshes"]:
        for part in mesh["primitives"]:
            if part.get("mode", 4) != 4:
                continue
            points = values(part["attributes"]["POSITION"], 3)
            corners.append(values(part["indices"], 1).reshape(-1, 3).astype(np.uint32) + first)
            positions.append(points)
            first += len(points)
    return Mesh(np.concatenate(positions).astype(np.float32), np.concatenate(corners))


def read_ply(path: Path) -> Mesh:
    """Triangles of a PLY, packed or not, text or little-endian, whose faces are all triangles."""
    data = gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()
    end = data.index(b"end_header")
    body = data.index(b"\n", end) + 1
    words = [line.split() for line in data[:end].decode("ascii").splitlines()]
    count = {w[1]: int(w[2]) for w in words if w[0] == "element"}
    named = [(w[2], w[1]) for w in words if w[0] == "property" and w[1] != "list"]
    if words[1][1] == "ascii":
        rest = np.array(data[body:].split(), np.float64)
        split = count["vertex"] * len(named)
        points = rest[:split].reshape(-1, len(named))[:, :3].astype(np.float32)
        corners = rest[split:].reshape(-1, 4)
    else:
        kind = np.dtype([(name, PLY_TYPES[word]) for name, word in named])
        table = np.frombuffer(data, kind, count["vertex"], body)
        points = np.stack([table[axis] for axis in "xyz"], axis=1).astype(np.float32)
        face = np.dtype([("count", "u1"), ("corner", "<i4", 3)])
        faces = np.frombuffer(data, face, count["face"], body + table.nbytes)
        corners = np.column_stack([faces["count"], faces["corner"]])
    if len(corners) and (corners[:, 0] != 3).any():
        raise ValueError(f"{path}: faces that are no triangles are not read")
    return Mesh(points, corners[:, 1:].astype(np.uint32))


def read(path: Path) -> Mesh:
    """By the ending: .glb, .ply, .ply.gz."""
    return read_glb(path) if path.suffix == ".glb" else read_ply(path)


def write_ply(path: Path, mesh: Mesh) -> None:
    """A little-endian PLY, for readers that know nothing else."""
    face = np.dtype([("count", "u1"), ("corner", "<i4", 3)])
    faces = np.empty(len(mesh.corners), face)
    faces["count"], faces["corner"] = 3, mesh.corners
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(mesh.positions)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    body = mesh.positions.astype("<f4").tobytes() + faces.tobytes()
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(header.encode("ascii") + body)


def readable_by_core(name: str) -> Path:
    """A shared mesh as a file that the C++ part reads: itself, or a PLY made of a GLB."""
    path = shared_file(f"meshes/{name}")
    if path.suffix != ".glb":
        return path
    made = FOLDER / "meshes" / f"{path.stem}.ply"
    if not made.is_file() or made.stat().st_mtime < path.stat().st_mtime:
        write_ply(made, read_glb(path))
    return made
