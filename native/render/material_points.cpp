#include "render/material_points.h"

#include "core/attribute.h"
#include "core/warp.h"
#include "render/camera_axes.h"
#include "render/ray_cone.h"

namespace komorebi {
namespace {

/// The hit's instance at the ray's time, with what of it several inputs need.
struct Placed {
  InstanceView room;
  const InstanceView* instance;
  const MeshView* mesh;

  Placed(const RenderContext& context, const ShadeTask& task) {
    instance = &instance_at(context.scene, task.hit.instance, task.time, room);
    mesh = &context.scene.meshes[instance->mesh];
  }

  Vec3 object_point(const Vec3& world) const {
    return Vec3(Vec3d(instance->local_from_world * (world - instance->position)) +
                mesh->object_origin);
  }
  Vec3 object_normal(const Vec3& world) const {
    return detail::unit_or(glm::transpose(instance->world_from_local) * world, world);
  }
  Vec3d object_location() const {
    return Vec3d(instance->position) - Mat3d(instance->world_from_local) * mesh->object_origin;
  }
};

/// 1 where the ray meets the side that the triangle's normal, as Blender has it, points away from.
float backfacing(const Placed& placed, const ShadeTask& task) {
  if (is_round(placed.mesh->kind)) return 0.0f;
  const Corners at = detail::triangle_corners(*placed.mesh, task.hit.primitive, task.time);
  const Vec3 normal = glm::cross(at.corner[1] - at.corner[0], at.corner[2] - at.corner[0]);
  const Vec3 world = glm::transpose(placed.instance->local_from_world) * normal;
  return glm::dot(world, task.direction) > 0.0f ? 1.0f : 0.0f;
}

/// Along the surface, around the vertical axis through the middle of the object (Cycles' Tangent).
Vec3 tangent(const Placed& placed, const ShadeTask& task) {
  Vec4 generated(0.5f);
  if (const AttributeView* found = find_attribute(*placed.mesh, "generated")) {
    generated = attribute_at(*placed.mesh, *found, task.hit.primitive, task.hit.u, task.hit.v);
  }
  const Vec3 around(-(generated.y - 0.5f), generated.x - 0.5f, 0.0f);
  const Vec3 world = placed.instance->world_from_local * around;
  const Vec3 side = glm::cross(detail::unit_or(world, Vec3(0.0f)), task.point.normal);
  return glm::cross(task.point.normal, detail::unit_or(side, Vec3(0.0f)));
}

/// How the barycentrics of a hit change when its point moves so far in the triangle's plane, one
/// way and another.
void barycentric_change(const Placed& placed, const ShadeTask& task, const Vec3* const world[2],
                        Vec2* const change[2]) {
  *change[0] = *change[1] = Vec2(0.0f);
  if (is_round(placed.mesh->kind)) return;
  const Corners at = detail::triangle_corners(*placed.mesh, task.hit.primitive, task.time);
  const Vec3d ab(at.corner[1] - at.corner[0]), ac(at.corner[2] - at.corner[0]);
  const double bb = glm::dot(ab, ab), bc = glm::dot(ab, ac), cc = glm::dot(ac, ac);
  const double determinant = bb * cc - bc * bc;
  if (!(determinant > 0.0)) return;
  for (int k = 0; k < 2; ++k) {
    const Vec3d step(placed.instance->local_from_world * *world[k]);
    const double b = glm::dot(step, ab), c = glm::dot(step, ac);
    *change[k] = Vec2(static_cast<float>((b * cc - c * bc) / determinant),
                      static_cast<float>((c * bb - b * bc) / determinant));
  }
}

/// The way back from the world to the film of a camera without a panorama's projection: where a
/// point is seen, in pixels from the bottom left of the frame.
class FilmPlace {
 public:
  explicit FilmPlace(const CameraView& camera) : camera_(camera) {}

  Vec2 of(const Vec3& world) {
    if (!known_) {
      into_film_ = glm::inverse(Mat3d(camera_.per_x, camera_.per_y, camera_.direction));
      known_ = true;
    }
    const Vec3d at = into_film_ * (Vec3d(world) - camera_.origin);
    const double w = camera_.kind == CameraKind::kOrthographic ? 1.0 : at.z;
    if (camera_.kind == CameraKind::kPanorama || !(std::abs(w) > 0.0)) return Vec2(0.0f);
    return Vec2(static_cast<float>(at.x / w + camera_.film_center_x),
                static_cast<float>(at.y / w + camera_.film_center_y));
  }

 private:
  const CameraView& camera_;
  bool known_ = false;
  Mat3d into_film_{1.0};
};

/// How far the point moves in its surface when the ray's pixel moves by one to the right or up: of
/// a camera ray by the neighbouring pixel's ray; after a bounce in some direction of the surface,
/// as wide as a pixel would be so far away.
void differentials(const RenderContext& context, FilmPlace& film, const ShadeTask& task, Vec3& dx,
                   Vec3& dy) {
  const Vec3 normal = task.point.geometric_normal;
  if (task.vertex > 0 || context.camera.kind == CameraKind::kPanorama) {
    const double width = context.camera.kind == CameraKind::kPanorama
                             ? 2.0 * kPi / static_cast<double>(context.frame_width)
                             : std::sqrt(glm::dot(context.camera.per_x, context.camera.per_x));
    const Frame frame = make_frame(normal);
    const float radius = task.hit.t * static_cast<float>(width);
    dx = radius * frame.tangent;
    dy = radius * frame.bitangent;
    return;
  }
  const Vec2 middle = film.of(task.point.position);
  const auto meets = [&](const Vec2& at) {
    const Ray ray = camera_ray(context.camera, at, Vec2(0.5f), task.time);
    const float down = glm::dot(ray.direction, normal);
    if (!(down < -1e-4f)) return task.point.position;
    const float t = glm::dot(task.point.position - ray.origin, normal) / down;
    return ray.origin + t * ray.direction;
  };
  dx = meets(middle + Vec2(1.0f, 0.0f)) - task.point.position;
  dy = meets(middle + Vec2(0.0f, 1.0f)) - task.point.position;
}

}  // namespace

const ShadePoints& MaterialPoints::fill(const RenderContext& context, const Program& program,
                                        const ShadeTask* tasks, std::uint32_t count) {
  points_.count = count;
  for (std::size_t pair = 0; pair < kWays / 2; ++pair) {
    has_steps_[pair] = has_barycentric_steps_[pair] = false;
  }
  const auto put = [&](PointInput input, const auto& value_of) {
    if (!program.asks(input)) return;
    auto& columns = inputs_[static_cast<std::size_t>(input)];
    for (std::uint32_t i = 0; i < count; ++i) {
      const Vec3 value = value_of(tasks[i]);
      for (int c = 0; c < 3; ++c) columns[c][i] = value[c];
    }
    for (std::size_t c = 0; c < 3; ++c) {
      points_.input[static_cast<std::size_t>(input)][c] = columns[c];
    }
  };
  const auto put_float = [&](PointInput input, const auto& value_of) {
    put(input, [&](const ShadeTask& task) { return Vec3(value_of(task), 0.0f, 0.0f); });
  };
  const auto object = [&](const ShadeTask& task) {
    return context.tables->object(context.scene.instances[task.hit.instance].object_index);
  };
  put(PointInput::kPosition,
      [&](const ShadeTask& t) { return Vec3(Vec3d(t.point.position) + context.origin); });
  put(PointInput::kNormal, [](const ShadeTask& t) { return t.point.normal; });
  put(PointInput::kTrueNormal, [](const ShadeTask& t) { return t.point.geometric_normal; });
  put(PointInput::kIncoming, [](const ShadeTask& t) { return -t.direction; });
  put(PointInput::kObjectPoint,
      [&](const ShadeTask& t) { return Placed(context, t).object_point(t.point.position); });
  put(PointInput::kObjectNormal,
      [&](const ShadeTask& t) { return Placed(context, t).object_normal(t.point.normal); });
  put(PointInput::kCamera, [&](const ShadeTask& t) {
    return Vec3((Vec3d(t.point.position) - context.camera.origin) * camera_axes(context.camera));
  });
  FilmPlace film(context.camera);
  put(PointInput::kWindow, [&](const ShadeTask& t) {
    const Vec2 at = film.of(t.point.position);
    return Vec3(at.x / context.frame_width, at.y / context.frame_height, 0.0f);
  });
  put(PointInput::kParametric, [](const ShadeTask& t) { return Vec3(t.hit.u, t.hit.v, 0.0f); });
  put(PointInput::kTangent, [&](const ShadeTask& t) { return tangent(Placed(context, t), t); });
  put(PointInput::kObjectLocation, [&](const ShadeTask& t) {
    return Vec3(Placed(context, t).object_location() + context.origin);
  });
  put(PointInput::kObjectColor, [&](const ShadeTask& t) { return object(t).color; });
  put_float(PointInput::kObjectAlpha, [&](const ShadeTask& t) { return object(t).alpha; });
  put_float(PointInput::kBackfacing,
            [&](const ShadeTask& t) { return backfacing(Placed(context, t), t); });
  put_float(PointInput::kObjectIndex, [&](const ShadeTask& t) { return object(t).pass_index; });
  put_float(PointInput::kMaterialIndex,
            [&](const ShadeTask& t) { return context.tables->material(t.material).pass_index; });
  put_float(PointInput::kObjectRandom, [&](const ShadeTask& t) {
    const auto& random = context.tables->instance_random;
    return t.hit.instance < random.size() ? random[t.hit.instance] : 0.0f;
  });
  put_float(PointInput::kRayLength, [](const ShadeTask& t) { return t.hit.t; });
  for (const auto& [input, column] :
       {std::pair(PointInput::kObjectX, 0), std::pair(PointInput::kObjectY, 1),
        std::pair(PointInput::kObjectZ, 2)}) {
    put(input, [&, at = column](const ShadeTask& t) {
      return Placed(context, t).instance->world_from_local[at];
    });
  }
  for (const auto& [input, way] :
       {std::pair(PointInput::kDx, kPixelX), std::pair(PointInput::kDy, kPixelY),
        std::pair(PointInput::kConeX, kConeX), std::pair(PointInput::kConeY, kConeY)}) {
    if (!program.asks(input)) continue;
    put(input, [all = steps(context, tasks, count, way), tasks](const ShadeTask& t) {
      return all[&t - tasks];
    });
  }
  fill_attributes(context, program, tasks, count);
  return points_;
}

const Vec3* MaterialPoints::steps(const RenderContext& context, const ShadeTask* tasks,
                                  std::uint32_t count, Way way) {
  bool& known = has_steps_[way / 2];
  if (known) return steps_[way];
  known = true;
  FilmPlace film(context.camera);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (way < kConeX) {
      differentials(context, film, tasks[i], steps_[kPixelX][i], steps_[kPixelY][i]);
      continue;
    }
    const ConeSteps cone = cone_steps(tasks[i]);
    steps_[kConeX][i] = cone.across;
    steps_[kConeY][i] = cone.along;
  }
  return steps_[way];
}

const Vec2* MaterialPoints::barycentric_steps(const RenderContext& context, const ShadeTask* tasks,
                                              std::uint32_t count, Way way) {
  bool& known = has_barycentric_steps_[way / 2];
  if (known) return barycentric_steps_[way];
  known = true;
  const Way first = way < kConeX ? kPixelX : kConeX;
  steps(context, tasks, count, first);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3* const world[] = {&steps_[first][i], &steps_[first + 1][i]};
    Vec2* const change[] = {&barycentric_steps_[first][i], &barycentric_steps_[first + 1][i]};
    barycentric_change(Placed(context, tasks[i]), tasks[i], world, change);
  }
  return barycentric_steps_[way];
}

void MaterialPoints::fill_attributes(const RenderContext& context, const Program& program,
                                     const ShadeTask* tasks, std::uint32_t count) {
  constexpr std::size_t kLanes = Program::kLanes;
  const auto& names = program.attributes();
  attributes_.resize(4 * kLanes * names.size());
  attribute_columns_.resize(4 * names.size());
  if (names.empty()) return;
  for (std::size_t a = 0; a < names.size(); ++a) {
    float* const to = &attributes_[4 * kLanes * a];
    for (std::size_t c = 0; c < 4; ++c) attribute_columns_[4 * a + c] = to + c * kLanes;
    const char* name = names[a].c_str();
    const Vec2* change = nullptr;
    for (std::size_t way = 0; way < kWays; ++way) {
      if (!names[a].starts_with(kStepNames[way])) continue;
      name += kStepNames[way].size();
      change = barycentric_steps(context, tasks, count, static_cast<Way>(way));
    }
    const MeshView* known = nullptr;
    const AttributeView* found = nullptr;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Hit& hit = tasks[i].hit;
      const MeshView& mesh = context.scene.meshes[context.scene.instances[hit.instance].mesh];
      if (&mesh != known) {
        known = &mesh;
        found = find_attribute(mesh, name);
      }
      Vec4 value(0.0f);
      if (found != nullptr) value = attribute_at(mesh, *found, hit.primitive, hit.u, hit.v);
      if (found != nullptr && change != nullptr) {
        const Vec2 aside(hit.u + change[i].x, hit.v + change[i].y);
        value = attribute_at(mesh, *found, hit.primitive, aside.x, aside.y) - value;
      }
      for (std::size_t c = 0; c < 4; ++c) to[c * kLanes + i] = value[static_cast<int>(c)];
    }
  }
  points_.attribute = reinterpret_cast<const float* const(*)[4]>(attribute_columns_.data());
}

}  // namespace komorebi
