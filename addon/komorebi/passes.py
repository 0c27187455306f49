"""The table of passes: what is told to Blender, asked of the core, and written back.

A pass that is not switched on costs nothing anywhere.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from . import compat

ZERO = "zero"  # the source of what is null on matt surfaces: Blender's zeros stay


@dataclass(frozen=True, slots=True)
class Pass:
    """One pass by the name that this release of Blender has for it."""

    name: str
    channel_ids: str
    kind: str  # Blender's socket type: COLOR, VECTOR, VALUE
    source: str  # the core's name, or ZERO; "": there is nothing yet to fill it with

    @property
    def channels(self) -> int:
        return len(self.channel_ids)

    @property
    def is_read(self) -> bool:
        """Whether the core fills it."""
        return self.source not in ("", ZERO)


@dataclass(frozen=True, slots=True)
class Switch:
    """A pass of the table and the property that switches it on."""

    owner: str  # LAYER: view_layer; CYCLES: view_layer.cycles, or ours without it; OURS
    prop: str
    group: str  # of the panel: DATA, LIGHT, CRYPTOMATTE, OTHER
    label: str
    names: tuple[str, ...]  # up to 4.5, and from 5.0 if that is another
    channel_ids: str
    kind: str
    source: str = ""
    since: tuple[int, int, int] = (0, 0, 0)  # the release that has it first

    @property
    def name(self) -> str:
        return self.names[-1] if compat.LONG_PASS_NAMES else self.names[0]

    @property
    def exists(self) -> bool:
        """Whether this release of Blender has it."""
        return self.since <= compat.VERSION

    def is_on(self, view_layer: Any) -> bool:
        return self.exists and bool(getattr(self.place(view_layer), self.prop, False))

    def place(self, view_layer: Any) -> Any:
        """What holds the property."""
        if self.owner == "LAYER":
            return view_layer
        if self.owner == "CYCLES":
            return compat.cycles_or(view_layer, view_layer.komorebi)
        return view_layer.komorebi


@dataclass(frozen=True, slots=True)
class ValueColumn:
    """A shader AOV and where its channels stand among each material's values."""

    aov: str
    first: int
    channels: int  # 1; or 4 for a colour, and where there is one

    @property
    def source(self) -> str:
        return f"Material Value {self.first} {self.channels}"


_L, _C, _O = "LAYER", "CYCLES", "OURS"
_COLOR, _VECTOR, _VALUE = "COLOR", "VECTOR", "VALUE"

# In Cycles' order, ours last. Lines are rows of a table: they may be long.
# fmt: off
SWITCHES = (
    Switch(_L, "use_pass_z", "DATA", "Depth", ("Depth",), "Z", _VALUE, "Depth"),
    Switch(_L, "use_pass_mist", "DATA", "Mist", ("Mist",), "Z", _VALUE, "Mist"),
    Switch(_L, "use_pass_position", "DATA", "Position", ("Position",), "XYZ", _VECTOR, "Position"),
    Switch(_L, "use_pass_normal", "DATA", "Normal", ("Normal",), "XYZ", _VECTOR, "Normal"),
    Switch(_L, "use_pass_vector", "DATA", "Vector", ("Vector",), "XYZW", _VECTOR, "Vector"),
    Switch(_L, "use_pass_uv", "DATA", "UV", ("UV",), "UVA", _VECTOR, "UV"),
    Switch(_L, "use_pass_object_index", "DATA", "Object Index", ("IndexOB", "Object Index"), "X", _VALUE, "Object Index"),
    Switch(_L, "use_pass_material_index", "DATA", "Material Index", ("IndexMA", "Material Index"), "X", _VALUE, "Material Index"),
    Switch(_O, "use_pass_instance_index", "DATA", "Instance Index", ("Instance Index",), "X", _VALUE, "Instance Index"),
    Switch(_C, "denoising_store_passes", "DATA", "Denoising Data", ("Denoising Normal",), "XYZ", _VECTOR, "Denoising Normal"),
    Switch(_C, "denoising_store_passes", "", "", ("Denoising Albedo",), "RGB", _COLOR, "Diffuse Color"),
    Switch(_C, "denoising_store_passes", "", "", ("Denoising Specular Albedo",), "RGB", _COLOR, ZERO, (5, 2, 0)),
    Switch(_C, "denoising_store_passes", "", "", ("Denoising Roughness",), "X", _VALUE, "Denoising Roughness", (5, 2, 0)),
    Switch(_C, "denoising_store_passes", "", "", ("Denoising Depth",), "Z", _VALUE, "Denoising Depth"),
    Switch(_O, "pass_debug_sample_count", "DATA", "Sample Count", ("Debug Sample Count",), "X", _VALUE, "Debug Sample Count"),
    Switch(_C, "pass_render_time", "", "", ("Render Time",), "X", _VALUE),
    Switch(_O, "use_pass_variance", "DATA", "Variance", ("Variance",), "RGB", _COLOR, "Variance"),

    Switch(_L, "use_pass_diffuse_direct", "", "", ("DiffDir", "Diffuse Direct"), "RGB", _COLOR),
    Switch(_L, "use_pass_diffuse_indirect", "", "", ("DiffInd", "Diffuse Indirect"), "RGB", _COLOR),
    Switch(_L, "use_pass_diffuse_color", "LIGHT", "Diffuse Color", ("DiffCol", "Diffuse Color"), "RGB", _COLOR, "Diffuse Color"),
    Switch(_L, "use_pass_glossy_direct", "", "", ("GlossDir", "Glossy Direct"), "RGB", _COLOR),
    Switch(_L, "use_pass_glossy_indirect", "", "", ("GlossInd", "Glossy Indirect"), "RGB", _COLOR),
    Switch(_L, "use_pass_glossy_color", "", "", ("GlossCol", "Glossy Color"), "RGB", _COLOR),
    Switch(_L, "use_pass_transmission_direct", "", "", ("TransDir", "Transmission Direct"), "RGB", _COLOR),
    Switch(_L, "use_pass_transmission_indirect", "", "", ("TransInd", "Transmission Indirect"), "RGB", _COLOR),
    Switch(_L, "use_pass_transmission_color", "", "", ("TransCol", "Transmission Color"), "RGB", _COLOR),
    Switch(_C, "use_pass_volume_direct", "", "", ("VolumeDir", "Volume Direct"), "RGB", _COLOR),
    Switch(_C, "use_pass_volume_indirect", "", "", ("VolumeInd", "Volume Indirect"), "RGB", _COLOR),
    Switch(_C, "use_pass_volume_scatter", "", "", ("Volume Scatter",), "RGB", _COLOR),
    Switch(_C, "use_pass_volume_transmit", "", "", ("Volume Transmit",), "RGB", _COLOR),
    Switch(_C, "use_pass_volume_majorant", "", "", ("Volume Majorant",), "Z", _VALUE),
    Switch(_L, "use_pass_emit", "LIGHT", "Emission", ("Emit", "Emission"), "RGB", _COLOR, "Emission"),
    Switch(_L, "use_pass_environment", "LIGHT", "Environment", ("Env", "Environment"), "RGB", _COLOR, "Environment"),
    Switch(_L, "use_pass_shadow", "", "", ("Shadow",), "RGB", _COLOR),
    Switch(_L, "use_pass_ambient_occlusion", "LIGHT", "Ambient Occlusion", ("AO", "Ambient Occlusion"), "RGB", _COLOR, "Ambient Occlusion"),
    Switch(_C, "use_pass_shadow_catcher", "LIGHT", "Shadow Catcher", ("Shadow Catcher",), "RGB", _COLOR, "Shadow Catcher"),
    Switch(_O, "use_pass_sky_visibility", "LIGHT", "Sky Visibility", ("Sky Visibility",), "X", _VALUE, "Sky Visibility"),
    Switch(_O, "use_pass_bent_normal", "LIGHT", "Bent Normal", ("Bent Normal",), "XYZ", _VECTOR, "Bent Normal"),
)
# fmt: on

# Property, label and name of each kind of Cryptomatte; ranks come two to a pass.
CRYPTOMATTES = (
    ("use_pass_cryptomatte_object", "Object", "CryptoObject"),
    ("use_pass_cryptomatte_material", "Material", "CryptoMaterial"),
    ("use_pass_cryptomatte_asset", "Asset", "CryptoAsset"),
)
MAX_CRYPTOMATTE_LEVELS = 16

COMBINED = Pass("Combined", "RGBA", _COLOR, "Combined")
# Combined as it was before denoising; the name is Cycles'.
NOISY_IMAGE = Pass("Noisy Image", "RGBA", _COLOR, "Combined")


def enabled_passes(scene: Any, view_layer: Any) -> list[Pass]:
    """The passes that `view_layer` of `scene` asks for, Combined first."""
    return list(_enabled(scene, view_layer))


def _enabled(scene: Any, view_layer: Any) -> Iterator[Pass]:
    yield COMBINED
    for switch in SWITCHES:
        if switch.is_on(view_layer):
            yield Pass(switch.name, switch.channel_ids, switch.kind, switch.source)
    levels = min(MAX_CRYPTOMATTE_LEVELS, view_layer.pass_cryptomatte_depth)
    for name in enabled_cryptomattes(view_layer):
        for part in range((levels + 1) // 2):
            # Lower case tells OpenEXR's lossy compression to leave such channels alone.
            yield Pass(f"{name}{part:02d}", "rgba", _COLOR, f"{name}{part:02d}")
    if scene.komorebi.use_denoising:
        yield NOISY_IMAGE
    for column in value_columns(view_layer):
        ids, kind = ("X", _VALUE) if column.channels == 1 else ("RGBA", _COLOR)
        yield Pass(column.aov, ids, kind, column.source)


def value_columns(view_layer: Any) -> list[ValueColumn]:
    """The table of numbers that each material has for the view layer's shader AOVs."""
    columns: list[ValueColumn] = []
    first = 0
    for aov in view_layer.aovs:
        if aov.is_valid:
            columns.append(ValueColumn(aov.name, first, 1 if aov.type == "VALUE" else 4))
            first += columns[-1].channels
    return columns


def enabled_cryptomattes(view_layer: Any) -> list[str]:
    return [name for prop, _, name in CRYPTOMATTES if getattr(view_layer, prop)]


def register_passes(engine: Any, scene: Any, view_layer: Any) -> None:
    for p in enabled_passes(scene, view_layer):
        engine.register_pass(scene, view_layer, p.name, p.channels, p.channel_ids, p.kind)


def sources(passes: Sequence[Pass], *more: str) -> tuple[str, ...]:
    """What the core has to keep for them, and `more` that is not told to Blender."""
    return tuple(dict.fromkeys([p.source for p in passes if p.is_read] + [s for s in more if s]))
