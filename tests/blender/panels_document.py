"""Writes docs/panels.md from the tables here (cycles_panels.py) and in the add-on (adopted.py).

Run it with any Python after a change of those; test_panels.py checks that it has been.
"""

import ast
from pathlib import Path

import cycles_panels as table

ROOT = Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "docs" / "panels.md"
ADOPTED = ROOT / "addon" / "komorebi" / "ui" / "adopted.py"

HEAD = """# Panels

What a user of Cycles finds while Komorebi is chosen. Made by `python3 tests/blender/panels_document.py`;
`tests/blender/test_panels.py` fails when a release of Blender has a panel of Cycles that is not named here, or when what is
said to stand in its place is not drawn.

Settings that are Cycles' own (`object.cycles`, `scene.cycles_curves`, `world.cycles_visibility`, in 3.4 the panoramas in
`camera.cycles`) are shown as Cycles has them, so that a file keeps its artist's values; while Cycles' add-on is switched off
they do not exist, and their panels are not shown. Max Bounces of lamps and of worlds, and Cast Shadow up to 4.2, are such: without
Cycles there is no limit. Of a world's Sampling (None, Auto, Manual) nothing is left to choose, since its light is always
looked for by its brightness; a Manual resolution is World Map Resolution here (`scene.komorebi.world_resolution`).
"""


def excluded():
    """The add-on's names and reasons, read without Blender."""
    for statement in ast.parse(ADOPTED.read_text(encoding="utf-8")).body:
        if isinstance(statement, ast.Assign) and statement.targets[0].id == "EXCLUDED":
            return ast.literal_eval(statement.value)
    raise LookupError("EXCLUDED")


def rows(title, head, lines):
    yield f"\n## {title}\n"
    yield "| " + " | ".join(head) + " |"
    yield "|" + "---|" * len(head)
    yield from ("| " + " | ".join(line) + " |" for line in lines)


def code(name):
    return f"`{name}`" if name.isidentifier() else name


def text():
    pairs = lambda names: [(code(k), code(v)) for k, v in sorted(names.items())]  # noqa: E731
    lines = [HEAD.rstrip("\n")]
    lines += rows("Replaced by panels of ours", ("Cycles", "Komorebi"), pairs(table.REPLACED))
    lines += rows("Blender's own are shown instead", ("Cycles", "Blender"), pairs(table.ADOPTED))
    lines += rows("Left out", ("Cycles", "why"), pairs(table.LEFT_OUT))
    lines += rows(
        "Blender's own panels that are not shown",
        ("panel", "why"), pairs({**excluded(), **table.NOT_SHOWN}),
    )  # fmt: skip
    lines += rows(
        "Where Blender asks for Cycles inside a panel or menu",
        ("panel or menu", "what", "with Komorebi"),
        [tuple(code(cell) for cell in row) for row in table.INSIDE],
    )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    DOCUMENT.write_text(text(), encoding="utf-8")
    print(f"wrote {DOCUMENT}")
