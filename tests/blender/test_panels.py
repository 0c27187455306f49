"""Everything that the engine reads can be set while it is chosen, and nothing else changes.

Panels are drawn into a layout that records (panel_recorder.py), for each kind of thing that a user
may have active (panel_subjects.py); test_panels_window.py draws them in a window.
"""

import inspect
import sys

import bpy
import cycles_panels as table
import panel_recorder as recorder
import panel_subjects
import panels_document
import support
from komorebi import passes, ui
from komorebi.ui import adopted, camera, menus, view_layer


def subclasses(cls):
    for child in cls.__subclasses__():
        yield child
        yield from subclasses(child)


def cycles_ui():
    if "cycles" not in sys.modules:
        raise support.Skip("this Blender has no Cycles")
    from cycles import ui as module

    return module


def names_of_cycles():
    """Its registered classes, and the functions that it appends to Blender's."""
    module = cycles_ui()
    for cls in module.classes:
        yield cls.__name__
    for name, value in vars(module).items():
        own = inspect.isfunction(value) and value.__module__ == module.__name__
        if own and list(inspect.signature(value).parameters) == ["self", "context"]:
            yield name


def engines(cls):
    return getattr(cls, "COMPAT_ENGINES", ())


def draw_everywhere():
    """What each panel of ours drew, over all subjects: {name: {(type, property), …}}."""
    drawn = {}
    for name, context in panel_subjects.subjects():
        for cls in ui.CLASSES:
            try:
                found = recorder.draw(cls, context)
            except Exception as error:
                raise AssertionError(f"{cls.__name__} before {name}: {error}") from error
            if found is not None:
                drawn.setdefault(cls.__name__, set()).update(found)
    return drawn


def with_children(cls_name, drawn):
    """What the panel or those inside it drew."""
    found = set(drawn.get(cls_name, ()))
    for cls in ui.CLASSES:
        if getattr(cls, "bl_parent_id", "") == cls_name and cls_name in drawn:
            found |= with_children(cls.__name__, drawn)
    return found


def test_every_class_of_cycles_has_its_line_in_the_table():
    tables = (table.REPLACED, table.ADOPTED, table.LEFT_OUT)
    known = [name for names in tables for name in names]
    assert len(known) == len(set(known)), "a class stands in two tables"
    names = set(names_of_cycles())
    assert len(names) > 80, names
    assert not names - set(known), f"not in the table: {sorted(names - set(known))}"


def test_what_replaces_a_panel_is_drawn():
    drawn, names = draw_everywhere(), set(names_of_cycles())
    functions = {draw.__name__ for _, draw in menus.ADDITIONS}
    for theirs, ours in table.REPLACED.items():
        if theirs in names and ours not in functions:
            assert with_children(ours, drawn), f"{theirs}: {ours} draws nothing"
    for theirs, ours in table.ADOPTED.items():
        if theirs in names:
            panel = getattr(bpy.types, ours, None)
            assert panel is not None, f"{theirs}: there is no {ours}"
            assert "KOMOREBI" in engines(panel), f"{theirs}: {ours} is not shown"


def test_every_panel_of_ours_is_drawn_or_has_nothing_to_show():
    drawn = draw_everywhere()
    here = set()
    if hasattr(bpy.types, "VIEWLAYER_PT_override"):
        here.add("KOMOREBI_VIEWLAYER_PT_override")
    if "compositor_device" not in bpy.context.scene.render.bl_rna.properties:
        here.add("KOMOREBI_RENDER_PT_performance_compositor")
    if not view_layer.toggles("OTHER", bpy.context.view_layer):
        here.add("KOMOREBI_VIEWLAYER_PT_passes_other")
    empty = {c.__name__ for c in ui.CLASSES if not with_children(c.__name__, drawn)}
    assert empty == here, empty ^ here


def test_what_blender_shows_for_cycles_is_shown_or_named():
    """Blender's own panels that Cycles adopts, and those that Blender made for it."""
    cycles_ui()
    for panel in subclasses(bpy.types.Panel):
        if panel.__module__.startswith(("cycles", "komorebi")) or "CYCLES" not in engines(panel):
            continue
        if panel.__name__.startswith(("CYCLES", "NODE_CYCLES")):
            continue
        named = panel.__name__ in adopted.EXCLUDED or panel.__name__ in table.NOT_SHOWN
        assert ("KOMOREBI" in engines(panel)) != named, panel.__name__


def test_excluded_panels_are_not_shown_by_a_set_they_share():
    for panel in subclasses(bpy.types.Panel):
        if panel.__name__ in adopted.EXCLUDED or panel.__name__ in table.NOT_SHOWN:
            assert "KOMOREBI" not in engines(panel), panel.__name__


def test_document_is_the_tables():
    written = panels_document.DOCUMENT.read_text(encoding="utf-8")
    assert written == panels_document.text(), "run python3 tests/blender/panels_document.py"


def test_panels_draw_without_cycles(folder):
    """Switched off, its settings are not there at all."""
    done = support.script(
        "import addon_utils, bpy\naddon_utils.disable('cycles')\n"
        "assert not hasattr(bpy.types.Object, 'cycles')\n"
        "support.fresh_scene()\nimport test_panels\n"
        "drawn = test_panels.draw_everywhere()\n"
        "assert 'KOMOREBI_OBJECT_PT_visibility' in drawn, drawn\n"
        "assert 'KOMOREBI_RENDER_PT_curves' not in drawn, drawn\n"
        "assert not any(t.startswith('Cycles') for d in drawn.values() for t, _ in d), drawn\n"
        "print('DRAWN', len(drawn))\n",
        folder,
    )
    assert done.code == 0 and "DRAWN" in done.output, done


def test_all_kinds_of_panorama_have_their_settings():
    data = bpy.data.cameras.new("Panorama")
    kinds = panel_subjects.panorama_types(data)
    assert set(kinds) <= set(camera.PANORAMAS), kinds
    owner = panel_subjects.panorama_owner(data)
    shaping = ("fisheye_", "latitude_", "longitude_", "central_cylindrical_")
    there = {p.identifier for p in owner.bl_rna.properties if p.identifier.startswith(shaping)}
    assert there == {name for kind in kinds for name in camera.PANORAMAS[kind]}


def test_every_pass_that_is_filled_can_be_switched_on():
    scene, layer = bpy.context.scene, bpy.context.view_layer
    groups = [cls.group for cls in view_layer.CLASSES if hasattr(cls, "group")]
    shown = [toggle for group in groups for toggle in view_layer.toggles(group, layer)]
    always = {p.name for p in passes.enabled_passes(scene, layer)}
    reached = set()
    for owner, name, _ in shown:
        before = getattr(owner, name)
        setattr(owner, name, True)
        gained = {p.name for p in passes.enabled_passes(scene, layer)} - always
        assert gained or name == view_layer.GREASE_PENCIL[0], f"{name} switches no pass on"
        reached |= gained
        setattr(owner, name, before)
    filled = {switch.name for switch in passes.SWITCHES if switch.source and switch.exists}
    assert filled <= reached | always, filled - reached
    for _, _, name in passes.CRYPTOMATTES:
        assert f"{name}00" in reached
    assert {switch.group for switch in passes.SWITCHES} - {""} <= set(groups)


def test_outliner_offers_indirect_only():
    scene = bpy.context.scene
    menu = bpy.types.OUTLINER_MT_collection_view_layer
    for engine, times in (("KOMOREBI", 1), ("CYCLES", 1), ("BLENDER_WORKBENCH", 0)):
        scene.render.engine = engine
        layout = recorder.Layout()
        for function in recorder.functions(menu):
            function(recorder.Panel(menu, layout), panel_subjects.context_of())
        found = [name for _, name in layout.drawn if "collection_indirect_only_set" in name]
        assert len(found) == times, (engine, layout.drawn)
