"""core.Texture from arrays and files, and what it says to bad ones."""

import subprocess
import sys
import zlib
from pathlib import Path

import komorebi_core as core
import numpy as np
import pytest


def png(path, pixels):
    """An 8-bit RGBA file, written by hand; pixels [h, w, 4] uint8, row 0 at the bottom."""
    height, width = pixels.shape[:2]

    def chunk(kind, data):
        return (len(data).to_bytes(4, "big") + kind + data
                + zlib.crc32(kind + data).to_bytes(4, "big"))  # fmt: skip

    header = width.to_bytes(4, "big") + height.to_bytes(4, "big") + bytes([8, 6, 0, 0, 0])
    rows = b"".join(b"\0" + row.tobytes() for row in pixels[::-1])
    data = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + data)
    return Path(path).read_bytes()


def centres(width, height):
    v, u = np.meshgrid(
        (np.arange(height) + 0.5) / height, (np.arange(width) + 0.5) / width, indexing="ij"
    )
    return np.stack([u.ravel(), v.ravel()], axis=1).astype(np.float32)


def test_file_bytes_and_pixels_are_the_same_picture(tmp_path):
    pixels = np.random.default_rng(1).integers(0, 256, (5, 7, 4), np.uint8)
    data = png(tmp_path / "a.png", pixels)
    uv = np.random.default_rng(2).uniform(-2, 2, (500, 2)).astype(np.float32)
    matrix = np.array([[0.9, 0.1, 0], [0, 1, 0], [0.1, 0.2, 0.7]])
    for space in ("LINEAR", "SRGB", "NON_COLOR"):
        for alpha in ("STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"):
            for how in ({}, {"matrix": matrix}, {"skip": 1}):
                more = {"color_space": space, "alpha_mode": alpha, **how}
                one = core.Texture.from_file(str(tmp_path / "a.png"), **more)
                two = core.Texture.from_bytes("a.png", data, **more)
                three = core.Texture.from_pixels("a", pixels, **more)
                expected = one.lookup(uv, straight=True)
                assert np.array_equal(expected, two.lookup(uv, straight=True))
                assert np.abs(expected - three.lookup(uv, straight=True)).max() < 2e-3
    assert core.Texture.file_bytes(str(tmp_path / "a.png")) == 4 * (7 * 5 + 3 * 2 + 1)
    assert core.Texture.packed_bytes("a.png", data) == 4 * (7 * 5 + 3 * 2 + 1)


def test_values_of_texels():
    pixels = np.random.default_rng(3).random((3, 4, 4)).astype(np.float32)
    texture = core.Texture.from_pixels("f", pixels)
    values = texture.lookup(centres(4, 3), interpolation="Closest")
    assert np.array_equal(values.reshape(3, 4, 4), pixels)
    opaque = core.Texture.from_pixels("f", pixels, alpha_mode="NONE")
    assert (opaque.lookup(centres(4, 3))[:, 3] == 1).all()
    grey = core.Texture.from_pixels("g", pixels[:, :, :1].copy())
    assert np.array_equal(
        grey.lookup(centres(4, 3), interpolation="Closest")[:, 1].reshape(3, 4), pixels[:, :, 0]
    )
    tiles = core.Texture.from_tiles("t", {1002: texture, 1001: grey})
    shifted = centres(4, 3) + np.float32([1, 0])
    assert np.allclose(tiles.lookup(shifted, interpolation="Closest"), pixels.reshape(-1, 4))
    assert np.array_equal(core.Texture.missing("m").lookup(shifted[:1]), [[1, 0, 1, 1]])


def test_a_raised_flag_ends_every_way_to_read(tmp_path):
    pixels = np.full((40, 30, 4), 200, np.uint8)
    file = str(tmp_path / "a.png")
    data = png(file, pixels)
    light = np.ones((40, 80, 3), np.float32)
    raised = core.Cancel()
    raised.request()
    ways = (
        lambda flag: core.Texture.from_file(file, cancel=flag),
        lambda flag: core.Texture.from_bytes("a.png", data, cancel=flag),
        lambda flag: core.Texture.from_pixels("a", pixels, cancel=flag),
        lambda flag: core.Environment.from_file(file, cancel=flag),
        lambda flag: core.Environment.from_pixels("a", light, cancel=flag),
    )
    for way in ways:
        with pytest.raises(core.Cancelled):
            way(raised)
        assert way(core.Cancel()).width == way(None).width


def test_bad_input_is_a_sentence(tmp_path):
    whole = png(tmp_path / "a.png", np.zeros((50, 50, 4), np.uint8))
    (tmp_path / "cut.png").write_bytes(whole[:60])
    (tmp_path / "text.png").write_text("no picture")
    for name in ("cut.png", "text.png", "none.png"):
        with pytest.raises(RuntimeError, match=name):
            core.Texture.from_file(str(tmp_path / name))
        with pytest.raises(RuntimeError, match="packed"):
            core.Texture.from_bytes("packed.png", b"no picture")
    huge = bytearray(whole)
    huge[16:24] = (100_000).to_bytes(4, "big") * 2
    huge[29:33] = zlib.crc32(bytes(huge[12:29])).to_bytes(4, "big")
    (tmp_path / "huge.png").write_bytes(huge)
    with pytest.raises(RuntimeError, match="huge.png"):
        core.Texture.from_file(str(tmp_path / "huge.png"))
    with pytest.raises(RuntimeError, match="huge.png"):
        core.Texture.file_bytes(str(tmp_path / "huge.png"))
    good = np.zeros((2, 2, 4), np.float32)
    for bad in (np.zeros((0, 0, 4), np.float32), good[:, :, :3].copy(), good[0], good[:, ::2],
                good.astype(np.float64)):  # fmt: skip
        with pytest.raises(ValueError, match="bad"):
            core.Texture.from_pixels("bad", bad)
    for more in ({"color_space": "X"}, {"alpha_mode": "X"}, {"matrix": np.eye(4)}):
        with pytest.raises(ValueError, match=next(iter(more))):
            core.Texture.from_pixels("p", good, **more)
    texture = core.Texture.from_pixels("p", good)
    for more in ({"interpolation": "X"}, {"extension": "X"}):
        with pytest.raises(ValueError, match=next(iter(more))):
            texture.lookup(centres(2, 2), **more)
    with pytest.raises(ValueError, match="no tiles"):
        core.Texture.from_tiles("t", {})
    good[0, 0, 0] = np.inf
    assert core.Texture.from_pixels("p", good).nonfinite_texels == 1


def test_reading_files_alone_loads_openimageio():
    program = (
        "import numpy, komorebi_core as core\n"
        "core.Texture.from_pixels('p', numpy.zeros((1, 1, 4), numpy.float32))\n"
        "assert 'OpenImageIO' not in open('/proc/self/maps').read()\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)
