"""A material's nodes → what the core needs to know of its surface, for each kind of ray."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from .. import compat, reporting
from ..scene_data import Lobe, ProgramData, SurfaceData, SurfacePrograms, Value
from ..scene_settings import settings_of
from . import nodes
from .names import name_of
from .shader import Compiler, Ray
from .shader.closures import BLACK, Closures, total
from .shader.compiler import NOWHERE
from .shader.nodes_displacement import relief
from .shader.values import Builder
from .surroundings import Surroundings

MOST_LOBES = 4  # of a surface; each has a normal of its own
WHITE: Value = (1.0, 1.0, 1.0)
WHITE_CLAY = (1.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True)
class Look:
    """How a render shows surfaces: the scene's settings, as far as materials heed them."""

    clay: tuple[float, float, float] | None  # the one colour of all; None: materials have theirs
    keeps_bump: bool = True
    skips_glass: bool = True
    has_light: bool = True  # False for ambient occlusion, which knows no colour and no lamps
    later: Look | None = None  # how surfaces look to bounces; None: the same
    averages: bool = False  # whether rays bounce, to which pictures are averaged within their cone


def look_of(scene: Any) -> Look:
    """What the settings of a scene say."""
    settings = settings_of(scene)
    look = Look(None)
    if settings.surface == "CLAY":
        look = Look(tuple(settings.clay_color), settings.clay_bump, settings.clay_glass == "SKIP")
    if settings.method == "WORLD_LIGHT":
        return replace(look, averages=settings.bounces > 0)
    # What is seen is white; what its light comes from is not.
    later = replace(look, averages=True) if settings.ao_indirect_bounces > 0 else None
    return replace(look, clay=look.clay and WHITE_CLAY, has_light=False, later=later)


def export_surface(
    engine: Any, material: Any | None, look: Look, around: Surroundings = NOWHERE
) -> SurfaceData:
    """The programs of a material, and what of it is rendered as something else."""
    if material is None:
        return _plain((0.8, 0.8, 0.8), look)
    if material.komorebi.exclude_from_clay:
        look = _without_clay(look)
    tree = compat.shader_nodes(material)
    if tree is None:
        color = material.diffuse_color
        return _plain((color[0], color[1], color[2]), look)
    output = nodes.material_output(tree)
    if output is None:
        return _plain((0.0, 0.0, 0.0), look)
    owner = f'material "{name_of(material)}"'

    def compiler(kind: str) -> Compiler:
        return Compiler(engine, owner, Ray(kind), surroundings=around)

    compilers = {kind: compiler(kind) for kind in ("CAMERA", "DIFFUSE", "SHADOW")}
    camera = _surface(compilers["CAMERA"], output, look)
    ops, clear = camera.program.ops, camera.program.outputs[3:6]
    heeds_ray = compilers["CAMERA"].heeds_ray
    bounce, later = None, look.later or look
    if later.averages and compilers["CAMERA"].has_pictures:
        compilers["DIFFUSE"].averages = True
        bounce = _surface(compilers["DIFFUSE"], output, later)
        if any(isinstance(c, tuple) for c in bounce.program.outputs[3:6]):
            # Whether a ray is let through is decided by pictures as they are, and what is left is
            # divided by how often that is not so.
            bounce, compilers["DIFFUSE"] = None, compiler("DIFFUSE")
    if bounce is None and (heeds_ray or look.later is not None):
        bounce = _surface(compilers["DIFFUSE"], output, later)
    if bounce is not None and bounce.program.key() == camera.program.key():
        bounce = None
    if heeds_ray:
        shadow = compilers["SHADOW"]
        clear = _transparency(shadow, _closures(shadow, output), look)
        ops = shadow.builder.ops
    if camera.program.outputs[:3] != BLACK:
        reporting.warn(
            engine, f"{owner} shines, but its light on other surfaces is not rendered yet"
        )
    if _displaces(material) and nodes.source(output.inputs["Displacement"]) is not None:
        reporting.warn(engine, f"{owner}: displacement is rendered as relief, nothing moves")
    return SurfaceData(
        camera,
        bounce,
        ProgramData(owner, ops, clear) if any(clear) else None,
        compilers["CAMERA"].notes if look.clay is None else set(),
    )


def _displaces(material: Any) -> bool:
    """Whether Cycles moves what a material's displacement moves: its setting up to 4.0, then
    Blender's own."""
    for owner in (material, compat.cycles_or(material, None)):
        method = getattr(owner, "displacement_method", None)
        if method is not None:
            return bool(method != "BUMP")
    return False


def _without_clay(look: Look) -> Look:
    later = None if look.later is None else _without_clay(look.later)
    return Look(None, has_light=look.has_light, later=later)


def _plain(color: Value, look: Look) -> SurfaceData:
    """A surface of one colour."""
    later = None if look.later is None else _even(color, look.later)
    return SurfaceData(_even(color, look), later)


def _even(color: Value, look: Look) -> SurfacePrograms:
    shown = color if look.clay is None else look.clay
    if not look.has_light:
        shown = WHITE
    outputs = (*BLACK, *BLACK, 0.0, *shown)
    return SurfacePrograms(ProgramData("surface", [], outputs), (Lobe(False, False),))


def _closures(compiler: Compiler, output: Any) -> Closures | None:
    """What reaches the surface; None if there is nothing but a volume, which is not solid."""
    socket = output.inputs["Surface"]
    if not compiler.is_linked(socket) and nodes.source(output.inputs["Volume"]) is not None:
        return None
    return compiler.closures(socket)


def _transparency(compiler: Compiler, closures: Closures | None, look: Look) -> Value:
    if closures is None:
        return WHITE
    b = compiler.builder
    clear = total(b, closures, "TRANSPARENT")
    return b.add(clear, total(b, closures, "GLASS")) if look.skips_glass else clear


def _surface(compiler: Compiler, output: Any, look: Look) -> SurfacePrograms:
    b = compiler.builder
    closures = _closures(compiler, output)
    clear = _transparency(compiler, closures, look)
    hole = total(b, closures or (), "HOLDOUT")[:1]
    emission = BLACK
    if look.clay is None and look.has_light:
        emission = total(b, closures or (), "EMISSION")
    lobes = _lobes(compiler, closures or (), look, relief(compiler, output.inputs["Displacement"]))
    if look.clay is not None or not look.has_light:
        solid = b.subtract((1.0,), b.add(clear, hole))
        color = look.clay if look.clay is not None else WHITE
        normal = next((n for (transmits, n) in lobes if not transmits), None)
        lobes = {(False, normal): b.multiply(solid, color)}
    outputs = (*emission, *clear, *hole)
    kinds = []
    for (transmits, normal), weight in lobes.items():
        outputs += weight if normal is None else (*weight, *normal)
        kinds.append(Lobe(transmits, normal is not None))
    return SurfacePrograms(ProgramData(compiler.owner, b.ops, outputs), tuple(kinds))


def _lobes(
    compiler: Compiler, closures: Closures, look: Look, raised: Value | None
) -> dict[tuple[bool, Value | None], Value]:
    """Weights by side and normal: what agrees in both adds up. `raised` is the normal of what has
    none of its own."""
    b: Builder = compiler.builder
    lobes: dict[tuple[bool, Value | None], Value] = {}
    for closure in closures:
        if closure.kind not in {"DIFFUSE", "TRANSLUCENT"}:
            continue
        normal = closure.normal or raised if look.keeps_bump else None
        key = (closure.kind == "TRANSLUCENT", normal)
        if key not in lobes and len(lobes) == MOST_LOBES:
            key = next((k for k in lobes if k[0] == key[0]), next(iter(lobes)))
            compiler.note(f"more than {MOST_LOBES} normals of one surface")
        lobes[key] = b.add(lobes.get(key, BLACK), closure.weight)
    return lobes
