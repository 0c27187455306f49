#include "render/dump.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>

#include "bvh/choose_builder.h"
#include "io/array_file.h"
#include "render/dump_programs.h"

namespace komorebi {
namespace {

template <class T>
void put_rows(ArrayFile& file, const std::string& name, std::span<const T> values,
              std::uint64_t columns) {
  file.put<T>(name, values, {values.size() / columns, columns});
}

template <class T>
std::span<const T> span_of(const T* data, std::size_t size) {
  return data ? std::span<const T>(data, size) : std::span<const T>();
}

/// All sets but the middle one, of `size` numbers each.
std::vector<float> without_rest(std::span<const float> all, std::size_t size, std::size_t sets) {
  const auto before = all.first(sets / 2 * size), after = all.subspan((sets / 2 + 1) * size);
  std::vector<float> others(before.begin(), before.end());
  others.insert(others.end(), after.begin(), after.end());
  return others;
}

void put_steps(ArrayFile& file, const std::string& key, const Mesh& mesh, std::size_t count) {
  if (!mesh.step_positions()) return;
  file.put<float>(key + "step_positions", span_of(mesh.step_positions(), 6 * count), {2, count, 3});
}

/// Curves or points.
void put_round(ArrayFile& file, const std::string& key, const Mesh& mesh) {
  const RoundGeometry& round = *mesh.round();
  const bool are_curves = round.kind == PrimitiveKind::kCurve;
  file.put_text(key + "name", mesh.name());
  file.put<double>(key + "origin", span_of(glm::value_ptr(mesh.origin()), 3), {3});
  const std::size_t count = round.point_count(), sets = round.sets;
  put_rows<float>(file, key + (are_curves ? "keys" : "points"),
                  span_of(round.points.data() + sets / 2 * 4 * count, 4 * count), 4);
  if (sets > 1) {
    const std::vector<float> others = without_rest(round.points, 4 * count, sets);
    file.put<float>(key + "motion_points", others, {sets - 1, count, 4});
  }
  put_steps(file, key, mesh, count);
  put_attributes(file, key, mesh);
  if (!are_curves) return;
  const std::vector<std::int32_t> offsets = round.curve_offsets();
  file.put<std::int32_t>(key + "curve_offsets", offsets, {offsets.size()});
  file.put_value<std::uint32_t>(key + "shape", static_cast<std::uint32_t>(round.shape));
  file.put_value<std::uint32_t>(key + "subdivisions", round.subdivisions);
  const std::uint16_t* const slots = mesh.view().tri2material;
  if (slots == nullptr) return;
  std::vector<std::int32_t> curve2material;
  for (std::size_t c = 0, segment = 0; c + 1 < offsets.size(); ++c) {
    const auto keys = static_cast<std::size_t>(offsets[c + 1] - offsets[c]);
    curve2material.push_back(keys > 1 ? slots[segment] : 0);
    segment += keys > 0 ? keys - 1 : 0;
  }
  file.put<std::int32_t>(key + "curve2material", curve2material, {curve2material.size()});
}

void put_mesh(ArrayFile& file, const std::string& key, const Mesh& mesh) {
  if (mesh.round()) return put_round(file, key, mesh);
  const MeshView v = mesh.view();
  const std::size_t triangles = v.triangle_count;
  file.put_text(key + "name", mesh.name());
  file.put<double>(key + "origin", span_of(glm::value_ptr(mesh.origin()), 3), {3});
  const std::size_t coordinates = 3 * std::size_t{v.vertex_count}, sets = v.position_sets;
  const std::size_t rest = sets / 2;
  put_rows<float>(file, key + "vtx2xyz", span_of(v.vtx2xyz + rest * coordinates, coordinates), 3);
  if (sets > 1) {
    const std::vector<float> others =
        without_rest(span_of(v.vtx2xyz, sets * coordinates), coordinates, sets);
    file.put<float>(key + "motion_positions", others, {sets - 1, v.vertex_count, 3});
  }
  put_steps(file, key, mesh, v.vertex_count);
  put_rows<std::uint32_t>(file, key + "tri2vtx", span_of(v.tri2vtx, 3 * triangles), 3);
  if (v.normals) {
    const std::size_t normal_sets = v.normal_sets, size = 9 * triangles;
    std::vector<float> normals(size * normal_sets);
    for (std::size_t set = 0; set < normal_sets; ++set) {
      for (std::size_t k = 0; k < 3 * triangles; ++k) {
        const std::size_t row = set * v.normal_count + v.tri2normal[k];
        std::copy_n(v.normals + 3 * row, 3, &normals[set * size + 3 * k]);
      }
    }
    file.put<float>(key + "corner2normal",
                    std::span<const float>(normals).subspan(normal_sets / 2 * size, size),
                    {triangles, 3, 3});
    if (normal_sets > 1) {
      file.put<float>(key + "motion_corner2normal", without_rest(normals, size, normal_sets),
                      {normal_sets - 1, triangles, 3, 3});
    }
  }
  if (v.tri2smooth) {
    file.put<std::uint8_t>(key + "tri2smooth", span_of(v.tri2smooth, triangles), {triangles});
  }
  if (v.tri2material) {
    std::vector<std::int32_t> slots(v.tri2material, v.tri2material + triangles);
    file.put<std::int32_t>(key + "tri2material", slots, {triangles});
  }
  put_attributes(file, key, mesh);
}

/// Positions in object space from those of the mesh's own; exact, see MeshGeometry.
std::vector<float> get_positions(const ArrayFile& file, const std::string& name,
                                 const std::vector<double>& origin) {
  auto positions = file.get<float>(name);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions[i] = static_cast<float>(double{positions[i]} + origin[i % 3]);
  }
  return positions;
}

/// The same; none if there is no such array.
std::vector<float> get_any_positions(const ArrayFile& file, const std::string& name,
                                     const std::vector<double>& origin) {
  return file.has(name) ? get_positions(file, name, origin) : std::vector<float>();
}

/// Keys or points, taken apart; none if there is no such array.
struct DumpedPoints {
  std::vector<float> xyz, radius;

  DumpedPoints(const ArrayFile& file, const std::string& name, const std::vector<double>& origin) {
    if (!file.has(name)) return;
    const auto points = file.get<float>(name);
    for (std::size_t i = 0; i + 3 < points.size(); i += 4) {
      for (std::size_t c = 0; c < 3; ++c) {
        xyz.push_back(static_cast<float>(double{points[i + c]} + origin[c]));
      }
      radius.push_back(points[i + 3]);
    }
  }
};

std::shared_ptr<const Mesh> get_round(const ArrayFile& file, const std::string& key,
                                      ThreadPool& pool, const Cancel& cancel) {
  const bool are_curves = file.has(key + "keys");
  const auto origin = file.get<double>(key + "origin", 3);
  const DumpedPoints rest(file, key + (are_curves ? "keys" : "points"), origin);
  const DumpedPoints others(file, key + "motion_points", origin);
  const std::vector<float> steps = get_any_positions(file, key + "step_positions", origin);
  const RoundMotion motion{others.xyz, others.radius, steps};
  const DumpedAttributes attributes(file, key);
  constexpr Builder builder = Builder::kSah;  // as the add-on builds them
  const std::string name = file.get_text(key + "name");
  if (!are_curves) {
    PointsInput input{name, rest.xyz, rest.radius, motion};
    input.attributes = attributes.inputs();
    return Mesh::build(input, builder, pool, cancel);
  }
  const auto offsets = file.get<std::int32_t>(key + "curve_offsets");
  const auto shape = file.get_value<std::uint32_t>(key + "shape");
  if (shape > 2) throw std::runtime_error("the scene's curves are of an unknown shape");
  CurvesInput input;
  input.name = name;
  input.key2xyz = rest.xyz;
  input.key2radius = rest.radius;
  input.curve_offsets = offsets;
  input.shape = static_cast<CurveShape>(shape);
  input.subdivisions = file.get_value<std::uint32_t>(key + "subdivisions");
  input.motion = motion;
  input.attributes = attributes.inputs();
  std::vector<std::int32_t> materials;
  if (file.has(key + "curve2material")) materials = file.get<std::int32_t>(key + "curve2material");
  input.curve2material = materials;
  return Mesh::build(input, builder, pool, cancel);
}

/// Back through the same door as a host's meshes, so that a damaged file is refused as they are.
std::shared_ptr<const Mesh> get_mesh(const ArrayFile& file, const std::string& key,
                                     double expected_rays, ThreadPool& pool, const Cancel& cancel) {
  if (file.has(key + "keys") || file.has(key + "points")) {
    return get_round(file, key, pool, cancel);
  }
  const auto origin = file.get<double>(key + "origin", 3);
  const std::vector<float> vtx2xyz = get_positions(file, key + "vtx2xyz", origin);
  const auto tri2vtx = file.get<std::uint32_t>(key + "tri2vtx");
  const std::vector<std::int32_t> corner2vtx(tri2vtx.begin(), tri2vtx.end());
  std::vector<std::int32_t> face_offsets(tri2vtx.size() / 3 + 1);
  for (std::size_t f = 0; f < face_offsets.size(); ++f) {
    face_offsets[f] = static_cast<std::int32_t>(3 * f);
  }
  const std::vector<float> motion_positions =
      get_any_positions(file, key + "motion_positions", origin);
  const std::vector<float> step_positions = get_any_positions(file, key + "step_positions", origin);
  std::vector<float> motion_normals;
  if (file.has(key + "motion_corner2normal")) {
    motion_normals = file.get<float>(key + "motion_corner2normal");
  }
  std::vector<float> normals;
  std::vector<std::uint8_t> smooth;
  std::vector<std::int32_t> materials;
  if (file.has(key + "corner2normal")) normals = file.get<float>(key + "corner2normal");
  if (file.has(key + "tri2smooth")) smooth = file.get<std::uint8_t>(key + "tri2smooth");
  if (file.has(key + "tri2material")) materials = file.get<std::int32_t>(key + "tri2material");

  MeshInput input;
  input.name = file.get_text(key + "name");
  input.vtx2xyz = vtx2xyz;
  input.corner2vtx = corner2vtx;
  input.face_offsets = face_offsets;
  input.corner2normal = normals;
  input.motion_positions = motion_positions;
  input.motion_normals = motion_normals;
  input.step_positions = step_positions;
  input.face2smooth = smooth;
  input.face2material = materials;
  const DumpedAttributes attributes(file, key);
  input.attributes = attributes.inputs();
  return Mesh::build(input, choose_builder(face_offsets.size() - 1, expected_rays), pool, cancel);
}

void put_instances(ArrayFile& file, const std::vector<InstanceInput>& instances) {
  const std::size_t n = instances.size();
  std::vector<std::uint32_t> mesh(n), object(n), mask(n), flags(n), slots(n);
  std::vector<double> matrices(16 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const InstanceInput& instance = instances[i];
    mesh[i] = instance.mesh;
    object[i] = instance.object_index;
    mask[i] = instance.mask;
    flags[i] = instance.flags;
    slots[i] = instance.material_slots;
    std::copy_n(glm::value_ptr(instance.world_from_object), 16, &matrices[16 * i]);
  }
  file.put<std::uint32_t>("instance/mesh", mesh, {n});
  file.put<std::uint32_t>("instance/object_index", object, {n});
  file.put<std::uint32_t>("instance/mask", mask, {n});
  file.put<std::uint32_t>("instance/flags", flags, {n});
  file.put<std::uint32_t>("instance/material_slots", slots, {n});
  file.put<double>("instance/world_from_object", matrices, {n, 4, 4});
}

void put_poses(ArrayFile& file, const Scene& scene) {
  const auto& moving = scene.moving_inputs();
  if (moving.empty()) return;
  std::vector<std::uint32_t> instance, count;
  for (const auto& input : moving) {
    instance.push_back(input.instance);
    count.push_back(input.pose_count);
  }
  const std::size_t poses = scene.poses().size();
  file.put<std::uint32_t>("instance/motion/instance", instance, {moving.size()});
  file.put<std::uint32_t>("instance/motion/pose_count", count, {moving.size()});
  file.put<double>("instance/motion/poses", span_of(glm::value_ptr(scene.poses()[0]), 16 * poses),
                   {poses, 4, 4});
}

/// Those that stand still, and one by one those that move.
void add_instances(const ArrayFile& file, std::span<const InstanceInput> instances, Scene& scene) {
  const char* const name = "scene file";
  if (!file.has("instance/motion/instance")) return scene.add_instances(instances, name);
  const auto moving = file.get<std::uint32_t>("instance/motion/instance");
  const auto counts = file.get<std::uint32_t>("instance/motion/pose_count", moving.size());
  const auto numbers = file.get<double>("instance/motion/poses");
  std::size_t added = 0, read = 0;
  for (std::size_t m = 0; m < moving.size(); ++m) {
    const std::size_t at = moving[m], end = read + 16 * std::size_t{counts[m]};
    if (at < added || at >= instances.size() || end > numbers.size()) {
      throw std::runtime_error("the scene's moving instances do not fit its instances");
    }
    scene.add_instances(instances.subspan(added, at - added), name);
    std::vector<Mat4d> poses;
    for (; read < end; read += 16) poses.push_back(glm::make_mat4(&numbers[read]));
    scene.add_moving_instances(instances.subspan(at, 1), poses, name);
    added = at + 1;
  }
  scene.add_instances(instances.subspan(added), name);
}

void get_instances(const ArrayFile& file, Scene& scene) {
  const auto mesh = file.get<std::uint32_t>("instance/mesh");
  const std::size_t n = mesh.size();
  const auto object = file.get<std::uint32_t>("instance/object_index", n);
  const auto mask = file.get<std::uint32_t>("instance/mask", n);
  const auto flags = file.get<std::uint32_t>("instance/flags", n);
  const auto slots = file.get<std::uint32_t>("instance/material_slots", n);
  const auto matrices = file.get<double>("instance/world_from_object", 16 * n);
  std::vector<InstanceInput> instances(n);
  for (std::size_t i = 0; i < n; ++i) {
    instances[i] = {mesh[i], glm::make_mat4(&matrices[16 * i]), object[i], mask[i], flags[i],
                    slots[i]};
  }
  add_instances(file, instances, scene);
}

void put_world(ArrayFile& file, const Scene& scene) {
  const auto& environment = scene.world_environment();
  if (!environment) {
    file.put<float>("world/color", span_of(glm::value_ptr(scene.world_color()), 3), {3});
    return;
  }
  const std::uint64_t width = environment->width(), height = environment->height();
  file.put_text("world/name", environment->name());
  std::vector<float> texels;
  texels.reserve(3 * environment->map().texel_count());
  for (std::uint64_t i = 0; i < environment->map().texel_count(); ++i) {
    const Vec3 value = environment->map().texel(i);
    texels.insert(texels.end(), &value.x, &value.x + 3);
  }
  file.put<float>("world/texels", texels, {height, width, 3});
  file.put_value<double>("world/strength", scene.world_strength());
  file.put<double>("world/texture_from_world",
                   span_of(glm::value_ptr(scene.texture_from_world()), 9), {3, 3});
}

void get_world(const ArrayFile& file, Scene& scene) {
  if (file.has("world/color")) {
    scene.set_world_color(glm::make_vec3(file.get<float>("world/color", 3).data()));
    return;
  }
  const auto& shape = file.array("world/texels").shape;
  if (shape.size() != 3 || shape[2] != 3 || shape[0] > 1u << 20 || shape[1] > 1u << 20) {
    throw std::runtime_error("the scene's array \"world/texels\" has a wrong shape");
  }
  auto environment = std::make_shared<Environment>(
      file.get_text("world/name"), static_cast<std::uint32_t>(shape[1]),
      static_cast<std::uint32_t>(shape[0]), file.get<float>("world/texels"));
  scene.set_world_environment(
      std::move(environment), file.get_value<double>("world/strength"),
      glm::make_mat3(file.get<double>("world/texture_from_world", 9).data()));
}

}  // namespace

void write_dump(const std::string& path, const Scene& scene, const Settings& settings) {
  ArrayFile file;
  file.put_value<std::uint32_t>("mesh/count", static_cast<std::uint32_t>(scene.meshes().size()));
  for (std::size_t m = 0; m < scene.meshes().size(); ++m) {
    put_mesh(file, "mesh/" + std::to_string(m) + "/", *scene.meshes()[m]);
  }
  put_instances(file, scene.inputs());
  put_poses(file, scene);
  ProgramWriter programs(file);
  put_tables(file, scene, programs);
  put_world(file, scene);
  put_lamps(file, scene.lamp_inputs());
  put_camera(file, scene.camera_desc());
  put_settings(file, settings);
  file.write(path);
}

DumpedRender read_dump(const std::string& path, ThreadPool& pool, const Cancel& cancel) {
  const ArrayFile file = ArrayFile::read(path);
  DumpedRender dumped;
  dumped.scene = std::make_shared<Scene>();
  dumped.settings = get_settings(file);
  const CameraDesc camera = get_camera(file);
  dumped.scene->set_camera(camera);

  const Settings& settings = dumped.settings;
  const double expected_rays = double(camera.width) * double(camera.height) *
                               double(settings.samples) * (1.0 + resolved_light_samples(settings));
  const auto meshes = file.get_value<std::uint32_t>("mesh/count");
  for (std::uint32_t m = 0; m < meshes; ++m) {
    const std::string key = "mesh/" + std::to_string(m) + "/";
    dumped.scene->add_mesh(get_mesh(file, key, expected_rays, pool, cancel));
  }
  get_instances(file, *dumped.scene);
  ProgramReader programs(file, pool);
  get_tables(file, *dumped.scene, programs);
  get_world(file, *dumped.scene);
  get_lamps(file, *dumped.scene);
  return dumped;
}

}  // namespace komorebi
