"""The command line of `./run compare`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from compare.launch import DEFAULT_BLENDER, PROJECT, Host, Job

SECOND_SEED = 1000  # Cycles against Cycles uses other seeds on the second side


def parser() -> argparse.ArgumentParser:
    """All options with their defaults."""
    made = argparse.ArgumentParser(
        prog="./run compare",
        description="Render a .blend with Cycles and Komorebi, settings matched; do they agree?",
        epilog="Exit code 0: they agree; 1: they do not; 2: no comparison could be made.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    made.add_argument("scene", nargs="?", type=Path, help="the .blend file")
    made.add_argument(
        "--all",
        type=Path,
        metavar="FOLDER",
        help="every .blend below FOLDER, each mode, into a table",
    )
    made.add_argument("--mode", choices=("ao", "world"), default="ao", help="what to compare")
    made.add_argument("--samples", type=int, default=64, help="samples a pixel and seed")
    made.add_argument(
        "--seeds", type=int, default=8, help="pictures an engine (at least 8 for a sound test)"
    )
    made.add_argument("--first-seed", type=int, default=1, help="the first of the seeds")
    made.add_argument("--size", type=int, default=320, help="cap on the longest side in pixels")
    made.add_argument(
        "--view-layer", help="the view layer to render (default: the first that renders)"
    )
    made.add_argument(
        "--frame", type=int, help="the frame (default: the one the file was saved at)"
    )
    made.add_argument("--camera", help="the camera object to look through (default: the scene's)")
    made.add_argument(
        "--stereo",
        choices=("plain", "spherical"),
        help="render both eyes of Stereo 3D side by side, with or without spherical stereo",
    )
    made.add_argument(
        "--bounces", type=int, default=0, help="how often light goes from surface to surface"
    )
    made.add_argument(
        "--materials", action="store_true",
        help="with --mode world: the scene's own materials and world, made matt",
    )  # fmt: skip
    made.add_argument(
        "--fast-gi", choices=("replace", "add"), help="with --mode world: Fast GI Approximation"
    )
    made.add_argument(
        "--ao-bounces", type=int, default=1, help="after how many bounces --fast-gi replace sets in"
    )
    made.add_argument(
        "--ao-distance", type=float, help="metres, of --fast-gi (default: the world's)"
    )
    made.add_argument("--flat", action="store_true", help="shade Cycles with the geometric normal")
    made.add_argument(
        "--world-image", type=Path, help="light world mode with this equirectangular picture"
    )
    made.add_argument("--no-lamps", action="store_true", help="world mode: the world's light alone")
    made.add_argument(
        "--out", type=Path, help="folder for pictures (default: build/compare/SCENE-MODE)"
    )
    made.add_argument("--json", type=Path, help="write the figures to this file too")
    made.add_argument(
        "--second", choices=("KOMOREBI", "CYCLES"), default="KOMOREBI", help="the engine to test"
    )
    made.add_argument("--blender", default=DEFAULT_BLENDER, help="the Blender to run")
    made.add_argument("--python", help="run this Python with its bpy module instead")
    made.add_argument("--timeout", type=float, default=3600.0, help="seconds an engine may take")
    made.add_argument(
        "--reuse", action="store_true", help="take Cycles' pictures of an earlier equal run"
    )
    made.add_argument("--markdown", type=Path, help="with --all: write the table to this file")
    return made


def read(words: list[str]) -> argparse.Namespace:
    """Parse and check; ends with exit code 2 and a sentence where the options make no sense."""
    made = parser()
    options = made.parse_args(words)
    if (options.scene is None) == (options.all is None):
        made.error("name one .blend file, or a folder with --all")
    if options.scene is not None and not options.scene.is_file():
        made.error(f"there is no file {options.scene}")
    if options.all is not None and not options.all.is_dir():
        made.error(f"there is no folder {options.all}")
    if options.world_image is not None and not options.world_image.is_file():
        made.error(f"there is no file {options.world_image}")
    if options.materials and options.mode != "world":
        made.error("--materials goes with --mode world")
    if options.bounces < 0:
        made.error("--bounces must be at least 0")
    if options.fast_gi is not None and options.mode != "world":
        made.error("--fast-gi goes with --mode world")
    if options.ao_bounces < 0:
        made.error("--ao-bounces must be at least 0")
    if options.samples < 1 or options.seeds < 2 or options.size < 4:
        made.error("--samples must be at least 1, --seeds at least 2 and --size at least 4")
    if options.seeds < 8:
        print("note: with fewer than 8 seeds the test is weak", file=sys.stderr)
    return options


def host(options: argparse.Namespace) -> Host:
    """The Blender that the options name."""
    return Host(blender=options.blender, python=options.python, timeout=options.timeout)


def jobs(options: argparse.Namespace, scene: Path, mode: str) -> tuple[Job, Job]:
    """Cycles' job and that of the engine under test."""
    first = Job(
        file=str(scene.resolve()),
        engine="CYCLES",
        mode=mode,
        samples=options.samples,
        seeds=list(range(options.first_seed, options.first_seed + options.seeds)),
        longest=options.size,
        view_layer=options.view_layer,
        flat=options.flat,
        world_image=str(options.world_image.resolve())
        if options.world_image and mode == "world"
        else None,
        lamps=not options.no_lamps,
        frame=options.frame,
        camera=options.camera,
        stereo=options.stereo,
        bounces=options.bounces,
        materials=options.materials,
        fast_gi=options.fast_gi,
        ao_bounces=options.ao_bounces,
        ao_distance=options.ao_distance,
    )
    seeds = [seed + SECOND_SEED for seed in first.seeds]
    return first, Job(**{**vars(first), "engine": options.second, "seeds": seeds})


def folder(options: argparse.Namespace, scene: Path, mode: str) -> Path:
    """Where the pictures of one comparison go."""
    if options.out is not None and options.all is None:
        return Path(options.out).resolve()
    base = Path(options.out).resolve() if options.out is not None else PROJECT / "build" / "compare"
    stem = "".join(c if c.isalnum() or c in "._-" else "_" for c in scene.stem)
    return base / f"{stem}-{mode}{'-materials' if options.materials else ''}"
