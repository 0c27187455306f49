"""The two ways in which a frame ends early."""

from __future__ import annotations


class RenderError(Exception):
    """The frame cannot be rendered; the text is the one sentence that the user reads."""


class RenderCancelled(Exception):
    """Blender asked to stop (Esc, Ctrl-C); not a failure."""
