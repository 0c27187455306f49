"""The way through a depsgraph's instances on which Blender loses no memory."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from ..errors import RenderCancelled

CANCEL_INTERVAL = 256  # instances between two looks at whether Blender wants to stop


@dataclass(slots=True)
class Subject:
    """What some instances show: the same object with the same data, so all but place is equal."""

    original: Any
    address: int  # of the original
    kind: str  # the evaluated object's type
    surface: int | None = None  # index of an entry or NONE; None: not asked for yet
    hair: int | None = None


def walk(engine: Any, depsgraph: Any) -> Iterator[tuple[int, Any, Subject]]:
    """Every instance with its number and what it shows, valid until the next. Raises
    RenderCancelled."""
    instances = iter(depsgraph.object_instances)
    subjects: dict[Any, Subject] = {}
    try:
        for number, instance in enumerate(instances):
            if number % CANCEL_INTERVAL == 0 and engine.test_break():
                raise RenderCancelled
            inner = instance.instance_object
            key = (inner, instance.path_resolve("object.data")) if inner else instance.object
            subject = subjects.get(key)
            if subject is None:
                obj = object_of(instance)
                original = obj.original
                subject = subjects[key] = Subject(original, original.as_pointer(), obj.type)
            yield number, instance, subject
    finally:
        deque(instances, 0)  # an instancer's list of instances is freed at its end only


def object_of(instance: Any) -> Any:
    """The evaluated object that an instance shows.

    For the instances of an instancer Blender makes a passing object each, with data of its own
    where geometry nodes have made them. Whoever asks for it leaves a Python object behind for ever,
    64 (3.4) to 128 bytes (4.5): so only here, once for all instances of the same subject, and only
    where the instanced object itself does not say the same.
    """
    inner = instance.instance_object
    if inner and inner.data == instance.path_resolve("object.data"):
        return inner
    return instance.object
