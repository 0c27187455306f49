"""A shader node's output as Cycles works it out and as our program does, over a grid of points.

Cycles shows the output as the colour of a world, seen all round by a panorama camera, or as the
emission of an object, one sample a pixel through its centre and without any clamp, so that a pixel
is the very number that the node has there. What the points are (position, normal, ...) is rendered
by Cycles in the same way and handed to core.Program.
"""

import tempfile
from pathlib import Path

import bpy
import komorebi_core as core
import numpy as np
import support
from komorebi import reporting
from komorebi.export.shader import Compiler, Ray

SIZE = (48, 24)
MOST = 1e-4  # mean of absolute differences, in parts of the range


class Reports:
    """An engine that keeps what is reported."""

    is_preview = False

    def __init__(self):
        self.sentences = []

    def report(self, _kinds, sentence):
        self.sentences.append(sentence)


class Stage:
    """An empty tree of the world, or of a material on `surface` (an object), and what looks at it."""

    def __init__(self, surface=None):
        scene = bpy.context.scene
        for thing in list(bpy.data.objects):
            if thing not in (scene.camera, surface):
                bpy.data.objects.remove(thing)
        support.small(scene, "CYCLES", SIZE)
        cycles = scene.cycles
        cycles.samples, cycles.filter_width, cycles.pixel_filter_type = 1, 0.01, "BLACKMAN_HARRIS"
        cycles.use_adaptive_sampling = cycles.use_denoising = False
        cycles.sample_clamp_direct = cycles.max_bounces = 0
        scene.render.film_transparent = surface is not None
        if surface is None:
            camera = scene.camera.data
            camera.type = "PANO"
            own = camera if hasattr(camera, "panorama_type") else camera.cycles
            own.panorama_type = "EQUIRECTANGULAR"
            scene.camera.matrix_world.identity()
            owner = scene.world
            owner.cycles.sampling_method = "NONE"
        else:
            owner = bpy.data.materials.new("Under test")
            surface.data.materials.clear()
            surface.data.materials.append(owner)
            scene.world.use_nodes = True
            scene.world.node_tree.nodes.clear()
        owner.use_nodes = True
        self.scene, self.tree, self.is_world = scene, owner.node_tree, surface is None
        self.surface, self.seen = surface, slice(None)
        self.warnings = []
        self._points = None
        self.clear()

    def clear(self):
        nodes = self.tree.nodes
        nodes.clear()
        shader = nodes.new("ShaderNodeBackground" if self.is_world else "ShaderNodeEmission")
        output = nodes.new("ShaderNodeOutput" + ("World" if self.is_world else "Material"))
        self.link(shader.outputs[0], output.inputs["Surface"])
        self.sink = shader.inputs["Color"]

    # Building trees.

    def new(self, kind, **properties):
        node = self.tree.nodes.new("ShaderNode" + kind)
        for name, value in properties.items():
            setattr(node, name, value)
        return node

    def link(self, source, target):
        self.tree.links.new(source, target)

    def feed(self, node, *sources, into=None):
        """Links sockets to, or sets numbers of, the inputs that are enabled (or those numbered)."""
        sockets = [s for s in node.inputs if s.enabled] if into is None else into
        for socket, source in zip(sockets, sources, strict=False):
            if source is None:
                continue
            if isinstance(source, bpy.types.NodeSocket):
                self.link(source, socket)
            else:
                socket.default_value = source
        return next(s for s in node.outputs if s.enabled)

    def place(self):
        """The point's coordinates as a vector from −1 to 1."""
        return self.new("NewGeometry").outputs["Position"]

    def vector(self, scale=(1, 1, 1), offset=(0, 0, 0), turn=0):
        """place() · scale + offset, its components moved round by `turn`."""
        parts = self.feed_parts(self.place())
        parts = parts[turn:] + parts[:turn]
        combine = self.new("CombineXYZ")
        for part, socket, s, o in zip(parts, combine.inputs, scale, offset, strict=True):
            self.link(self.number(part, s, o), socket)
        return combine.outputs[0]

    def feed_parts(self, vector):
        separate = self.new("SeparateXYZ")
        self.link(vector, separate.inputs[0])
        return list(separate.outputs)

    def number(self, source, scale=1.0, offset=0.0):
        """source · scale + offset; `source` may say which coordinate of place()."""
        if isinstance(source, int):
            source = self.feed_parts(self.place())[source]
        math = self.new("Math", operation="MULTIPLY_ADD")
        return self.feed(math, source, scale, offset)

    # What comes out.

    def cycles(self, socket):
        """[points, 3] as Cycles has it."""
        self.link(socket, self.sink)
        self.scene.render.engine = "CYCLES"
        with tempfile.TemporaryDirectory() as folder:
            picture = support.render(Path(folder), scene=self.scene)
        pixels = picture.reshape(-1, picture.shape[-1])
        if not self.is_world and self._points is None:
            self.seen = pixels[:, 3] == 1.0
        return pixels[self.seen, :3].copy()

    def points(self):
        """Inputs and attributes of all points, by name."""
        if self._points is None:
            geometry = self.new("NewGeometry")
            show = {name: self.cycles(geometry.outputs[output]) for name, output in (
                ("position", "Position"), ("normal", "Normal"), ("true_normal", "True Normal"),
                ("incoming", "Incoming"), ("parametric", "Parametric"))}  # fmt: skip
            show["backfacing"] = self.cycles(geometry.outputs["Backfacing"])[:, :1].copy()
            coordinate = self.new("TexCoord")
            for name, output in (("object_point", "Object"), ("object_normal", "Normal"),
                                 ("camera", "Camera"), ("window", "Window")):  # fmt: skip
                show[name] = self.cycles(coordinate.outputs[output])
            attributes = {}
            if not self.is_world:
                for name, output in (("generated", "Generated"), ("uv:", "UV")):
                    attributes[name] = with_alpha(self.cycles(coordinate.outputs[output]))
                show |= self._of_object(len(show["position"]))
            self._points = show, attributes
        return self._points

    def _of_object(self, count):
        """What is the same all over the object, of Blender's own."""
        thing = self.surface
        matrix = np.array(thing.matrix_world, np.float32)
        rows = {f"object_{axis}": matrix[:3, k] for k, axis in enumerate("xyz")}
        rows |= {"object_location": matrix[:3, 3], "object_color": thing.color[:3],
                 "object_alpha": thing.color[3:], "object_index": [thing.pass_index],
                 "material_index": [thing.active_material.pass_index]}  # fmt: skip
        return {
            name: np.tile(np.asarray(row, np.float32), (count, 1)) for name, row in rows.items()
        }

    def camera_from_world(self):
        """As Cycles has the camera's space: right, up and depth; a panorama's: depth, left and up."""
        axes = np.diag([1, 1, -1, 1])
        if self.is_world:
            axes = np.array([[0, 0, -1, 0], [-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
        return axes @ np.array(self.scene.camera.matrix_world.inverted())

    def ours(self, socket, ray=None):
        """[points, 3] as our program has it."""
        inputs, attributes = self.points()
        self.link(socket, self.sink)
        reporting.begin()
        reports = Reports()
        compiler = Compiler(reports, "Under test", ray or Ray(), is_world=self.is_world)
        compiler.camera_from_world = self.camera_from_world()
        outputs = compiler.value(self.sink)
        self.warnings = reports.sentences
        program = core.Program("Under test", compiler.builder.ops, list(outputs))
        return program.evaluate(len(inputs["position"]), inputs, attributes)

    def differ(self, socket):
        """Mean of absolute differences in parts of Cycles' range; what is not finite counts as 0,
        as in Cycles' film."""
        self.points()
        theirs, ours = self.cycles(socket), self.ours(socket)
        ours = np.where(np.isfinite(ours).all(axis=1, keepdims=True), ours, 0.0)
        extent = max(float(np.ptp(theirs)), 0.1)
        return float(np.abs(theirs - ours).mean()) / extent, theirs, ours


def with_alpha(rgb):
    return np.column_stack([rgb, np.ones(len(rgb))]).astype(np.float32)


def compare(stage, build, name="", most=MOST, warned=0):
    """Asserts that what build(stage), an output socket, gives is the same in both."""
    stage.points()
    stage.clear()
    difference, theirs, ours = stage.differ(build(stage))
    worst = int(np.abs(theirs - ours).sum(axis=1).argmax())
    print(f"[node] {name}: {difference:.2e}", flush=True)
    assert difference <= most, (
        f"{name}: mean difference {difference:.5f} of the range; at {worst} Cycles has "
        f"{theirs[worst]}, we have {ours[worst]}"
    )
    assert len(stage.warnings) == warned, (name, stage.warnings)
    return theirs
