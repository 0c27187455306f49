"""Tables for the terminal and for Markdown."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any


@dataclass
class Table:
    """A heading, column heads, rows of text, and sentences below."""

    title: str
    heads: list[str]
    rows: list[list[str]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def add(self, *cells: str) -> None:
        """One row."""
        if len(cells) != len(self.heads):
            raise ValueError(f"{len(cells)} cells under {len(self.heads)} heads")
        self.rows.append(list(cells))

    def text(self) -> str:
        """Aligned columns, numbers to the right."""
        widths = [
            max(len(row[k]) for row in [self.heads, *self.rows]) for k in range(len(self.heads))
        ]
        lines = [self.title]
        for row in [self.heads, *self.rows]:
            first, *rest = (
                cell.ljust(w) if k == 0 else cell.rjust(w)
                for k, (cell, w) in enumerate(zip(row, widths, strict=True))
            )
            lines.append("  " + "  ".join([first, *rest]).rstrip())
        return "\n".join([*lines, *(f"  {note}" for note in self.notes)])

    def markdown(self, command: str) -> str:
        """As it goes into docs/performance.md, with the command that made it."""
        lines = [f"### {self.title}", "", f"    {command}", ""]
        lines += [
            "| " + " | ".join(self.heads) + " |",
            "|---" + "|---:" * (len(self.heads) - 1) + "|",
        ]
        lines += ["| " + " | ".join(row) + " |" for row in self.rows]
        return "\n".join([*lines, "", *self.notes, ""] if self.notes else [*lines, ""])

    def as_json(self) -> dict[str, Any]:
        """The same, for the result file."""
        return asdict(self)


def figure(value: float, digits: int = 3) -> str:
    """`digits` significant ones, without an exponent."""
    if value == 0.0:
        return "0"
    places = max(0, digits - 1 - int(f"{value:e}".split("e")[1]))
    return f"{value:,.{places}f}"


def times(value: float) -> str:
    """A ratio."""
    return f"{value:.2f}×"
