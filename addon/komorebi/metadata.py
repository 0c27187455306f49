"""What a picture's file tells of how it was rendered."""

from __future__ import annotations

from typing import Any

from . import core, cryptomatte


def fields(frame: Any, session: Any) -> dict[str, str]:
    """Names → values for a view layer (driver.Frame) whose session is over.

    With these numbers, and the same file, the picture can be made again to the bit.
    """
    settings, progress = frame.settings, session.progress()
    prefix = f"komorebi.{frame.layer}"
    result = {
        "komorebi.version": core.load().__version__,
        f"{prefix}.method": settings["method"],
        f"{prefix}.samples": str(progress["sample"]),
        f"{prefix}.light_samples": str(session.resolved["light_samples"]),
        f"{prefix}.seed": str(settings["seed"]),
        f"{prefix}.render_seconds": f"{progress['elapsed']:.3f}",
    }
    for matte, names in frame.mattes.items():
        result |= cryptomatte.metadata(frame.layer, matte, names)
    return result
