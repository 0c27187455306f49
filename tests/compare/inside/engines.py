"""The settings of each engine under which both compute the same integral."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import bpy

from compare.inside.settle import require, settle, settle_all

CLAY = (0.8, 0.8, 0.8)
TURNS = 64  # parts of Cycles' sequence of samples


def take_samples(cycles: Any, samples: int, turn: int) -> None:
    """Render `samples` samples from a place of their own for each turn, later in the sequence than
    its start.

    Cycles puts sample 0 at the centre of the pixel whatever the seed, so that all seeds share an
    error: at 16 samples 2.4 times what their scatter tells (3.4), and no t-test would be sound. And
    in 4.5 seeds share one wherever they begin (`plane_sphere`: 0.03 % at 64 samples, 0.007 % at
    256). Pictures of different parts of the sequence share less, and if they make up for each
    other's errors, the test only gets milder on chance.
    """
    first = (1 + turn) << (samples - 1).bit_length()  # whole nets of Sobol' points begin there
    if settle(cycles, "use_sample_subset", True):  # 4.4 and later: a part of more samples
        require(cycles, samples=first + samples, sample_subset_length=samples)
    require(cycles, sample_offset=first)


def owen_scramble(cycles: Any) -> None:
    """Draw samples by Burley's Sobol' points.

    All other patterns are read from tables that no seed changes, so that seeds share an error: 0.3 %
    of a corner's light at 16 samples (4.5), of which their scatter tells nothing.
    """
    preferences = bpy.context.preferences  # without these newer releases do not list it
    preferences.view.show_developer_ui = preferences.experimental.use_cycles_debug = True
    for name in ("SOBOL_BURLEY", "SOBOL"):
        with suppress(TypeError):
            settle(cycles, "sampling_pattern", name)
            return
    raise RuntimeError("this Cycles has no sampling pattern that a seed changes")


def set_cycles(scene: Any, samples: int, bounces: int) -> None:
    """Cycles on the CPU: diffuse bounces alone, box filter, and nothing that biases or stops early."""
    if not hasattr(scene, "cycles"):
        raise RuntimeError(
            "this Blender has no Cycles (its add-on is not enabled): compare needs it"
        )
    scene.render.engine = "CYCLES"
    settle(scene.render, "use_persistent_data", True)  # its trees are the same for every seed
    require(
        scene.cycles, device="CPU", samples=samples, max_bounces=bounces, pixel_filter_type="BOX"
    )
    require(
        scene.cycles, use_adaptive_sampling=False, use_denoising=False, light_sampling_threshold=0.0
    )
    require(
        scene.cycles, sample_clamp_direct=0.0, sample_clamp_indirect=0.0, use_animated_seed=False
    )
    owen_scramble(scene.cycles)
    take_samples(scene.cycles, samples, 0)
    settle_all(
        scene.cycles,
        diffuse_bounces=bounces,
        glossy_bounces=0,
        transmission_bounces=bounces,  # what comes through translucent surfaces
        volume_bounces=0,
        transparent_max_bounces=1024,  # paths that pass through a lamp count it too
        feature_set="SUPPORTED",
        shading_system=False,
        film_exposure=1.0,
        film_transparent_glass=False,
        use_fast_gi=False,
        use_camera_cull=False,
        use_distance_cull=False,
        use_layer_samples="IGNORE",
        time_limit=0.0,
        use_preview_denoising=False,
        texture_limit_render="OFF",
    )


def set_komorebi(scene: Any, samples: int, mode: str, bounces: int, materials: bool) -> None:
    """Komorebi with every property that the comparison relies on; raises KeyError where one is
    missing."""
    if not hasattr(scene, "komorebi"):
        raise RuntimeError("the add-on komorebi is not enabled in this Blender")
    scene.render.engine = "KOMOREBI"
    method = "AMBIENT_OCCLUSION" if mode == "ao" else "WORLD_LIGHT"
    require(scene.komorebi, method=method, samples=samples, light_samples=1, sample_offset=0)
    require(
        scene.komorebi,
        use_animated_seed=False,
        ao_distance=0.0,
        ao_sampling="COSINE",
        clay_color=(1.0, 1.0, 1.0) if mode == "ao" else CLAY,
        bounces=bounces,
        ao_indirect_bounces=bounces,
        sample_clamp_direct=0.0,
        sample_clamp_indirect=0.0,
    )
    require(scene.komorebi, environment_sampling="MIS", pixel_filter="BOX", use_progressive=True)
    settle_all(
        scene.komorebi,
        film_exposure=1.0,
        sky="SCENE",
        use_fast_gi=False,
        surface="MATERIAL" if materials else "CLAY",
        use_adaptive_sampling=False,
        time_limit=0.0,
        use_denoising=False,
    )


def set_fast_gi(scene: Any, job: dict[str, Any]) -> None:
    """The approximation in either engine, as the job says; the world has what both read."""
    if job["fast_gi"] is None:
        return
    holder = scene.cycles if job["engine"] == "CYCLES" else scene.komorebi
    require(
        holder, use_fast_gi=True, fast_gi_method=job["fast_gi"].upper(),
        ao_bounces_render=job["ao_bounces"],
    )  # fmt: skip
    if job["ao_distance"] is not None:
        require(scene.world.light_settings, distance=job["ao_distance"])


def set_seed(scene: Any, engine: str, seed: int) -> None:
    """Another, independent picture of the same scene.

    Cycles scrambles points by a hash in which neighbouring seeds are alike, so they are spread.
    """
    spread = seed * 0x9E3779B1 & 0x7FFFFFFF  # 2³² over the golden ratio
    if engine == "CYCLES":
        cycles = scene.cycles
        part = getattr(cycles, "use_sample_subset", False)
        take_samples(cycles, cycles.sample_subset_length if part else cycles.samples, seed % TURNS)
    require(scene.cycles if engine == "CYCLES" else scene.komorebi, seed=spread)


def clay(mode: str, flat: bool) -> Any:
    """A white diffuse material (albedo 1 for ambient occlusion); `flat` shades with the geometric
    normal."""
    material = bpy.data.materials.new("compare clay")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    diffuse, output = (
        tree.nodes.new("ShaderNodeBsdfDiffuse"),
        tree.nodes.new("ShaderNodeOutputMaterial"),
    )
    diffuse.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0) if mode == "ao" else (*CLAY, 1.0)
    diffuse.inputs["Roughness"].default_value = 0.0
    tree.links.new(diffuse.outputs["BSDF"], output.inputs["Surface"])
    if flat:
        geometry = tree.nodes.new("ShaderNodeNewGeometry")
        tree.links.new(geometry.outputs["True Normal"], diffuse.inputs["Normal"])
    for owner, name in (
        (material, "displacement_method"),
        (getattr(material, "cycles", None), "displacement_method"),
    ):
        settle(owner, name, "BUMP")
    return material
