"""Blender's colour spaces of images, as the core's Texture takes them. No bpy."""

from __future__ import annotations

import numpy as np

from ..scene_data import DoubleArray

# Linear Rec. 709 from a linear space, row by row, as Blender's OpenColorIO configurations have it.
_MATRICES = {
    "P3": (1.2247329, -0.2249075, 0.0, -0.0420578, 1.0421024, 0.0,
           -0.0196422, -0.0786564, 1.098371),
    "2020": (1.6602063, -0.5875538, -0.0728271, -0.1245527, 1.1329457, -0.0083484,
             -0.018155, -0.1006047, 1.118832),
    "E_GAMUT": (1.9069349, -0.6928527, -0.2142466, -0.1625019, 1.3766892, -0.2141627,
                -0.1276237, -0.235295, 1.363159),
    "AP0": (2.5212718, -1.1339446, -0.3874915, -0.2764867, 1.3727529, -0.0962415,
            -0.0153818, -0.1530121, 1.1686341),
    "AP1": (1.7047708, -0.6216899, -0.0832452, -0.1302596, 1.1408328, -0.0105486,
            -0.0240091, -0.129, 1.1532494),
    "XYZ": (3.2404374, -1.5371305, -0.4985288, -0.9692675, 1.8760137, 0.0415561,
            0.0556434, -0.204026, 1.0572255),
    "XYZ_E": (3.1462347, -1.6661153, -0.4801246, -0.9955365, 1.9557664, 0.0397716,
              0.0635979, -0.2145966, 1.150999),
}  # fmt: skip

# By Blender's names, old and new: whether the sRGB curve is decoded, and the primaries.
_SPACES: dict[str, tuple[bool, str]] = {
    "Linear": (False, ""),
    "Linear Rec.709": (False, ""),
    "sRGB": (True, ""),
    "Display P3": (True, "P3"),
    "Linear DCI-P3 D65": (False, "P3"),
    "Linear Rec.2020": (False, "2020"),
    "Linear FilmLight E-Gamut": (False, "E_GAMUT"),
    "Linear ACES": (False, "AP0"),
    "ACES2065-1": (False, "AP0"),
    "Linear ACEScg": (False, "AP1"),
    "ACEScg": (False, "AP1"),
    "XYZ": (False, "XYZ"),
    "Linear CIE-XYZ D65": (False, "XYZ"),
    "Linear CIE-XYZ E": (False, "XYZ_E"),
}


def known_space(name: str) -> tuple[str, DoubleArray | None] | None:
    """LINEAR or SRGB, and the matrix [3, 3] to Rec. 709's primaries (None: it has them); None for a
    space that is not known."""
    if name not in _SPACES:
        return None
    srgb, primaries = _SPACES[name]
    matrix = np.array(_MATRICES[primaries]).reshape(3, 3) if primaries else None
    return "SRGB" if srgb else "LINEAR", matrix
