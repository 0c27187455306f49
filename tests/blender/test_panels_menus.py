"""The node editor's menu, new materials, and that switching the add-on off leaves no trace."""

import re
import sys
import types

import bpy
import panel_recorder as recorder
import support

SHADERS = {
    "OBJECT": {"ShaderNodeBsdfPrincipled", "ShaderNodeBsdfDiffuse", "ShaderNodeEmission",
               "ShaderNodeMixShader", "ShaderNodeBsdfToon", "ShaderNodeOutputMaterial"},
    "WORLD": {"ShaderNodeBackground", "ShaderNodeOutputWorld"},
}  # fmt: skip
EEVEE_ONLY = {"ShaderNodeEeveeSpecular", "ShaderNodeShaderToRGB"}
CYCLES_ONLY = {"ShaderNodeScript"}  # OSL
SOURCE = "(?:NODE_MT_category_(?:SH_NEW|shader)_|NODE_MT_shader_node_).*"


class MenuLayout(recorder.Layout):
    """Notes the types of the nodes that a menu would add."""

    def __getattr__(self, name):
        if name == "operator":
            return self._operator
        if name in recorder.PROPERTIES:
            return None
        return lambda *_, **__: self

    def _operator(self, *_, **__):
        drawn = self.drawn

        class Settings(types.SimpleNamespace):
            def __setattr__(self, name, value):
                if name == "type":
                    drawn.add(value)

        return Settings(settings=recorder.Collection())


def offered(kind):
    """The nodes in the Add menu of a shader tree of `kind`, while the chosen engine is chosen."""
    space = types.SimpleNamespace(
        tree_type="ShaderNodeTree", shader_type=kind, edit_tree=None, type="NODE_EDITOR",
        node_tree=None, id_from=None,
    )  # fmt: skip
    context = recorder.Context(space_data=space, engine=bpy.context.scene.render.engine)
    layout = MenuLayout()
    for name in dir(bpy.types):
        if re.fullmatch(SOURCE, name):
            menu = getattr(bpy.types, name)
            for function in recorder.functions(menu) or inherited_draw(menu):
                function(MenuInstance(menu, layout), context)
    return layout.drawn


def inherited_draw(menu):
    return [menu.draw] if hasattr(menu, "draw") else []


class MenuInstance(recorder.Panel):
    """What a menu's draw function sees; from 5.0 on it calls functions of its own class."""

    def __getattr__(self, name):
        if name == "bl_label":
            return getattr(self._cls, name, "")
        for cls in self._cls.__mro__:
            if name in vars(cls):
                value = vars(cls)[name]
                if isinstance(value, classmethod | staticmethod):
                    return value.__get__(None, self._cls)
                return types.MethodType(value, self) if callable(value) else value
        raise AttributeError(name)


def test_shader_nodes_can_be_added():
    scene = bpy.context.scene
    for kind, wanted in SHADERS.items():
        scene.render.engine = "KOMOREBI"
        ours = offered(kind)
        assert wanted <= ours, wanted - ours
        scene.render.engine = "CYCLES"
        theirs = offered(kind)
        assert ours - CYCLES_ONLY == theirs - CYCLES_ONLY, ours ^ theirs
        assert not ours & EEVEE_ONLY, ours & EEVEE_ONLY


def test_other_engines_see_the_menu_as_it_was():
    bpy.context.scene.render.engine = "BLENDER_WORKBENCH"
    here = offered("OBJECT")
    if "nodeitems_builtins" in sys.modules and bpy.app.version < (4, 0, 0):
        assert "ShaderNodeBsdfPrincipled" not in here
    assert "ShaderNodeMath" in here


def test_new_material_is_principled():
    bpy.ops.material.new()
    material = bpy.data.materials[-1]
    types_of = {node.bl_idname for node in bpy.data.materials["Material.001"].node_tree.nodes}
    assert types_of == {"ShaderNodeBsdfPrincipled", "ShaderNodeOutputMaterial"}, material


STATE = """
import bpy, json, sys
def subclasses(cls):
    for child in cls.__subclasses__():
        yield child
        yield from subclasses(child)
def name_of(function):
    return f"{function.__module__}.{function.__qualname__}.{id(function)}"
def state():
    found = {}
    for kind in (bpy.types.Panel, bpy.types.Menu, bpy.types.Header):
        for cls in subclasses(kind):
            if not cls.is_registered:
                continue
            draw = getattr(cls, "draw", None)
            functions = getattr(draw, "_draw_funcs", [draw] if draw else [])
            found[cls.__name__] = (sorted(getattr(cls, "COMPAT_ENGINES", ())),
                                   [name_of(f) for f in functions])
    if "nodeitems_builtins" in sys.modules:
        categories = getattr(sys.modules["nodeitems_builtins"], "shader_node_categories", ())
        found["polls"] = [str(getattr(i, "poll", None)) for c in categories for i in c.items(None)]
    return found
import addon_utils
before = state()
assert addon_utils.enable("komorebi") is not None
during = state()
changed = {name for name in during if during[name] != before.get(name)}
assert {"RENDER_PT_context", "DATA_PT_lens", "OUTLINER_MT_collection_view_layer"} <= changed, changed
addon_utils.disable("komorebi")
after = state()
different = {n: (before.get(n), after.get(n)) for n in {*before, *after} if before.get(n) != after.get(n)}
assert not different, different
print("SAME", len(before), len(changed))
"""


def test_switched_off_everything_is_as_it_was(folder):
    path = folder / "state.py"
    path.write_text(STATE)
    if support.IS_MODULE:
        command = [sys.executable, path]
    else:
        command = [bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "1",
                   "-P", path]  # fmt: skip
    done = support.process(command)
    assert done.code == 0 and "SAME" in done.output, done
