"""Finds the compiled core, `komorebi_core`, or says in one sentence why there is none."""

from __future__ import annotations

import importlib
import sys
from typing import Any

import bpy

from .errors import RenderError

PACKAGE = "komorebi_core"


def load() -> Any:
    """The package `komorebi_core`; RenderError when it is missing or does not fit this Python."""
    try:
        return importlib.import_module(PACKAGE)
    except ModuleNotFoundError as error:
        if error.name is not None and not error.name.startswith(PACKAGE):
            raise
        reason = "was not found"
    except ImportError as error:
        reason = f"cannot be loaded ({error})"
    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    raise RenderError(
        f"The native module {PACKAGE} {reason} for Python {python} of Blender "
        f"{bpy.app.version_string}: build it for this Blender with ./run install, "
        "or install the Komorebi package made for it"
    )
