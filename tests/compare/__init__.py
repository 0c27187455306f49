"""Renders any .blend with Cycles and with Komorebi under matched settings, and tests whether the
pictures agree."""
