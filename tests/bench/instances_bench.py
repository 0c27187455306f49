"""Seconds and bytes from Blender's instances to the committed scene, as JSON on the last line.

    blender -b --factory-startup -P tests/bench/instances_bench.py -- [COUNT [REPEATS]]
    build/venv/bpy/bin/python tests/bench/instances_bench.py [COUNT [REPEATS]]

The add-on and its module are found as in the tests. COUNT (1,000,000) instances of a triangle of
each kind of instancer (tests/blender/many_instances.py), with the instancer first in the scene and
with a mesh before it, are rendered REPEATS (3) times at 8 × 8 pixels. Peaks are those of the whole
process above what it held before: while the scene is exported, which Blender's own list of the
instances (220 bytes each) is part of, and while the core's scene is built.
"""

from __future__ import annotations

import json
import statistics
import sys
import time
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).parents[1] / "blender"))
import many_instances
import support


def status_bytes(name: str) -> int:
    """VmRSS or VmHWM of this process."""
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith(f"{name}:"):
            return 1024 * int(line.split()[1])
    raise RuntimeError(f"the system does not tell {name}")


class Gauge:
    """Processor seconds and peak bytes of some functions of the add-on, in their last run."""

    def __init__(self, *names: tuple[Any, str]) -> None:
        self.seconds: dict[str, float] = {}
        self.bytes: dict[str, int] = {}
        for module, name in names:
            setattr(module, name, self._measured(name, getattr(module, name)))

    def _measured(self, name: str, function: Any) -> Any:
        def measured(*args: Any, **kwargs: Any) -> Any:
            support.resident_bytes()  # gives back what the allocator keeps
            Path("/proc/self/clear_refs").write_text("5", encoding="ascii")  # forgets the peak
            before, start = status_bytes("VmRSS"), time.process_time()
            try:
                return function(*args, **kwargs)
            finally:
                self.seconds[name] = time.process_time() - start
                self.bytes[name] = status_bytes("VmHWM") - before

        return measured


def measure(kind: str, instancer_first: bool, count: int, repeats: int, gauge: Gauge) -> Any:
    support.fresh_scene(size=(8, 8), samples=1)
    many_instances.make(kind, count, instancer_first)
    scene = bpy.context.scene
    graph = bpy.context.evaluated_depsgraph_get()
    instances = sum(1 for _ in graph.object_instances)
    times: dict[str, list[float]] = {"export_instances": [], "build": []}
    peaks: dict[str, list[float]] = {"export_instances": [], "build": []}
    for _ in range(repeats):
        bpy.ops.render.render(scene=scene.name)
        for name in times:
            times[name].append(gauge.seconds[name] / instances * 1e6)
            peaks[name].append(gauge.bytes[name] / instances)
    return {
        "blender": bpy.app.version_string, "kind": kind, "instancer_first": instancer_first,
        "instances": instances,
        "export_seconds_per_million": times["export_instances"],
        "build_seconds_per_million": times["build"],
        "export_peak_bytes": statistics.median(peaks["export_instances"]),
        "build_peak_bytes": statistics.median(peaks["build"]),
    }  # fmt: skip


def main(arguments: list[str]) -> None:
    count = int(arguments[0]) if arguments else 1_000_000
    repeats = int(arguments[1]) if len(arguments) > 1 else 3
    support.enable()
    from komorebi import export, native_scene

    gauge = Gauge((export, "export_instances"), (native_scene, "build"))
    rows = [
        measure(kind, first, count, repeats, gauge)
        for kind in many_instances.KINDS
        for first in (True, False)
    ]
    print(json.dumps(rows))


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:])
