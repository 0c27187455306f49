"""Numbers of materials through the module: what is refused, and what their passes show."""

from __future__ import annotations

from typing import Any

import komorebi_core as core
import numpy as np
import pytest
import shapes


def scene(**tables: Any) -> core.Scene:
    made = shapes.scene(committed=False)
    one = np.zeros(1, np.float32)
    given = {
        "object_pass_index": one,
        "object_mattes": np.zeros((1, 2), np.float32),
        "object_terminators": np.zeros((1, 2), np.float32),
        "material_pass_index": one,
        "material_mattes": one,
        "slot_begin": np.array([0, 1], np.uint32),
        "slots": np.zeros(1, np.uint32),
        **tables,
    }
    made.set_tables(**given)
    made.commit()
    return made


def test_a_pass_shows_the_values_that_it_names() -> None:
    made = scene(material_values=np.array([[0.5, -2.0, 1e5, 1.0]], np.float32))
    names = ("Combined", "Material Value 0 1", "Material Value 1 3")
    session = shapes.finish(core.Session(made, core.Settings(samples=4, passes=names)))
    one, three = session.read("Material Value 0 1"), session.read("Material Value 1 3")
    assert (one.shape[2], three.shape[2]) == (1, 3)
    np.testing.assert_allclose(one[0, 32], [0.5])  # the ground is all around
    np.testing.assert_allclose(three[0, 32], [-2.0, 1e5, 1.0], rtol=1e-6)


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(ValueError, match="material_values must have shape"):
        scene(material_values=np.zeros((2, 1), np.float32))
    with pytest.raises(ValueError, match="not finite"):
        scene(material_values=np.array([[np.nan]], np.float32))
    two = core.Program("two", [], [0.0, 1.0])
    with pytest.raises(ValueError, match="two: a program of values has as many outputs"):
        scene(material_values=np.zeros((1, 1), np.float32), value_programs=[two])
    with pytest.raises(ValueError, match="as many as materials"):
        scene(material_values=np.zeros((1, 2), np.float32), value_programs=[two, None])
    made = scene(material_values=np.zeros((1, 2), np.float32))
    for name, sentence in (
        ("Material Value 1 2", "does not have"),
        ("Material Value 0 5", "there is no pass"),
        ("Material Value", "there is no pass"),
    ):
        with pytest.raises(ValueError, match=sentence):
            core.Session(made, core.Settings(samples=1, passes=(name,)))
