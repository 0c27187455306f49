"""What passes and materials have to know of the scene."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any


def _none(_: Any) -> frozenset[str]:
    return frozenset()


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is exported besides what light needs."""

    uvs: bool = False
    # The names of attributes (export/attributes.py) that an evaluated object's materials ask for.
    attributes_of: Callable[[Any], frozenset[str]] = _none

    @staticmethod
    def by(sources: Collection[str]) -> Wanted:
        """For the core's passes that are kept."""
        return Wanted(uvs="UV" in sources)
