"""Finds a library of Open Image Denoise 2, or says why there is none.

In this order: the one that the environment variable KOMOREBI_OIDN or the add-on's preferences name
(nothing else is tried then), Blender's own in official builds, that of the package `pyoidn` in
Blender's Python, the system's.
"""

from __future__ import annotations

import glob
import importlib.util
import os
import sys
from dataclasses import dataclass
from typing import Any

import bpy

VARIABLE = "KOMOREBI_OIDN"
_SYSTEM_FOLDERS = ("/usr/local/lib", "/usr/lib/*-linux-gnu", "/usr/lib64", "/usr/lib")
# Of the names for one file the shortest with the version that we call.
_PATTERNS = {
    "win32": ("OpenImageDenoise.dll",),
    "darwin": ("libOpenImageDenoise.2*.dylib",),
}.get(sys.platform, ("libOpenImageDenoise.so.2", "libOpenImageDenoise.so.2.*"))


@dataclass(frozen=True)
class Library:
    """Where it is, or `missing`: one sentence for the user."""

    path: str = ""
    missing: str = ""


def find() -> Library:
    """The library to use now; quick, so that a panel may ask each time it is drawn."""
    return _find(os.environ.get(VARIABLE, "") or _preferred())


def _preferred() -> str:
    package = __package__.rpartition(".")[0]
    addon: Any = bpy.context.preferences.addons.get(package)
    path = getattr(getattr(addon, "preferences", None), "oidn_path", "")
    return str(bpy.path.abspath(path)) if path else ""


def _find(named: str) -> Library:
    if named:
        path = named if os.path.isfile(named) else _in(named)
        return Library(path, "" if path else f"There is no OpenImageDenoise at {named}")
    for folder in (*_blenders_folders(), *_package_folders(), *_SYSTEM_FOLDERS):
        path = _in(folder)
        if path:
            return Library(path)
    return Library(
        missing="No OpenImageDenoise library was found: install the package pyoidn for Blender's "
        f"Python, or name a library in the add-on's preferences or in {VARIABLE}"
    )


def _in(folder: str) -> str:
    for pattern in _PATTERNS:
        for path in sorted(glob.glob(os.path.join(folder, pattern))):
            return path
    return ""


def _blenders_folders() -> list[str]:
    """Where official builds have their own copy; also Blender as a Python module."""
    homes = [os.path.dirname(bpy.app.binary_path or "")]
    homes.append(os.path.dirname(bpy.utils.resource_path("LOCAL")))
    names = ("lib", "blender.shared", "../Resources/lib")
    return [os.path.join(home, name) for home in homes if home for name in names]


def _package_folders() -> list[str]:
    spec = importlib.util.find_spec("pyoidn")
    homes = (spec.submodule_search_locations or []) if spec else []
    return [os.path.join(home, "oidn", name) for home in homes for name in ("lib", "bin")]
