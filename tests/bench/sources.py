"""The meshes of build, rays and memory, and from where their rays start."""

from __future__ import annotations

from dataclasses import dataclass

from bench.meshes import readable_by_core


@dataclass(frozen=True)
class Source:
    """A mesh by name: a file of the shared meshes or a generator of the C++ part (`forest:300`)."""

    name: str
    file: str
    up: str = "y"
    view: str = ""  # eye and direction, six numbers; empty: from outside
    generator: str = ""

    def argument(self) -> str:
        """What the C++ part is given; raises meshes.Missing when the file is not there."""
        if not self.file:
            return self.generator
        path = str(readable_by_core(self.file))
        return f"{self.generator}:{path}" if self.generator else path


SOURCES = (
    Source("bunny", "bunny_hr.obj"),
    Source("dragon", "dragon_vrip.ply.gz"),
    Source("apartment", "dream-apartment.glb", view="6.6,1.5,-5.8,-1,-0.15,0.6"),
    Source("sponza", "sponza_dabrovic.ply", view="-10,5,-0.5,1,-0.02,0.05"),
    Source("brain", "brain_colin27_iso60.ply.gz", up="z"),
    Source("motorbike", "motorBike.obj.gz", up="z"),
    Source("forest", "", generator="forest:150"),
    Source("dragon×6", "dragon_vrip.ply.gz", generator="subdivided"),
)
