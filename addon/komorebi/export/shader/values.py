"""What flows between the nodes of a shader tree, as operands of the core's programs. No bpy.

A value is a tuple of operands: one for a number, three for a colour or vector. An operand is a
number or, of an operation that has been written down, (its index, which of its outputs).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ...scene_data import FloatArray, Op, Value

# Rec. 709, as Cycles makes a number of a colour; of a vector it takes the mean.
LUMINANCE = (0.2126729, 0.7151522, 0.0721750)


@dataclass(slots=True)
class Builder:
    """Writes operations down, each only once."""

    ops: list[Op] = field(default_factory=list)
    _known: dict[Any, int] = field(default_factory=dict)

    def op(
        self, name: str, operands: Value = (), outputs: int = 1, *,
        numbers: tuple[float, ...] = (), table: FloatArray | None = None, of: str = "",
        texture: Any = None,
    ) -> Value:  # fmt: skip
        """The outputs of an operation on these operands."""
        pixels = None if table is None else table.tobytes()
        key = (name, operands, numbers, pixels, of, None if texture is None else texture.key)
        index = self._known.get(key)
        if index is None:
            index = self._known[key] = len(self.ops)
            self.ops.append(Op(name, operands, numbers, table, of, texture))
        return tuple((index, output) for output in range(outputs))

    def each(self, name: str, *values: Value, **more: Any) -> Value:
        """An operation channel by channel; numbers go with every channel."""
        width = max(map(len, values))
        wide = [value * width if len(value) == 1 else value for value in values]
        return tuple(
            self.op(name, tuple(value[c] for value in wide), **more)[0] for c in range(width)
        )

    def input(self, name: str, width: int = 3) -> Value:
        return self.op("input", outputs=width, of=name)

    def attribute(self, name: str) -> Value:
        """Red, green, blue and alpha."""
        return self.op("attribute", outputs=4, of=name)

    def dot(self, a: Value, b: Value) -> Value:
        products = self.each("multiply", a, b)
        total = products[:1]
        for product in products[1:]:
            total = self.op("add", (total[0], product))
        return total

    # Common arithmetic, with what needs no operation left out.
    def multiply(self, a: Value, b: Value) -> Value:
        for x, y in ((a, b), (b, a)):
            if all(c == 1.0 for c in x) and len(x) <= len(y):
                return y
            if all(c == 0.0 for c in x):  # as the core: whatever the other is
                return (0.0,) * max(len(x), len(y))
        return self.each("multiply", a, b)

    def add(self, a: Value, b: Value) -> Value:
        for x, y in ((a, b), (b, a)):
            if all(c == 0.0 for c in x) and len(x) <= len(y):
                return y
        return self.each("add", a, b)

    def subtract(self, a: Value, b: Value) -> Value:
        return self.each("subtract", a, b)

    def mix(self, factor: Value, a: Value, b: Value) -> Value:
        return self.each("mix", factor, a, b)

    def clamp01(self, a: Value) -> Value:
        return self.each("clamp01", a)

    def convert(self, value: Value, source: str, target: str) -> Value:
        """A socket's value as Cycles hands it to a socket of another type (Blender's names)."""
        if target in VECTORS:
            return value[:3] if len(value) >= 3 else value[:1] * 3
        if len(value) == 1:
            return self.op("truncate", value) if target == "INT" and source != "INT" else value
        if source == "RGBA":
            number = self.dot(value[:3], LUMINANCE)
        else:
            number = self.multiply(self.dot(value[:3], (1.0, 1.0, 1.0)), (1.0 / 3.0,))
        return self.op("truncate", number) if target == "INT" else number


VECTORS = {"RGBA", "VECTOR"}
