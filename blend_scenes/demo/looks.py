"""What things of the demo look like: stone, bark, bamboo, lacquer, and leaves of green light."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
from nodes import add, diffuse, material, mix

Color = tuple[float, float, float]


def _even(color: Color) -> Callable[[Any], Any]:
    return lambda tree: diffuse(tree, color)


def _mottled(dark: Color, light: Color, scale: float) -> Callable[[Any], Any]:
    """Between two colours by noise in the object's own space."""

    def build(tree: Any) -> Any:
        place = add(tree, "TexCoord").outputs["Object"]
        spots = add(tree, "TexNoise", {"Vector": place, "Scale": scale, "Detail": 4.0})
        colors = {0: spots.outputs["Fac"], 1: dark, 2: light}
        return diffuse(tree, add(tree, "MixRGB", colors).outputs[0])

    return build


def _leafy(color: Color, through: Color) -> Callable[[Any], Any]:
    """Each leaf a bit darker or lighter than the next, and half of its light comes through."""

    def build(tree: Any) -> Any:
        chance = add(tree, "ObjectInfo").outputs["Random"]
        darker = tuple(0.55 * c for c in color)
        shade = add(tree, "MixRGB", {0: chance, 1: darker, 2: color}).outputs[0]
        glow = add(tree, "BsdfTranslucent", {"Color": through}).outputs[0]
        return mix(tree, 0.45, diffuse(tree, shade), glow)

    return build


# By the beginning of objects' names.
LOOKS: dict[str, Callable[[Any], Any]] = {
    "Leaf": _leafy((0.16, 0.30, 0.05), (0.40, 0.55, 0.08)),
    "Blade": _leafy((0.14, 0.26, 0.07), (0.35, 0.50, 0.12)),
    "Culm": _even((0.16, 0.22, 0.08)),
    "Branches": _mottled((0.07, 0.05, 0.035), (0.17, 0.13, 0.09), 9.0),
    "Ground": _even((0.12, 0.10, 0.06)),
    "Plate": _even((0.05, 0.05, 0.05)),
    "Name": _even((0.6, 0.45, 0.15)),
}
STONE = _mottled((0.13, 0.13, 0.12), (0.34, 0.33, 0.30), 3.0)
LACQUER = _even((0.50, 0.055, 0.02))
GATE = ("Pillar", "Tie beam", "Lower lintel", "Upper lintel", "Frame")


def paint() -> None:
    """Gives every thing of the file that has a surface its material; what has no look is stone."""
    looks = {name: material(name, build) for name, build in LOOKS.items()}
    stone, lacquer = material("Stone", STONE), material("Lacquer", LACQUER)
    for thing in bpy.data.objects:
        if thing.type not in {"MESH", "CURVE", "FONT"} or thing.data.materials:
            continue
        look = next((look for name, look in looks.items() if thing.name.startswith(name)), stone)
        if thing.name.startswith(GATE):
            look = lacquer
        thing.data.materials.append(look)
