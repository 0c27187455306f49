"""From the session's film into Blender's render result."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from . import compat
from .errors import RenderError
from .framing import Region
from .passes import Pass
from .scene_data import FloatArray

Tile = tuple[int, int, int, int]
Fields = dict[str, str]

# The core's passes that are light, and so scaled by the film's exposure.
EXPOSED = {"Combined", "Environment", "Emission"}
BAND_PIXELS = 1 << 23
DUTY = 10.0  # showing tiles may take a tenth of the time


class ResultWriter:
    """Writes one view of one view layer; tiles are relative to the region."""

    def __init__(
        self, engine: Any, layer: str, view: str, region: Region, passes: list[Pass],
        exposure: float = 1.0,
    ) -> None:  # fmt: skip
        self._engine = engine
        self._layer, self._view = layer, view
        self._passes = passes
        self._exposure = np.float32(exposure)  # of the film
        self._width, self._height = region[2] - region[0], region[3] - region[1]
        self._pending: set[Tile] = set()
        self._next = 0.0

    def show(self, session: Any, tiles: Sequence[Sequence[int]]) -> None:
        """Brings finished tiles to the screen; holds them back while that would cost too much."""
        self._pending.update((x, y, width, height) for x, y, width, height in tiles)
        start = time.monotonic()
        if not self._pending or start < self._next:
            return
        covered = sum(width * height for _, _, width, height in self._pending)
        if compat.WHOLE_RESULTS or 2 * covered > self._width * self._height:
            self._write(session, (0, 0, self._width, self._height), self._passes[:1])
        else:
            for tile in self._pending:
                self._write(session, tile, self._passes[:1])
        self._pending.clear()
        end = time.monotonic()
        self._next = end + DUTY * (end - start)

    def finish(self, session: Any, fields: Fields, combined: FloatArray | None = None) -> None:
        """Writes every pass of the whole region; `combined` takes the place of that pass.

        `fields` go into the file of the picture.
        """
        self._write_all(session, self._passes, combined)
        result = self._engine.get_result()
        for name, value in fields.items():
            result.stamp_data_add_field(name, value)

    def replace(self, session: Any, combined: FloatArray) -> None:
        """Writes Combined anew."""
        self._write_all(session, self._passes[:1], combined)

    def _write_all(self, session: Any, passes: list[Pass], combined: FloatArray | None) -> None:
        # In bands, so that a large picture is not held a third time on its way.
        rows = max(1, BAND_PIXELS // self._width)
        for y in range(0, self._height, rows):
            height = min(rows, self._height - y)
            band = None if combined is None else combined[y : y + height]
            self._write(session, (0, y, self._width, height), passes, band)

    def _write(
        self, session: Any, tile: Tile, passes: list[Pass], combined: FloatArray | None = None
    ) -> None:
        x, y, width, height = tile
        result = self._engine.begin_result(x, y, width, height, layer=self._layer, view=self._view)
        if result is None:
            raise RenderError("Blender has no place for the picture")
        try:
            if (result.resolution_x, result.resolution_y) != (width, height):
                raise RenderError(
                    f"Blender expects {result.resolution_x} × {result.resolution_y} pixels, "
                    f"not {width} × {height}"
                )
            layer_passes = result.layers[0].passes
            for p in passes:
                target = layer_passes.find_by_name(p.name, self._view)
                if target is None:
                    continue
                if combined is not None and p.name == "Combined":
                    compat.set_rect(target, self._exposed(p, combined))
                elif p.is_read:  # else Blender's zeros stay
                    pixels = self._exposed(p, session.read(p.source, x, y, width, height))
                    compat.set_rect(target, np.broadcast_to(pixels, (height, width, p.channels)))
        finally:
            self._engine.end_result(result)

    def _exposed(self, p: Pass, pixels: FloatArray) -> FloatArray:
        """Light as the film's exposure shows it; alpha stays."""
        if self._exposure == 1.0 or p.source not in EXPOSED:
            return pixels
        shown = pixels.copy()
        shown[:, :, :3] *= self._exposure
        return shown
