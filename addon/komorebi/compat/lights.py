"""What lights have, release by release."""

from __future__ import annotations

from typing import Any

from .releases import OLD_LAMPS, UNLIMITED_BOUNCES, cycles_or


def casts_shadow(light: Any) -> bool:
    """Whether what is in a light's way matters: Cycles' own setting up to 4.2."""
    settings = cycles_or(light, None)
    if settings is not None and hasattr(settings, "cast_shadow"):
        return bool(settings.cast_shadow)
    return bool(light.use_shadow)


def max_bounces(owner: Any) -> int:
    """How often light of a lamp or world may bounce: Cycles' setting, no limit without Cycles."""
    return int(getattr(cycles_or(owner, None), "max_bounces", UNLIMITED_BOUNCES))


def is_soft(light: Any) -> bool:
    """Whether a point or spot with a radius is a disk turned to what it lights, not a ball."""
    return OLD_LAMPS or bool(light.use_soft_falloff)


def normalizes(light: Any) -> bool:
    """Whether a light's power is spread over its size (a choice since 4.5)."""
    return bool(getattr(light, "normalize", True))


def light_factor(light: Any) -> float:
    """What multiplies a light's power: its exposure (4.5)."""
    return float(2.0 ** getattr(light, "exposure", 0.0))


def light_tint(light: Any) -> tuple[float, float, float]:
    """What multiplies a light's colour: its temperature (4.5)."""
    if not getattr(light, "use_temperature", False):
        return (1.0, 1.0, 1.0)
    red, green, blue = light.temperature_color
    return (float(red), float(green), float(blue))


def light_links(obj: Any) -> list[str]:
    """What of light linking (4.0) an object uses."""
    links = getattr(obj, "light_linking", None)
    found = (("receiver_collection", "light linking"), ("blocker_collection", "shadow linking"))
    return [what for name, what in found if getattr(links, name, None) is not None]
