"""Very many instances: where they are, what Blender keeps of them, how much memory they take."""

import contextlib
import tracemalloc

import bpy
import many_instances
import numpy as np
import support


class Engine:
    """Stands for the render engine; Blender wants to stop at the `breaks`th look."""

    is_preview = False

    def __init__(self, breaks=None):
        self.looks, self.breaks = 0, breaks

    def test_break(self):
        self.looks += 1
        return self.looks == self.breaks

    def report(self, *_):
        pass


def export(engine=None):
    """SceneData with nothing but what export_instances fills in, of the open scene."""
    from komorebi.export.deform import DeformingShapes
    from komorebi.export.instance import export_instances
    from komorebi.export.wanted import Wanted
    from komorebi.scene_data import SceneData
    from komorebi.unchanged import Unchanged

    data = SceneData(None, None)
    graph = bpy.context.evaluated_depsgraph_get()
    engine = engine or Engine()
    still = DeformingShapes(engine, graph, None)
    export_instances(engine, graph, data, Wanted(), Unchanged(), still)
    return data


def walked():
    """Object's name → matrices, as a plain walk over the same dependency graph has them."""
    found = {}
    for instance in bpy.context.evaluated_depsgraph_get().object_instances:
        obj = instance.object
        if obj.type == "MESH" and instance.show_self and len(obj.data.polygons):
            found.setdefault(instance.object.original.name, []).append(
                [list(row) for row in instance.matrix_world]
            )
    return {name: np.array(rows, np.float32) for name, rows in found.items()}


def collected(data):
    found = {}
    for group in data.instances:
        for index, matrix in zip(group.object_index, group.matrices, strict=True):
            found.setdefault(data.objects[index].name, []).append(matrix)
    return {name: np.array(rows) for name, rows in found.items()}


def test_every_instance_is_where_a_walk_has_it():
    for kind in many_instances.KINDS:
        for first in (True, False):
            support.fresh_scene()
            many_instances.make(kind, 900, first)
            truth = walked()
            assert sum(len(rows) for rows in truth.values()) >= 900, (kind, len(truth))
            for answer in (None, True, False):
                with one_by_one(answer) as decided:
                    found = collected(export())
                assert decided == [first], (kind, decided)
                assert found.keys() == truth.keys(), (kind, found.keys(), truth.keys())
                for name, rows in found.items():
                    assert np.array_equal(rows, truth[name]), (kind, first, answer, name)


@contextlib.contextmanager
def one_by_one(answer):
    """Whether matrices are read one by one; None: as the exporter decides. Collects what it does."""
    from komorebi.export import instance as exporter

    decide, decided = exporter.loses_memory, []

    def loses_memory(first):
        decided.append(decide(first))
        return decided[-1] if answer is None else answer

    exporter.loses_memory = loses_memory
    try:
        yield decided
    finally:
        exporter.loses_memory = decide


def test_instances_with_hair_and_several_shapes():
    """An object gives a group for its surface and one for its hair; groups hold all instances of a
    shape, whatever order they come in."""
    small = many_instances.make("nodes", 50, True)
    small.modifiers.new("hair", "PARTICLE_SYSTEM")
    settings = small.particle_systems[0].settings
    settings.type, settings.count = "HAIR", 3
    other = support.add_object("other", small.data)
    other.location.x = 5
    data = export()
    kinds = [type(data.meshes[group.mesh]).__name__ for group in data.instances]
    assert sorted(kinds) == ["CurveData", "MeshData", "MeshData"], kinds
    for group, kind in zip(data.instances, kinds, strict=True):
        names = [data.objects[i].name for i in group.object_index]
        assert names in (["other"], ["small"] * 51), (kind, names)  # itself, too
        assert kind == "MeshData" or names[0] == "small"
        assert names[0] == "small" or list(group.matrices[:, 0, 3]) == [5.0]


def test_instances_of_one_mesh_have_the_materials_of_their_own_object():
    collection = bpy.data.collections.new("inner")
    mesh = many_instances.triangle("shared")
    mesh.materials.append(bpy.data.materials.new("of mesh"))
    for i in range(5):
        obj = bpy.data.objects.new(f"object {i}", mesh)
        obj.material_slots[0].link = "OBJECT"
        obj.material_slots[0].material = bpy.data.materials.new(f"material {i}")
        collection.objects.link(obj)
    empty = support.add_object("empty", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    data = export()
    found = {}
    for group in data.instances:
        for index, slots in zip(group.object_index, group.material_slots, strict=True):
            names = [data.materials.materials[m].name for m in data.materials.slots[slots]]
            found[data.objects[index].name] = names
    for i in range(5):
        assert found[f"object {i}"] == [f"material {i}"], found


def test_no_memory_is_lost_with_instances():
    """Blender frees an instancer's list of instances, 200 bytes each, only when a walk ends."""
    from komorebi.errors import RenderCancelled

    def cancelled():
        try:
            export(Engine(breaks=3))
        except RenderCancelled:
            return
        raise AssertionError("it was not cancelled")

    for kind in many_instances.KINDS:
        for first in (True, False):
            support.fresh_scene()
            many_instances.make(kind, 20000, first)
            for what in (export, cancelled):
                lost = min(grown(what, 6) for _ in range(4)) / 20000  # the allocator may grow once
                assert lost < 20, f"{kind}, {what.__name__}: {lost:.0f} bytes an instance and turn"


def grown(what, turns):
    """Bytes that the process gains with each turn."""
    before = support.resident_bytes()
    for _ in range(turns):
        what()
    return (support.resident_bytes() - before) / turns


def test_export_keeps_no_object_per_instance():
    """At its peak what Python holds while it exports is numbers: 7 times as much were objects."""
    for kind in many_instances.KINDS:
        for first in (True, False):
            support.fresh_scene()
            many_instances.make(kind, 40000, first)
            export()
            tracemalloc.start()
            try:
                data = export()
                held, peak = tracemalloc.get_traced_memory()
            finally:
                tracemalloc.stop()
            count = sum(len(group.object_index) for group in data.instances)
            assert count >= 40000
            assert held / count < 80, (kind, held / count)
            assert peak / count < 190, (kind, first, peak / count)
