"""The bench's windows: an edit is seen, and the tables are made."""

import argparse
import shutil

import numpy as np
import pytest

from bench import aims, viewport
from bench.window import SIZE, block_size


def chequered(pixel: int) -> np.ndarray:
    """Noise of wide pixels."""
    random = np.random.default_rng(1)
    rows, columns = -(-SIZE[1] // pixel), -(-SIZE[0] // pixel)
    small = random.integers(0, 255, (rows, columns, 3), np.uint8)
    large = small.repeat(pixel, axis=0).repeat(pixel, axis=1)
    return large[: SIZE[1], : SIZE[0]]


@pytest.mark.parametrize("pixel", [1, 2, 4, 8, 16])
def test_the_width_of_pixels_is_seen(pixel):
    assert block_size(chequered(pixel)) == pixel


def test_noise_is_told_from_even_light():
    slope = np.linspace(0, 200, SIZE[0]).astype(np.uint8)
    even = np.broadcast_to(slope[None, :, None], (SIZE[1], SIZE[0], 3))
    assert viewport.noise(even) < 2.0 < viewport.noise(chequered(1))


def test_edits_are_seen_on_the_screen():
    if shutil.which("Xvfb") is None:
        pytest.skip("Xvfb is not installed")
    rows = viewport.measure(argparse.Namespace(quick=True, rounds=None))
    edits = [row for row in rows if "first" in row]
    assert {row["case"] for row in edits} == {"switch", "move_object", "move_view", "move_vertex"}
    for row in edits:
        assert row["first"][0] > 0.0, row
        if row["engine"] == "KOMOREBI":
            assert row["first"][0] <= row["full"][0] <= row["last"][0], row
    playback = [row for row in rows if row["case"] == "playback"]
    assert [row["engine"] for row in playback] == [*viewport.ENGINES, viewport.BARE]
    assert min(row["block"][0] for row in playback) > 0  # something was seen
    made = viewport.tables(rows)
    assert [len(table.rows) for table in made] == [4, 1]
    assert any(row[0].startswith("playback") for row in aims.table({"viewport": rows}).rows)
