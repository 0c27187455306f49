"""Surface shaders. All that reflects does so diffusely: gloss and metal count as matt with their
base colour, glass as something clear. Which materials that concerns is noted for the statistics."""

from __future__ import annotations

from typing import Any

from .closures import Closure, Closures, scaled
from .compiler import Compiler, Outputs, node
from .values import Value

ONE: Value = (1.0,)


def _socket(node: Any, *names: str) -> Any | None:
    """The first input of these names that this release's node has."""
    return next((node.inputs[name] for name in names if name in node.inputs), None)


def _value(compiler: Compiler, node: Any, *names: str, otherwise: Value = (0.0,)) -> Value:
    socket = _socket(node, *names)
    return otherwise if socket is None else compiler.value(socket)


def _normal(compiler: Compiler, node: Any) -> Value | None:
    """The normal of a shader; None where the surface's own is meant."""
    socket = _socket(node, "Normal")
    if socket is None or not compiler.is_linked(socket):
        return None
    normal = compiler.value(socket)
    return None if normal == compiler.builder.input("normal") else normal


def _one(node: Any, closures: Closures) -> Outputs:
    return {node.outputs[0].identifier: closures}


@node("BSDF_DIFFUSE")
def diffuse(compiler: Compiler, node: Any) -> Outputs:
    if compiler.value(node.inputs["Roughness"]) != (0.0,):
        compiler.note("roughness of diffuse surfaces")
    weight = compiler.value(node.inputs["Color"])
    return _one(node, (Closure("DIFFUSE", weight, _normal(compiler, node)),))


@node("BSDF_TRANSLUCENT")
def translucent(compiler: Compiler, node: Any) -> Outputs:
    weight = compiler.value(node.inputs["Color"])
    return _one(node, (Closure("TRANSLUCENT", weight, _normal(compiler, node)),))


@node("BSDF_TRANSPARENT")
def transparent(compiler: Compiler, node: Any) -> Outputs:
    return _one(node, (Closure("TRANSPARENT", compiler.value(node.inputs["Color"])),))


@node("HOLDOUT")
def holdout(_compiler: Compiler, node: Any) -> Outputs:
    return _one(node, (Closure("HOLDOUT", (1.0, 1.0, 1.0)),))


@node("BSDF_GLASS", "BSDF_REFRACTION")
def glass(compiler: Compiler, node: Any) -> Outputs:
    compiler.note("glass")
    return _one(node, (Closure("GLASS", compiler.value(node.inputs["Color"])),))


@node(
    "BSDF_GLOSSY", "BSDF_ANISOTROPIC", "BSDF_METALLIC", "BSDF_SHEEN", "BSDF_VELVET", "BSDF_TOON",
    "BSDF_HAIR", "BSDF_HAIR_PRINCIPLED", "SUBSURFACE_SCATTERING",
)  # fmt: skip
def as_diffuse(compiler: Compiler, node: Any) -> Outputs:
    compiler.note("gloss, metal, hair and what lies beneath the surface")
    weight = _value(compiler, node, "Color", "Base Color", otherwise=(0.8, 0.8, 0.8))
    return _one(node, (Closure("DIFFUSE", weight, _normal(compiler, node)),))


@node("BSDF_PRINCIPLED")
def principled(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    base = compiler.value(node.inputs["Base Color"])
    matt = base
    if "Subsurface Color" in node.inputs:  # up to 3.x the colour below is another
        below = compiler.value(node.inputs["Subsurface Color"])
        amount = compiler.value(node.inputs["Subsurface"])
        if amount != (0.0,):
            matt = b.mix(amount, base, below)
    transmission = _value(compiler, node, "Transmission Weight", "Transmission")
    if _value(compiler, node, "Metallic") != (0.0,):
        compiler.note("gloss, metal, hair and what lies beneath the surface")
    closures: Closures = ()
    if transmission != ONE:
        weight = matt if transmission == (0.0,) else _times_rest(compiler, transmission, matt)
        closures = (Closure("DIFFUSE", weight, _normal(compiler, node)),)
    if transmission != (0.0,):
        compiler.note("glass")
        closures += (Closure("GLASS", b.multiply(transmission, base)),)
    emission = _value(compiler, node, "Emission Color", "Emission", otherwise=(0.0, 0.0, 0.0))
    shining = b.multiply(_value(compiler, node, "Emission Strength", otherwise=ONE), emission)
    if shining != (0.0, 0.0, 0.0):
        closures += (Closure("EMISSION", shining),)
    alpha = _value(compiler, node, "Alpha", otherwise=ONE)
    if alpha != ONE:
        alpha = b.clamp01(alpha)
        clear = b.subtract(ONE, alpha)
        closures = (*scaled(b, closures, alpha), Closure("TRANSPARENT", clear * 3))
    return _one(node, closures)


def _times_rest(compiler: Compiler, taken: Value, weight: Value) -> Value:
    b = compiler.builder
    return b.multiply(b.subtract(ONE, taken), weight)


@node("EEVEE_SPECULAR")
def eevee_specular(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    clear = compiler.value(node.inputs["Transparency"])
    closures: Closures = (
        Closure("DIFFUSE", compiler.value(node.inputs["Base Color"]), _normal(compiler, node)),
        Closure("EMISSION", compiler.value(node.inputs["Emissive Color"])),
    )
    if clear != (0.0,):
        closures = (
            *scaled(b, closures, b.subtract(ONE, clear)),
            Closure("TRANSPARENT", clear * 3),
        )
    return _one(node, closures)
