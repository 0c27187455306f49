"""What the passes of a render have to know of the scene."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is exported besides what light needs."""

    uvs: bool = False

    @staticmethod
    def by(sources: Collection[str]) -> Wanted:
        """For the core's passes that are kept."""
        return Wanted(uvs="UV" in sources)
