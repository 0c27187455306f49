"""What a file may hold that is no scene as one thinks of it: a right picture, or a sentence."""

import math

import bpy
import numpy as np
import support


def combined(folder, samples=8, size=(32, 24), name="picture"):
    scene = bpy.context.scene
    support.small(scene, size=size, samples=samples)
    scene.render.film_transparent = True
    picture = support.render(folder, name)
    assert np.isfinite(picture).all()
    return picture


def made(name, vertices, edges=(), faces=()):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, edges, faces)
    return support.add_object(name, mesh)


def without_cube():
    bpy.data.objects.remove(bpy.data.objects["Cube"])


def refused(folder, *words):
    """The file as it is now fails with exit code 1 and a sentence that holds these words."""
    done = support.blender_render(support.save(folder), folder / "refused_")
    assert done.code == 1, done
    errors = [line for line in done.output.splitlines() if support.ERROR in line]
    for word in words:
        assert any(word in line for line in errors), (word, done)
    assert not any(name.startswith("refused_") for name in support.pictures(folder)), done


def test_vertices_that_are_not_finite_name_the_object(folder):
    for value in (math.nan, math.inf):
        mesh = bpy.data.objects["Cube"].data
        places = np.zeros(24, np.float32)
        mesh.vertices.foreach_get("co", places)
        places[9] = value
        mesh.vertices.foreach_set("co", places)  # as it is; one by one Blender limits them
        assert not math.isfinite(mesh.vertices[3].co.x)
        refused(folder, 'mesh "Cube"', "1 vertex is not finite")


def test_a_matrix_that_is_not_finite_names_the_object(folder):
    bpy.data.objects["Cube"].location.x = math.nan
    refused(folder, "Cube", "not finite")


def test_faces_without_area_are_not_there(folder):
    without_cube()
    made("Line", [(0, 0, 0), (1, 0, 0), (2, 0, 0)], (), [(0, 1, 2)])
    made("Point", [(0, 0, 0)] * 3, (), [(0, 1, 2)])
    assert combined(folder).max() == 0.0


def test_loose_edges_and_vertices_are_not_there(folder):
    without_cube()
    made("Wire", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1), (1, 2)])
    made("Dust", [(0, 0, 0)])
    made("Nothing", [])
    assert combined(folder).max() == 0.0


def test_a_face_of_a_thousand_corners(folder):
    without_cube()
    ring = [(2 * math.cos(a), 2 * math.sin(a), 0.0) for a in np.linspace(0, math.tau, 1000, False)]
    made("Disk", ring, (), [tuple(range(1000))])
    picture = combined(folder)
    assert picture[12, 16, 3] == 1.0, "its middle is covered"
    assert abs(picture[12, 16, 0] - 1.0) < 1e-6, "and nothing hides the sky from it"


def test_no_objects_at_all(folder):
    for obj in list(bpy.data.objects):
        if obj.type != "CAMERA":
            bpy.data.objects.remove(obj)
    assert combined(folder).max() == 0.0


def test_a_collection_that_instances_itself(folder):
    """Blender's interface refuses it, a linked or damaged file may hold it: Blender cuts the loop."""
    collection = bpy.data.collections.new("Loop")
    empty = bpy.data.objects.new("Empty", None)
    empty.instance_type = "COLLECTION"
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(empty)
    try:
        empty.instance_collection = collection
    except (TypeError, RuntimeError, ValueError):
        raise support.Skip("this Blender does not let a collection hold its own instance") from None
    if empty.instance_collection is not collection:
        raise support.Skip("this Blender does not let a collection hold its own instance")
    done = support.blender_render(support.save(folder), folder / "loop_")
    assert done.code == 0, done


def test_a_missing_library_is_left_out(folder):
    lib = bpy.data.objects.new("Linked", bpy.data.meshes.new("Linked"))
    library = folder / "library.blend"
    bpy.data.libraries.write(str(library), {lib})
    with bpy.data.libraries.load(str(library), link=True) as (source, target):
        target.objects = list(source.objects)
    bpy.context.scene.collection.objects.link(target.objects[0])
    file = support.save(folder)
    library.unlink()
    done = support.blender_render(file, folder / "out_")
    assert done.code == 0, done
    assert len(support.pictures(folder)) == 1, done


def test_names_in_any_writing(folder):
    cube = bpy.data.objects["Cube"]
    cube.name, cube.data.name = "木漏れ日 🌿", "メッシュ"
    bpy.context.view_layer.name = "ビュー"
    bpy.context.view_layer.use_pass_cryptomatte_object = True
    channels, metadata = support.render_layers(folder)
    assert any(
        "木漏れ日 🌿" in value for key, value in metadata.items() if key.endswith("/manifest")
    )
    assert channels["ビュー.Combined.A"].max() == 1.0
    cube.data.vertices[0].co.x = math.nan
    refused(folder, "木漏れ日 🌿")


def test_far_away_and_at_any_scale(folder):
    """The same picture, but for noise of rounding: 10 km away, and a thousand times smaller or larger."""
    scene = bpy.context.scene
    cube, camera = bpy.data.objects["Cube"], scene.camera
    floor = made("Floor", [(-4, -4, -1), (4, -4, -1), (4, 4, -1), (-4, 4, -1)], (), [(0, 1, 2, 3)])
    reference = combined(folder, samples=32)
    start = [(thing, thing.matrix_world.copy()) for thing in (cube, camera, floor)]
    limits = (camera.data.clip_start, camera.data.clip_end)
    from mathutils import Matrix

    cases = [Matrix.Translation((1e4, -1e4, 1e4)), Matrix.Scale(1e-4, 4), Matrix.Scale(1e4, 4)]
    for i, change in enumerate(cases):
        for thing, matrix in start:
            thing.matrix_world = change @ matrix
        scale = change.to_scale()[0]
        camera.data.clip_start, camera.data.clip_end = limits[0] * scale, limits[1] * scale
        other = combined(folder, samples=32, name=f"case{i}")
        # Blender keeps places in floats: at 10 km a pixel's edge moves by its millimetre.
        assert np.abs(other - reference).mean() < 2e-3, (i, np.abs(other - reference).mean())


def test_a_camera_inside_a_wall(folder):
    """It sees the wall's inside, which sees nothing."""
    cube = bpy.data.objects["Cube"]
    cube.location = bpy.context.scene.camera.location
    picture = combined(folder)
    assert picture[..., 3].min() == 1.0
    assert picture[..., :3].max() == 0.0


def test_clip_start_beyond_clip_end(folder):
    camera = bpy.context.scene.camera.data
    camera.clip_end = 0.5
    camera.clip_start = 2.0
    if camera.clip_start <= camera.clip_end:
        raise support.Skip("this Blender keeps the two in order")
    refused(folder, "clip start")


def test_four_by_four_pixels(folder):
    assert combined(folder, size=(4, 4)).shape == (4, 4, 4)


def test_a_picture_that_cannot_fit_is_refused_before_the_work(folder):
    from komorebi import memory

    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 16384
    scene.render.resolution_percentage = 100
    free, memory.available_bytes = memory.available_bytes, lambda: 8 << 30
    try:
        with support.captured("driver.export_scene") as exports:
            try:
                bpy.ops.render.render()
                said = ""
            except RuntimeError as error:
                said = str(error)
    finally:
        memory.available_bytes = free
    assert "16384 × 16384 pixels with 1 passes need 12.0 GiB of memory, 8.0 are free" in said, said
    assert not exports
    assert memory.available_bytes() > 1 << 20
