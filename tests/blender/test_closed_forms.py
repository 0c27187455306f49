"""Scenes of blend_scenes/ whose ambient occlusion is known: Komorebi's pictures against the formulas.

A pixel's expected value comes from the camera and plane geometry alone, in doubles; the sampling
error is bounded by the scatter between pictures of independent seeds.
"""

import math
from pathlib import Path

import bpy
import numpy as np
import support

SCENES = Path(__file__).resolve().parents[2] / "blend_scenes"
SEEDS = 6


def pictures(folder, name, samples=32, **properties):
    """Pictures at independent seeds, red channel, float64 [seed, row, column]."""
    bpy.ops.wm.open_mainfile(filepath=str(SCENES / f"{name}.blend"), load_ui=False)
    scene = bpy.context.scene
    scene.render.engine = "KOMOREBI"
    settings = scene.komorebi
    settings.method, settings.pixel_filter = "AMBIENT_OCCLUSION", "BOX"
    settings.samples, settings.ao_distance, settings.bounces = samples, 0.0, 0
    settings.surface = "CLAY"
    for key, value in properties.items():
        setattr(settings, key, value)
    made = []
    for seed in range(SEEDS):
        settings.seed = seed
        made.append(support.render(folder, f"{name}-{seed}")[..., 0].astype(np.float64))
    return np.stack(made)


def agree(made, expected, where, exactly):
    """The pictures' mean over `where` is the expected one, and so is that of every 8 × 8 block inside.

    `exactly` is what tessellation, finite planes and floats explain; beyond it six standard errors
    of the whole, for a block seven of a usual one or ten of its own (edges are noisier).
    """
    each = (made - expected)[:, where].mean(axis=1)
    error = each.std(ddof=1) / math.sqrt(SEEDS)
    assert abs(each.mean()) < exactly + 6.0 * error, (each, exactly)
    height, width = (n // 8 * 8 for n in where.shape)
    cut = (slice(0, height), slice(0, width))
    inside = blocks(where[cut]) == 1.0
    off = np.stack([blocks((picture - expected)[cut])[inside] for picture in made])
    own = off.std(axis=0, ddof=1) / math.sqrt(SEEDS)
    limit = exactly + np.maximum(7.0 * np.sqrt((own**2).mean()), 10.0 * own)
    excess = np.abs(off.mean(axis=0)) - limit
    assert excess.max() < 0.0, (off[:, excess.argmax()], limit[excess.argmax()])


def blocks(picture):
    """Means of 8 × 8 pixels."""
    height, width = picture.shape
    return picture.reshape(height // 8, 8, width // 8, 8).mean(axis=(1, 3))


def ground_points(shape, scale, centre):
    """x and y, in metres, of 4 × 4 points in each pixel of an orthographic camera that looks down;
    `scale` metres across the longer side. Two arrays [row, column, 16]."""
    height, width = shape
    metres = scale / max(height, width)
    steps = (np.arange(4) + 0.5) / 4
    x = centre[0] + (np.arange(width)[:, None] + steps - width / 2) * metres
    y = centre[1] + (np.arange(height)[:, None] + steps - height / 2) * metres
    shape = (height, width, 4, 4)
    flat = (height, width, 16)
    wide = np.broadcast_to(x[None, :, None, :], shape).reshape(flat)
    return wide, np.broadcast_to(y[:, None, :, None], shape).reshape(flat)


def beside_a_sphere(made):
    """A plane beside a tangent unit sphere: 1 − 1/d³, d the distance to the sphere's centre."""
    x, y = ground_points(made.shape[1:], 6.0, (3.0, 0.0))
    squared = x * x + y * y
    expected = (1.0 - (squared + 1.0) ** -1.5).mean(axis=-1)
    agree(made, expected, squared.min(axis=-1) > 1.02, 1e-4)


def test_plane_beside_a_sphere(folder):
    beside_a_sphere(pictures(folder, "plane_sphere"))


def test_plane_beside_a_sphere_with_uniform_sampling(folder):
    beside_a_sphere(pictures(folder, "plane_sphere", ao_sampling="UNIFORM"))


def test_plane_beside_a_sphere_as_world_light(folder):
    """Clay of albedo 1 under a white world is ambient occlusion, whatever the strategy."""
    for strategy in ("PRODUCT", "MIS", "COSINE", "ENVIRONMENT"):
        beside_a_sphere(
            pictures(
                folder,
                "plane_sphere",
                method="WORLD_LIGHT",
                clay_color=(1.0, 1.0, 1.0),
                environment_sampling=strategy,
            )
        )


def test_inside_corner_of_two_planes(folder):
    """Each takes half of the other's sky, at any distance; the planes end at 3e4 m."""
    made = pictures(folder, "corner_two")
    agree(made, 0.5, np.ones(made.shape[1:], bool), 2e-4)


def test_inside_corner_of_three_planes(folder):
    """A quarter of the sky is left, at any distance; the planes end at 3e4 m."""
    made = pictures(folder, "corner_three")
    agree(made, 0.25, np.ones(made.shape[1:], bool), 2e-4)


def test_floor_under_a_disk(folder):
    """The view factor from an element to a parallel disk (Howell, A Catalog of Radiation Heat
    Transfer Configuration Factors, B-13); above the centre it is r² / (r² + h²)."""
    made = pictures(folder, "point_under_disk")
    scene = bpy.context.scene
    x, y = ground_points(made.shape[1:], 4.0, (0.0, 0.0))
    radius2, height2, off2 = scene["radius"] ** 2, scene["height"] ** 2, x * x + y * y
    z = height2 + off2 + radius2
    factor = 0.5 * (1.0 - (z - 2.0 * radius2) / np.sqrt(z * z - 4.0 * radius2 * off2))
    assert abs(factor.max() - radius2 / (radius2 + height2)) < 1e-3
    agree(made, (1.0 - factor).mean(axis=-1), np.ones(made.shape[1:], bool), 1e-4)


def test_a_convex_body_sees_all_the_sky(folder):
    for sampling in ("COSINE", "UNIFORM"):
        made = pictures(folder, "convex", samples=16, ao_sampling=sampling)
        exactly = 1e-6 if sampling == "COSINE" else 2e-3
        agree(made, 1.0, np.ones(made.shape[1:], bool), exactly)


def test_furnace_hides_a_white_body(folder):
    """Albedo 1 in a sky of radiance 2.5: with cosine sampling even without noise."""
    white = {"method": "WORLD_LIGHT", "clay_color": (1.0, 1.0, 1.0)}
    made = pictures(folder, "furnace", samples=16, environment_sampling="COSINE", **white)
    assert np.abs(made - 2.5).max() < 1e-5
    for strategy in ("PRODUCT", "MIS", "ENVIRONMENT"):
        made = pictures(folder, "furnace", environment_sampling=strategy, **white)
        agree(made, 2.5, np.ones(made.shape[1:], bool), 1e-4)


def test_bounces_in_a_cavity_are_a_geometric_series(folder):
    """Each sends back ρ of what it gets, of which s leaves by the opening: ρ s Σ (ρ (1 − s))^i."""
    for bounces in (0, 1, 2, 4, 8):
        made = pictures(folder, "cavity", samples=16, method="WORLD_LIGHT", bounces=bounces)
        albedo, open_share = 0.8, bpy.context.scene["open_share"]
        series = sum((albedo * (1.0 - open_share)) ** i for i in range(bounces + 1))
        agree(made, albedo * open_share * series, np.ones(made.shape[1:], bool), 2e-4)


def test_no_light_enters_a_closed_room(folder):
    """Up to the points that a float cannot put on the right side of an edge: 3 in ten million."""
    made = pictures(folder, "room")
    assert made.mean() < 1e-6
