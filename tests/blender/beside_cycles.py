"""One scene rendered by Komorebi and by Cycles, and their passes beside each other."""

import bpy
import numpy as np
import support


def render_both(scene, folder, name="both", filter_width=1.5):
    """Channels of Komorebi's and of Cycles' render, without the layer's name, and our metadata."""
    layer = bpy.context.view_layer
    scene.komorebi.method, scene.komorebi.bounces = "WORLD_LIGHT", 0
    scene.komorebi.samples, scene.cycles.samples = 64, 64
    scene.komorebi.filter_width = scene.cycles.filter_width = filter_width
    scene.cycles.max_bounces = 0
    for unwanted in ("use_adaptive_sampling", "use_denoising"):
        setattr(scene.cycles, unwanted, False)
    result = []
    for engine in ("KOMOREBI", "CYCLES"):
        scene.render.engine = engine
        channels, metadata = support.render_layers(folder, f"{name}-{engine}")
        short = {k.removeprefix(f"{layer.name}."): v for k, v in channels.items()}
        result.append((short, metadata))
    (ours, our_metadata), (theirs, their_metadata) = result
    return ours, theirs, our_metadata, their_metadata


def stacked(channels, name, ids):
    return np.stack([channels[f"{name}.{c}"] for c in ids], axis=-1)


def short_or_long(short, long):
    return long if bpy.app.version >= (5, 0, 0) else short


def inside(channels):
    """Pixels of which all samples saw one object: there no sample's place in the pixel matters."""
    coverage = channels["CryptoObject00.g"]
    return coverage > 0.999


def close(ours, theirs, name, ids, tolerance, where, share=0.99):
    """Asserts that a pass is the same in a share of the pixels `where`."""
    a, b = stacked(ours, name, ids), stacked(theirs, name, ids)
    near = (np.abs(a - b) <= tolerance * (1.0 + np.abs(b))).all(axis=-1)
    assert near[where].mean() >= share, (
        f"{name}: {near[where].mean():.4f} are close, e.g. {a[where][~near[where]][:3]} "
        f"and {b[where][~near[where]][:3]}"
    )
