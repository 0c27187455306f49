"""Names of data-blocks. Files saved elsewhere can hold names that are not UTF-8."""

from __future__ import annotations

from typing import Any


def name_of(block: Any) -> str:
    """The name of a data-block, node or layer, or what it is when its name cannot be read."""
    try:
        return str(block.name)
    except UnicodeDecodeError:
        return f"({block.rna_type.identifier.lower()} whose name is not UTF-8)"
