"""Hair of particle systems at the other times of the shutter."""

from __future__ import annotations

from typing import Any

from ..scene_data import CurveData
from .hair import export_hair, hair_systems
from .moving_keys import differ

STRIDE = 16  # of the strands that are looked at first


class HairReader:
    """Reads the hair of an emitter again.

    That is slow, strand by strand, and every emitter counts as one that deforms: a particle system
    is a modifier which does. So unless something says that its hair moves, a part of the strands
    tells whether any do.
    """

    def __init__(self, obj: Any, rest: CurveData, scene: Any) -> None:
        self._rest = rest
        self._scene = scene
        self._some = self._read(obj, STRIDE)
        systems = [modifier.particle_system for modifier in hair_systems(obj)]
        self._restless = any(
            system.use_hair_dynamics or system.settings.animation_data is not None
            for system in systems
        )

    def __call__(self, obj: Any, restless: bool) -> CurveData | None:
        """The hair of the same emitter as it is evaluated now; `restless`: something says that it
        moves."""
        if not (restless or self._restless):
            some = self._read(obj, STRIDE)
            if some is not None and self._some is not None and not differ(self._some, some):
                return self._rest
        return self._read(obj, 1)

    def _read(self, obj: Any, stride: int) -> CurveData | None:
        return export_hair(obj, self._rest.name, self._scene, False, stride=stride)
