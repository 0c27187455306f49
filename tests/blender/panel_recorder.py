"""Draws panels without a window: a layout that notes what it is told and refuses what Blender would.

A real layout answers a property that does not exist with a line on the terminal and nothing on the
screen; this one raises.
"""

import inspect
import types

import bpy

FUNCTIONS = bpy.types.UILayout.bl_rna.functions
PROPERTIES = {p.identifier for p in bpy.types.UILayout.bl_rna.properties}
# What draws a property, by the places of (owner, name) among the arguments; lists draw two.
OWNERS = {
    "prop": [(0, 1)], "prop_search": [(0, 1)], "prop_enum": [(0, 1)], "prop_menu_enum": [(0, 1)],
    "prop_tabs_enum": [(0, 1)], "prop_with_popover": [(0, 1)], "template_ID": [(0, 1)],
    "template_curve_mapping": [(0, 1)], "template_color_ramp": [(0, 1)],
    "template_list": [(2, 3), (4, 5)],
}  # fmt: skip


class Layout:
    """Notes (type, property) of everything drawn, and how many things of any kind."""

    def __init__(self, drawn=None):
        object.__setattr__(self, "drawn", set() if drawn is None else drawn)

    def __setattr__(self, name, value):
        assert name in PROPERTIES, f"UILayout has no {name}"

    def __getattr__(self, name):
        if name in PROPERTIES:
            return getattr(bpy.types.UILayout.bl_rna.properties[name], "default", None)
        known = name in FUNCTIONS or hasattr(bpy.types.UILayout, name)
        if not known:
            raise AttributeError(f"UILayout has no {name}")
        return lambda *arguments, **options: self._call(name, arguments, options)

    def _call(self, name, arguments, options):
        self._check_options(name, options)
        for owner, place in OWNERS.get(name, ()):
            self._property(name, _argument(name, owner, arguments, options),
                           _argument(name, place, arguments, options))  # fmt: skip
        if name in ("operator", "operator_menu_enum"):
            module, function = arguments[0].split(".")
            if bpy.app.background and module == "preferences":
                return types.SimpleNamespace()  # the `bpy` module has no such operators
            getattr(getattr(bpy.ops, module), function).get_rna_type()  # raises if there is none
            self.drawn.add((name, arguments[0]))
            return types.SimpleNamespace(settings=Collection())
        if name in ("panel", "panel_prop"):
            return Layout(self.drawn), Layout(self.drawn)
        if name in ("label", "menu", "popover", "template_node_view", "template_preview"):
            self.drawn.add((name, str(arguments[:1])))
        return Layout(self.drawn)

    def _check_options(self, name, options):
        if name not in FUNCTIONS:
            return  # written in Python
        parameters = FUNCTIONS[name].parameters
        for option, value in options.items():
            assert option in parameters, f"UILayout.{name} has no {option}"
            if option == "icon":
                icons = parameters["icon"].enum_items
                assert value in icons, f"there is no icon {value}"

    def _property(self, function, owner, name):
        assert owner is not None, f"{function} of {name} of nothing"
        if name.startswith('["'):
            return
        known = owner.bl_rna.properties
        assert name in known, f"{owner.bl_rna.identifier} has no {name}"
        self.drawn.add((owner.bl_rna.identifier, name))


class Collection(list):
    def add(self):
        self.append(types.SimpleNamespace())
        return self[-1]


def _argument(function, place, arguments, options):
    if place < len(arguments):
        return arguments[place]
    names = [p.identifier for p in FUNCTIONS[function].parameters if not p.is_output]
    return options[names[place]]


class Context:
    """Blender's context with members of its own; what is nowhere is None, as in an editor."""

    def __init__(self, **members):
        self.__dict__.update(members)

    def __getattr__(self, name):
        return getattr(bpy.context, name, None)


class Panel:
    """Stands for an instance of a panel's class, which only Blender can make."""

    def __init__(self, cls, layout):
        self.__dict__.update(_cls=cls, layout=layout)

    def __getattr__(self, name):
        value = inspect.getattr_static(self._cls, name)
        if isinstance(value, types.FunctionType):
            return types.MethodType(value, self)
        return getattr(self._cls, name)


def draw(cls, context):
    """What the panel (menu, header) shows in `context`: None where it is not shown at all."""
    if not is_shown(cls, context):
        return None
    layout = Layout()
    instance = Panel(cls, layout)
    for name in ("draw_header", "draw"):
        for function in functions(cls, name):
            function(instance, context)
    return layout.drawn


def is_shown(cls, context):
    """Whether the panel and those that it is in pass their polls."""
    parent = getattr(bpy.types, getattr(cls, "bl_parent_id", ""), None)
    if parent is not None and not is_shown(parent, context):
        return False
    return not hasattr(cls, "poll") or bool(cls.poll(context))


def functions(cls, name="draw"):
    """Blender's own function and those that add-ons appended to it."""
    function = inspect.getattr_static(cls, name, None)
    if function is None or not isinstance(function, types.FunctionType):
        return []
    return list(getattr(function, "_draw_funcs", [function]))
