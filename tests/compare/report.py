"""The figures of a comparison as text for a terminal."""

from __future__ import annotations

from typing import Any

from compare.statistics import MOST_BLOCKS, MOST_ERRORS


def table(f: dict[str, Any]) -> str:
    """One line a figure: `f` as `compare.__main__.compare` returns it."""
    (first, second), (width, height) = f["engines"], f["size"]
    times, means = f["seconds_a_picture"], f["means"]
    errors = f["mean_difference_in_standard_errors"]
    full = f["difference_at_full_strength"]
    rows = [
        ("scene", f"{f['scene']} ({f['mode']}, view layer {f['view_layer']})"),
        ("Blender", f["blender"]),
        ("pictures", f"{width} × {height}, {f['seeds']} seeds of {f['samples']} samples"),
        ("seconds a picture", f"{times[0]:.2f} {first}, {times[1]:.2f} {second}"),
        ("means", f"{means[0]:.6f} {first}, {means[1]:.6f} {second}"),
        ("means differ by", f"{errors:.2f} standard errors (at most {MOST_ERRORS:g})"),
        (
            "blocks that disagree",
            f"{f['disagreeing']} of {f['blocks']}: {f['disagreeing_percent']:.3f} %"
            f" (at most {100 * MOST_BLOCKS:g} %)",
        ),
        ("largest in a block", f"{f['largest_block_difference']:.3g}"),
        ("largest of alpha", f"{f['largest_alpha_difference']:.3g}"),
        ("side by side", f"{f['picture']} (full red or blue: {full:.3g})"),
    ]
    if f["blocks_excused"]:
        text = f"{f['blocks_excused']}: there Cycles up to 3.x bends normals (inside/bent.py)"
        rows.append(("blocks excused", text))
    for note in f["switched_off"] or ["nothing"]:
        rows.append(("switched off or changed", note))
    rows.append(("verdict", "they agree" if f["passed"] else "they do NOT agree"))
    lines, last = [], ""
    for name, text in rows:
        lines.append(f"{'' if name == last else name:>23}  {text}")
        last = name
    return "\n".join(lines)
