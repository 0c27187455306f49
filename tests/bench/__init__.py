"""Measuring speed: `./run bench` (docs/performance.md)."""
