"""Named arrays on meshes, curves and points: what is kept, mended and refused."""

from __future__ import annotations

from typing import Any

import komorebi_core as core
import numpy as np
import pytest
import shapes

POSITIONS, CORNERS, OFFSETS = shapes.cube()


def cube(attributes: dict[str, Any] | None, same: Any = None) -> Any:
    return core.Mesh("box", POSITIONS, CORNERS, OFFSETS, attributes=attributes, same_geometry=same)


def rows(count: int, columns: int = 1) -> Any:
    return np.arange(count * columns, dtype=np.float32).reshape(count, columns)


def test_every_domain_of_a_mesh() -> None:
    mesh = cube({
        "point": ("POINT", POSITIONS), "corner": ("CORNER", rows(24, 2)),
        "face": ("FACE", rows(6, 4)),
    })  # fmt: skip
    assert mesh.attributes == ["point", "corner", "face"]
    assert mesh.warnings == []
    corners = mesh.tri2corner()
    for triangle in range(12):
        a, b, c = corners[triangle]
        place = 0.5 * POSITIONS[CORNERS[a]] + 0.2 * POSITIONS[CORNERS[b]]
        place = place + 0.3 * POSITIONS[CORNERS[c]]
        assert np.allclose(mesh.attribute_at("point", triangle, 0.2, 0.3), [*place, 1])
        assert mesh.attribute_at("corner", triangle, 0.0, 0.0) == (2.0 * a, 2.0 * a + 1, 0, 1)
        assert mesh.attribute_at("corner", triangle, 1.0, 0.0) == (2.0 * b, 2.0 * b + 1, 0, 1)
        face = triangle // 2
        assert mesh.attribute_at("face", triangle, 0.1, 0.7) == tuple(
            4.0 * face + i for i in range(4)
        )
    assert cube(None).attributes == []


def test_shading_alone_is_made_anew() -> None:
    first = cube({"a": ("FACE", rows(6))})
    second = cube({"b": ("FACE", rows(6) + 1)}, same=first)
    assert first.attributes == ["a"]
    assert second.attributes == ["b"]
    assert second.attribute_at("b", 2, 0.0, 0.0) == (2.0, 2.0, 2.0, 1.0)
    assert second.rebuilt("SAH").attribute_at("b", 2, 0.0, 0.0) == (2.0, 2.0, 2.0, 1.0)
    with pytest.raises(KeyError):
        second.attribute_at("a", 0, 0.0, 0.0)
    with pytest.raises(IndexError):
        second.attribute_at("b", 12, 0.0, 0.0)


def test_curves_and_points() -> None:
    keys = rows(5, 3)
    curves = core.Mesh.from_curves(
        "fur", keys, np.ones(5, np.float32), np.array([0, 2, 5], np.int32),
        attributes={"key": ("POINT", rows(5)), "uv": ("CURVE", rows(2, 2))},
    )  # fmt: skip
    assert [curves.attribute_at("key", s, 0.5, 0.0)[0] for s in range(3)] == [0.5, 2.5, 3.5]
    assert [curves.attribute_at("uv", s, 0.5, 0.0)[1] for s in range(3)] == [1.0, 3.0, 3.0]
    points = core.Mesh.from_points(
        "cloud", keys, np.ones(5, np.float32), attributes={"key": ("POINT", rows(5))}
    )
    assert points.attribute_at("key", 4, 0.0, 0.0) == (4.0, 4.0, 4.0, 1.0)


def test_what_is_not_finite_is_told() -> None:
    values = rows(8)
    values[3] = np.nan
    mesh = cube({"hot": ("POINT", values)})
    assert mesh.warnings == [
        'mesh "box": attribute "hot" has 1 number that is not finite and taken for 0'
    ]


BAD: dict[str, tuple[Any, str]] = {
    "pair": (rows(8), "must be a pair of domain and array"),
    "domain": (("EDGE", rows(8)), "must have the domain POINT, CORNER, FACE or CURVE, not EDGE"),
    "rows": (("POINT", rows(7)), "must have one row a vertex"),
    "columns": (("POINT", rows(8, 5)), "must have one to four components"),
    "none": (("POINT", rows(8, 0)), "must have one to four components"),
    "dtype": (("POINT", rows(8).astype(np.float64)), "must have dtype float32"),
    "shape": (("POINT", rows(8).ravel()), "must have shape"),
}


@pytest.mark.parametrize("case", BAD)
def test_a_bad_attribute_is_refused_by_name(case: str) -> None:
    value, sentence = BAD[case]
    with pytest.raises(ValueError, match=f'mesh "box": attribute "x" {sentence}'):
        cube({"x": value})
