"""View layers: their samples, override, holes and surfaces; and what they share."""

import bpy
import support


def two_layers():
    """The startup scene, small, with layers "A" and "B"."""
    scene = support.fresh_scene(size=(32, 24), samples=4)
    scene.view_layers[0].name = "A"
    scene.view_layers.new("B")
    return scene


def test_each_layer_has_its_own_samples(folder):
    scene = two_layers()
    scene.view_layers["B"].samples = 7
    _, metadata = support.render_layers(folder)
    assert metadata["komorebi.A.samples"] == "4"
    assert metadata["komorebi.B.samples"] == "7"
    assert metadata["komorebi.B.method"] == "AMBIENT_OCCLUSION"
    assert float(metadata["komorebi.B.render_seconds"]) >= 0.0
    scene.cycles.use_layer_samples = "BOUNDED"
    assert support.render_layers(folder)[1]["komorebi.B.samples"] == "4"
    scene.cycles.use_layer_samples = "IGNORE"
    scene.view_layers["B"].samples = 2
    assert support.render_layers(folder)[1]["komorebi.B.samples"] == "4"


def test_a_collection_is_a_hole_in_one_layer(folder):
    scene = two_layers()
    scene.render.film_transparent = True
    scene.view_layers["B"].layer_collection.children[0].holdout = True
    channels, _ = support.render_layers(folder)
    assert channels["A.Combined.A"].max() == 1.0
    assert channels["B.Combined.A"].max() == 0.0


def test_a_layer_without_surfaces_shows_the_sky_alone(folder):
    scene = two_layers()
    scene.view_layers["B"].use_solid = False
    scene.view_layers["B"].use_pass_z = True
    channels, _ = support.render_layers(folder)
    assert (channels["B.Depth.Z"] == 1e10).all()


def test_the_override_is_every_things_material(folder):
    scene = two_layers()
    for layer in scene.view_layers:
        layer.use_pass_material_index = True
    scene.objects["Cube"].material_slots[0].material.pass_index = 3
    other = bpy.data.materials.new("Other")
    other.pass_index = 9
    scene.view_layers["B"].material_override = other
    channels, _ = support.render_layers(folder)
    name = "Material Index.X" if bpy.app.version >= (5, 0, 0) else "IndexMA.X"
    assert channels[f"A.{name}"].max() == 3.0
    assert channels[f"B.{name}"].max() == 9.0


def test_layers_share_trees():
    from komorebi import cache

    two_layers()
    cache.clear()
    before = cache.misses
    bpy.ops.render.render()
    assert cache.misses - before == 1  # the cube


def test_passes_that_are_missing_are_named_once_and_black(folder):
    scene = two_layers()
    scene.view_layers["A"].use_pass_glossy_direct = True
    with support.warnings() as sentences:
        channels, _ = support.render_layers(folder)
    name = "Glossy Direct" if bpy.app.version >= (5, 0, 0) else "GlossDir"
    assert [s for s in sentences if name in s] == [
        f'view layer "A": pass "{name}" is not rendered yet, black'
    ]
    assert channels[f"A.{name}.R"].max() == 0.0


def test_a_closed_room_is_told():
    scene = support.fresh_scene(size=(16, 12), samples=2)
    # Blender 5.0 prints no line of statistics unless it is asked to: as the engine is given them.
    with support.captured("progress._decided") as told:
        bpy.ops.render.render()
        scene.objects["Cube"].scale = (20.0, 20.0, 20.0)
        bpy.ops.render.render()
    sentence = "Closed scene: nearly all occlusion rays hit, set AO Distance"
    assert [sentence in parts for _, parts in told] == [False, True]
