#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <bit>

#include "bvh/choose_builder.h"
#include "io/light_map.h"
#include "python/arrays.h"
#include "python/attribute_input.h"
#include "python/bind.h"
#include "python/camera_input.h"
#include "render/content_hash.h"
#include "render/scene.h"

namespace komorebi::python {
namespace {

std::shared_ptr<Mesh> make_mesh(const std::string& name, const py::object& positions,
                                const py::object& corner_verts, const py::object& face_offsets,
                                const py::object& tri2corner, const py::object& tri2face,
                                const py::object& corner_normals, const py::object& smooth_faces,
                                const py::object& face_materials, const py::object& vertex_normals,
                                const py::object& corner_uvs, const std::string& builder,
                                unsigned threads, const std::shared_ptr<Cancel>& cancel,
                                const std::shared_ptr<Mesh>& same_geometry,
                                const py::object& motion_positions,
                                const py::object& motion_normals, const py::object& step_positions,
                                const py::object& attributes) {
  const std::string mesh = "mesh \"" + name + "\": ";
  MeshInput input;
  input.name = name;
  input.vtx2xyz = view<float>(positions, mesh + "positions", {-1, 3});
  input.corner2vtx = view<std::int32_t>(corner_verts, mesh + "corner_verts", {-1});
  input.face_offsets = view<std::int32_t>(face_offsets, mesh + "face_offsets", {-1});
  input.tri2corner = optional_view<std::int32_t>(tri2corner, mesh + "tri2corner", {-1, 3});
  input.tri2face = optional_view<std::int32_t>(tri2face, mesh + "tri2face", {-1});
  input.corner2normal = optional_view<float>(corner_normals, mesh + "corner_normals", {-1, 3});
  input.vtx2normal = optional_view<float>(vertex_normals, mesh + "vertex_normals", {-1, 3});
  const auto smooth = optional_view<bool>(smooth_faces, mesh + "smooth_faces", {-1});
  input.face2smooth = {reinterpret_cast<const std::uint8_t*>(smooth.data()), smooth.size()};
  input.face2material = optional_view<std::int32_t>(face_materials, mesh + "face_materials", {-1});
  input.corner2uv = optional_view<float>(corner_uvs, mesh + "corner_uvs", {-1, 2});
  const auto vertices = static_cast<py::ssize_t>(input.vtx2xyz.size() / 3);
  const auto normals =
      static_cast<py::ssize_t>(std::max(input.vtx2normal.size(), input.corner2normal.size()) / 3);
  input.motion_positions =
      optional_view<float>(motion_positions, mesh + "motion_positions", {-1, vertices, 3});
  input.motion_normals =
      optional_view<float>(motion_normals, mesh + "motion_normals", {-1, normals, 3});
  input.step_positions =
      optional_view<float>(step_positions, mesh + "step_positions", {2, vertices, 3});
  input.attributes = attributes_of(attributes, mesh);
  const Builder kind = builder_from_name(builder);
  const py::gil_scoped_release release;
  // Python has no const; nothing that is bound below changes a mesh.
  return std::const_pointer_cast<Mesh>(
      Mesh::build(input, kind, *build_pool(threads), cancel_or_never(cancel), same_geometry.get()));
}

py::array_t<std::int32_t> mesh_tri2corner(const Mesh& mesh) {
  const auto corners = mesh.tri2corner();
  py::array_t<std::int32_t> out({static_cast<py::ssize_t>(corners.size() / 3), py::ssize_t{3}});
  std::copy(corners.begin(), corners.end(), out.mutable_data());
  return out;
}

py::bytes tags_of(const py::array& array, unsigned threads) {
  if (!(array.flags() & py::array::c_style)) {
    throw std::invalid_argument("content_tags needs an array that is contiguous in C order");
  }
  const std::span data(static_cast<const std::byte*>(array.data()),
                       static_cast<std::size_t>(array.nbytes()));
  std::vector<std::uint64_t> tags;
  {
    const py::gil_scoped_release release;
    tags = content_tags(data, *build_pool(threads));
  }
  return {reinterpret_cast<const char*>(tags.data()), tags.size() * sizeof(tags[0])};
}

void add_instances(Scene& scene, std::uint32_t mesh, const py::array& matrices,
                   const py::object& object_index, const py::object& mask, const py::object& flags,
                   const py::object& material_slots, const std::string& name,
                   const py::object& motion) {
  const std::string what = "instances of \"" + name + "\": ";
  const py::ssize_t n = matrices.ndim() > 0 ? matrices.shape(0) : 0;
  const auto objects = view<std::uint32_t>(object_index, what + "object_index", {n});
  const auto masks = optional_view<std::uint32_t>(mask, what + "mask", {n});
  const auto flag_values = optional_view<std::uint32_t>(flags, what + "flags", {n});
  const auto slots = optional_view<std::uint32_t>(material_slots, what + "material_slots", {n});
  std::vector<InstanceInput> instances(static_cast<std::size_t>(n));
  const auto fill = [&](const auto& values) {
    for (std::size_t i = 0; i < instances.size(); ++i) {
      instances[i] = {mesh,
                      matrix4(&values[16 * i]),
                      objects[i],
                      masks.empty() ? kMaskAll : masks[i],
                      flag_values.empty() ? 0u : flag_values[i],
                      slots.empty() ? 0u : slots[i]};
    }
  };
  if (py::isinstance<py::array_t<float>>(matrices)) {
    fill(view<float>(matrices, what + "matrices", {-1, 4, 4}));
  } else {
    fill(view<double>(matrices, what + "matrices", {-1, 4, 4}));
  }
  std::vector<Mat4d> poses;
  if (!motion.is_none()) {
    const auto values = view<double>(motion, what + "motion", {n, -1, 4, 4});
    for (std::size_t i = 0; i < values.size(); i += 16) poses.push_back(matrix4(&values[i]));
  }
  const py::gil_scoped_release release;
  if (motion.is_none()) {
    scene.add_instances(instances, name);
  } else {
    scene.add_moving_instances(instances, poses, name);
  }
}

std::shared_ptr<CameraDesc> make_camera_desc(const std::string& kind, const py::object& matrix,
                                             double clip_start, double clip_end,
                                             std::uint32_t width, std::uint32_t height,
                                             const py::object& lens, const py::object& panorama,
                                             const py::object& stereo, const py::object& shutter,
                                             const py::object& motion) {
  auto camera = std::make_shared<CameraDesc>(
      camera_input(kind, matrix, lens, panorama, stereo, shutter, motion));
  camera->clip_start = clip_start;
  camera->clip_end = clip_end;
  camera->width = width;
  camera->height = height;
  return camera;
}

void set_camera(Scene& scene, const std::string& kind, const py::object& matrix, double clip_start,
                double clip_end, std::uint32_t width, std::uint32_t height, const py::object& lens,
                const py::object& panorama, const py::object& stereo, const py::object& shutter,
                const py::object& motion) {
  scene.set_camera(*make_camera_desc(kind, matrix, clip_start, clip_end, width, height, lens,
                                     panorama, stereo, shutter, motion));
}

void set_world_environment(Scene& scene, std::shared_ptr<const Environment> environment,
                           double strength, const py::object& texture_from_world) {
  Mat3d rotation(1.0);
  if (!texture_from_world.is_none()) {
    const auto rows = view<double>(texture_from_world, "texture_from_world", {3, 3});
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) rotation[c][r] = rows[static_cast<std::size_t>(3 * r + c)];
    }
  }
  scene.set_world_environment(std::move(environment), strength, rotation);
}

/// What shader AOVs say, as a program; null where nothing is given.
std::shared_ptr<const Program> values_program(const py::handle& given, std::uint32_t count) {
  if (given.is_none()) return nullptr;
  auto program = given.cast<std::shared_ptr<Program>>();
  if (program->output_count() != count) {
    throw std::invalid_argument(program->name() + ": a program of values has as many outputs as " +
                                "material_values has columns");
  }
  return program;
}

void set_tables(Scene& scene, const py::object& object_pass_index, const py::object& object_mattes,
                const py::object& object_terminators, const py::object& material_pass_index,
                const py::object& material_mattes, const py::object& slot_begin,
                const py::object& slots, const py::object& material_values,
                const py::object& object_colors, const py::object& value_programs,
                const py::object& world_values) {
  const auto object_index = view<float>(object_pass_index, "object_pass_index", {-1});
  const auto objects = static_cast<py::ssize_t>(object_index.size());
  const auto object_ids = view<float>(object_mattes, "object_mattes", {objects, 2});
  const auto terminator = view<float>(object_terminators, "object_terminators", {objects, 2});
  const auto material_index = view<float>(material_pass_index, "material_pass_index", {-1});
  const auto materials = static_cast<py::ssize_t>(material_index.size());
  const auto material_ids = view<float>(material_mattes, "material_mattes", {materials});
  const auto colors = optional_view<float>(object_colors, "object_colors", {objects, 4});
  const auto begin = view<std::uint32_t>(slot_begin, "slot_begin", {-1});
  const auto entries = view<std::uint32_t>(slots, "slots", {-1});
  SceneTables tables;
  for (std::size_t i = 0; i < object_index.size(); ++i) {
    tables.objects.push_back({object_index[i], std::bit_cast<std::uint32_t>(object_ids[2 * i]),
                              std::bit_cast<std::uint32_t>(object_ids[2 * i + 1]),
                              terminator[2 * i], 1.0f / (1.0f - 0.5f * terminator[2 * i + 1])});
    if (colors.empty()) continue;
    tables.objects[i].color = Vec3(colors[4 * i], colors[4 * i + 1], colors[4 * i + 2]);
    tables.objects[i].alpha = colors[4 * i + 3];
  }
  for (std::size_t i = 0; i < material_index.size(); ++i) {
    tables.materials.push_back({material_index[i], std::bit_cast<std::uint32_t>(material_ids[i])});
  }
  const auto values = optional_view<float>(material_values, "material_values", {materials, -1});
  tables.values.assign(values.begin(), values.end());
  if (materials > 0) {
    tables.value_count = static_cast<std::uint32_t>(values.size() / material_index.size());
  }
  if (!value_programs.is_none()) {
    for (const py::handle& item : value_programs.cast<py::list>()) {
      tables.value_programs.push_back(values_program(item, tables.value_count));
    }
    if (tables.value_programs.size() != material_index.size()) {
      throw std::invalid_argument("value_programs: as many as materials");
    }
  }
  tables.world_values = values_program(world_values, tables.value_count);
  tables.slot_begin.assign(begin.begin(), begin.end());
  tables.slots.assign(entries.begin(), entries.end());
  scene.set_tables(std::move(tables));
}

void set_surfaces(Scene& scene, const py::list& surfaces, const py::object& instance_random) {
  std::vector<Material> materials;
  for (const py::handle& item : surfaces) {
    const auto parts = item.cast<py::tuple>();
    Material material;
    material.camera = parts[0].cast<SurfaceProgram>();
    if (!parts[1].is_none()) material.bounce = parts[1].cast<SurfaceProgram>();
    if (!parts[2].is_none()) material.clear = parts[2].cast<std::shared_ptr<Program>>();
    if (material.clear && material.clear->output_count() != 3) {
      throw std::invalid_argument(material.clear->name() + ": a transparency has three outputs");
    }
    materials.push_back(std::move(material));
  }
  const auto random = optional_view<float>(instance_random, "instance_random",
                                           {static_cast<py::ssize_t>(scene.instance_count())});
  scene.set_surfaces(std::move(materials), {random.begin(), random.end()});
}

void commit(Scene& scene, unsigned threads, const std::shared_ptr<Cancel>& cancel,
            bool keep_inputs) {
  const py::gil_scoped_release release;
  scene.commit(*build_pool(threads), cancel_or_never(cancel), keep_inputs);
}

void bind_mesh(py::module_& module) {
  py::class_<Mesh, std::shared_ptr<Mesh>> mesh(
      module, "Mesh",
      "A triangle mesh, curves or points with their tree; immutable, shared by as many scenes as "
      "hold it.");
  bind_round(mesh);
  bind_attributes(mesh);
  mesh.def(py::init(&make_mesh),
           R"(Copies a polygon mesh into the tracer's layout and builds its tree; releases the GIL.

name: for messages. positions: float32 [V, 3], object space, metres. corner_verts: int32 [C].
face_offsets: int32 [F + 1], first corner of each face. tri2corner int32 [T, 3] and tri2face
int32 [T]: Blender's loop triangles; None if every face has three or four corners.
corner_normals: float32 [C, 3], or vertex_normals: float32 [V, 3], unit; a row that is not finite
counts as none, and without both every face is flat. smooth_faces: bool [F], None if all are
smooth. face_materials: int32 [F]. corner_uvs: float32 [C, 2], for the UV pass. builder: LINEAR, SAH, PRINCIPAL_AXIS or LIST.
same_geometry: a mesh made from the same positions, motion_positions, corners and triangles, whose
tree is shared then. motion_positions: float32 [2k, V, 3], positions at the other times of the
shutter in their order; all with `positions` in the middle are at even times from its opening to its
closing. motion_normals: float32 [2k, C or V, 3] likewise; None if normals do not change.
step_positions: float32 [2, V, 3], positions a step of time before and after, which the Vector pass
of a shutter that stays shut compares; the mesh itself stands still. attributes: {name: (domain,
float32 [rows, 1 to 4])}, domain POINT, CORNER or FACE with a row a vertex, corner or face; what is
not finite counts as 0 (see warnings).
Raises ValueError naming the mesh and how many entries are wrong, Cancelled.)",
           py::arg("name"), py::arg("positions"), py::arg("corner_verts"), py::arg("face_offsets"),
           py::kw_only(), py::arg("tri2corner") = py::none(), py::arg("tri2face") = py::none(),
           py::arg("corner_normals") = py::none(), py::arg("smooth_faces") = py::none(),
           py::arg("face_materials") = py::none(), py::arg("vertex_normals") = py::none(),
           py::arg("corner_uvs") = py::none(), py::arg("builder") = "LINEAR",
           py::arg("threads") = 0, py::arg("cancel") = std::shared_ptr<Cancel>(),
           py::arg("same_geometry") = std::shared_ptr<Mesh>(),
           py::arg("motion_positions") = py::none(), py::arg("motion_normals") = py::none(),
           py::arg("step_positions") = py::none(), py::arg("attributes") = py::none())
      .def(
          "rebuilt",
          [](const Mesh& old, const std::string& builder, unsigned threads,
             const std::shared_ptr<Cancel>& cancel) {
            const Builder kind = builder_from_name(builder);
            const py::gil_scoped_release release;
            return std::const_pointer_cast<Mesh>(
                old.rebuilt(kind, *build_pool(threads), cancel_or_never(cancel)));
          },
          py::arg("builder"), py::arg("threads") = 0, py::arg("cancel") = std::shared_ptr<Cancel>(),
          "The same mesh with a tree by another builder. Raises Cancelled.")
      .def_property_readonly("name", &Mesh::name)
      .def_property_readonly("deforms", &Mesh::deforms)
      .def_property_readonly("triangle_count", &Mesh::triangle_count)
      .def_property_readonly("vertex_count", &Mesh::vertex_count)
      .def_property_readonly("degenerate_count", &Mesh::degenerate_count)
      .def_property_readonly("byte_count", &Mesh::byte_count)
      .def_property_readonly("node_count", &Mesh::node_count)
      .def_property_readonly("depth", &Mesh::depth)
      .def_property_readonly("primitive_count", &Mesh::primitive_count)
      .def("tri2corner", &mesh_tri2corner, "Corners of each triangle, int32 [T, 3].");
}

}  // namespace

void bind_scene(py::module_& module) {
  module.def(
      "choose_builder",
      [](std::size_t triangles, double rays) {
        return builder_name(choose_builder(triangles, rays));
      },
      py::arg("triangles"), py::arg("expected_rays"),
      "The builder, LINEAR or SAH, with which build and rays together take the least time.");
  py::class_<CameraDesc, std::shared_ptr<CameraDesc>>(
      module, "Camera", "A camera that a Session takes in place of its scene's.")
      .def(py::init(&make_camera_desc), py::arg("kind"), py::arg("matrix"), py::arg("clip_start"),
           py::arg("clip_end"), py::arg("width"), py::arg("height"), py::kw_only(),
           py::arg("lens") = py::none(), py::arg("panorama") = py::none(),
           py::arg("stereo") = py::none(), py::arg("shutter") = py::none(),
           py::arg("motion") = py::none(), "As Scene.set_camera.");
  module.def("content_tags", &tags_of, py::arg("array"), py::arg("threads") = 0,
             "32 bytes for each 4096 of the array's, to be hashed on: two different blocks share "
             "them with probability 2^-128. Of use within this process alone.");
  bind_mesh(module);
  bind_environment(module);
  py::class_<Scene, std::shared_ptr<Scene>> made(
      module, "Scene", "Meshes, instances, world, lamps and camera: filled, then committed once.");
  bind_lamps(made);
  made.def(py::init<>())
      .def(
          "add_mesh",
          [](Scene& scene, std::shared_ptr<Mesh> mesh) { return scene.add_mesh(std::move(mesh)); },
          py::arg("mesh"), "Returns the mesh's index in this scene.")
      .def("add_instances", &add_instances, py::arg("mesh"), py::arg("matrices"),
           py::arg("object_index"), py::kw_only(), py::arg("mask") = py::none(),
           py::arg("flags") = py::none(), py::arg("material_slots") = py::none(),
           py::arg("name") = "", py::arg("motion") = py::none(),
           "matrices: world from object, float64 or float32 [N, 4, 4], M @ p; object_index, mask, "
           "flags, material_slots (which list of set_tables): uint32 [N]. motion: the same at an "
           "odd number of even times from the opening of the shutter to the closing, float64 "
           "[N, 2k + 1, 4, 4], of which matrices are the middle ones exactly.")
      .def(
          "set_tables", &set_tables, py::kw_only(), py::arg("object_pass_index"),
          py::arg("object_mattes"), py::arg("object_terminators"), py::arg("material_pass_index"),
          py::arg("material_mattes"), py::arg("slot_begin"), py::arg("slots"),
          py::arg("material_values") = py::none(), py::arg("object_colors") = py::none(),
          py::arg("value_programs") = py::none(), py::arg("world_values") = py::none(),
          "What passes tell of objects and materials. Pass indices and Cryptomatte ids: float32 "
          "[N], object_mattes [N, 2] of object and asset. object_terminators: float32 [N, 2], "
          "Blender's shadow_terminator_geometry_offset and the shading one, 0 to 1. List l of "
          "material slots is "
          "slots[slot_begin[l]:slot_begin[l + 1]], indices of materials; uint32 both. "
          "material_values: float32 [N, K], what holds all over a material; the pass \"Material "
          "Value f n\" shows n (1 to 4) of them from number f on. object_colors: float32 [N, 4], "
          "Blender's Object.color, for nodes that ask for it. value_programs: a list of N, None or "
          "the Program whose K outputs are what varies over a material; world_values: likewise "
          "that of the world, where there is nothing else.")
      .def("set_surfaces", &set_surfaces, py::arg("surfaces"),
           py::arg("instance_random") = py::none(),
           "Of each material of set_tables (SurfaceProgram to camera rays, to rays that bounce "
           "light or None if it is the same, Program of the transparency to light rays or None if "
           "it is opaque). instance_random: float32, from 0 to 1 for each instance.")
      .def(
          "set_world_color",
          [](Scene& scene, const std::array<float, 3>& c) {
            scene.set_world_color(Vec3(c[0], c[1], c[2]));
          },
          py::arg("rgb"), "Uniform radiance, strength included, linear Rec. 709.")
      .def("set_world_environment", &set_world_environment, py::arg("environment"),
           py::arg("strength") = 1.0, py::arg("texture_from_world") = py::none(),
           "texture_from_world: rotation, float64 [3, 3].")
      .def(
          "set_world_program",
          [](Scene& scene, std::shared_ptr<Program> program, float max_radiance) {
            scene.set_world_program(std::move(program), max_radiance);
          },
          py::arg("program"), py::arg("max_radiance") = 0.0f,
          "What camera rays see instead: three outputs, radiance. max_radiance: a bound of what is "
          "too small to be found, such as a sun's disc.")
      .def("set_camera", &set_camera, py::arg("kind"), py::arg("matrix"), py::arg("clip_start"),
           py::arg("clip_end"), py::arg("width"), py::arg("height"), py::kw_only(),
           py::arg("lens") = py::none(), py::arg("panorama") = py::none(),
           py::arg("stereo") = py::none(), py::arg("shutter") = py::none(),
           py::arg("motion") = py::none(),
           "kind: PERSPECTIVE, ORTHOGRAPHIC or PANORAMA. matrix: projection @ view (clip from "
           "world), of a panorama world from camera, float64 [4, 4]. Clip distances in metres, "
           "width and height of the full frame in pixels. lens, panorama, stereo: dicts of numbers "
           "by the names in native/render/camera_fields.h; panorama[\"kind\"] is Blender's "
           "panorama_type. shutter: dict of curve, float32 [N], weights at even times from the "
           "opening to the closing (uniform without), and rolling_duration for a rolling shutter; "
           "or still=True: it stays shut, rays see the poses at rest, and those of instances and "
           "camera in time are what the pass Vector compares. motion: dict of matrices, world from "
           "camera at an odd number of even times, the middle one at rest, float64 [2k + 1, 4, 4], "
           "and zoom_open and zoom_close: tan of half a perspective's angle over that at rest.")
      .def("set_eye", &Scene::set_eye, py::arg("camera"),
           "Positions are the most exact at this Camera's eye.")
      .def("is_far_from_origin", &Scene::is_far_from_origin, py::arg("camera"))
      .def("commit", &commit, py::arg("threads") = 0, py::arg("cancel") = std::shared_ptr<Cancel>(),
           py::arg("keep_inputs") = true,
           "Builds the tree over instances. keep_inputs: for dump(), 152 bytes an instance.")
      .def_property_readonly("triangle_count", &Scene::triangle_count)
      .def_property_readonly("instance_count", &Scene::instance_count)
      .def_property_readonly("invisible_count", &Scene::invisible_count)
      .def_property_readonly("mesh_count", [](const Scene& s) { return s.meshes().size(); })
      .def_property_readonly("byte_count", &Scene::byte_count);
}

}  // namespace komorebi::python
