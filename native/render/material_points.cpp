#include "render/material_points.h"

#include <cstring>

#include "core/warp.h"
#include "render/camera_axes.h"

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

void attribute_at(const MeshView&, const AttributeView&, std::uint32_t, float, float, float*) {}

const AttributeView* find_attribute(const MeshView& mesh, const char* name) {
  for (std::uint32_t i = 0; i < mesh.attribute_count; ++i) {
    if (std::strcmp(mesh.attributes[i].name, name) == 0) return &mesh.attributes[i];
  }
  return nullptr;
}

/// How far the barycentrics u and v move when the point moves by `step` in its triangle.
Vec2 barycentric_step(const Placed& placed, const ShadeTask& task, const Vec3& step) {
  if (is_round(placed.mesh->kind)) return Vec2(0.0f);
  const Corners at = detail::triangle_corners(*placed.mesh, task.hit.primitive, task.time);
  const Vec3 b = at.corner[1] - at.corner[0], c = at.corner[2] - at.corner[0];
  const Vec3 local = placed.instance->local_from_world * step;
  const float bb = glm::dot(b, b), bc = glm::dot(b, c), cc = glm::dot(c, c);
  const float area = bb * cc - bc * bc;
  if (!(area > 0.0f)) return Vec2(0.0f);
  const float along_b = glm::dot(local, b), along_c = glm::dot(local, c);
  return Vec2(cc * along_b - bc * along_c, bb * along_c - bc * along_b) / area;
}

/// Along the surface, around the vertical axis through the middle of the object (Cycles' Tangent).
Vec3 tangent(const Placed& placed, const ShadeTask& task) {
  float generated[4] = {0.5f, 0.5f, 0.5f, 1.0f};
  if (const AttributeView* found = find_attribute(*placed.mesh, "generated")) {
    attribute_at(*placed.mesh, *found, task.hit.primitive, task.hit.u, task.hit.v, generated);
  }
  const Vec3 around(-(generated[1] - 0.5f), generated[0] - 0.5f, 0.0f);
  const Vec3 world = placed.instance->world_from_local * around;
  const Vec3 side = glm::cross(detail::unit_or(world, Vec3(0.0f)), task.point.normal);
  return glm::cross(task.point.normal, detail::unit_or(side, Vec3(0.0f)));
}

/// How far the point moves in its surface when the ray's pixel moves by one to the right or up: of
/// a camera ray by the neighbouring pixel's ray; after a bounce in some direction of the surface,
/// as wide as a pixel would be so far away.
void differentials(const RenderContext& context, const ShadeTask& task, Vec3& dx, Vec3& dy) {
  const Vec3 normal = task.point.geometric_normal;
  if (task.vertex > 0) {
    const double width = std::sqrt(glm::dot(context.camera.per_x, context.camera.per_x));
    const Frame frame = make_frame(normal);
    const float radius = task.hit.t * static_cast<float>(width);
    dx = radius * frame.tangent;
    dy = radius * frame.bitangent;
    return;
  }
  const Vec2 middle(static_cast<float>(task.x) + 0.5f, static_cast<float>(task.y) + 0.5f);
  const auto meets = [&](const Vec2& film) {
    const Ray ray = camera_ray(context.camera, film, Vec2(0.5f), task.time);
    const float down = glm::dot(ray.direction, normal);
    if (!(down < -1e-4f)) return task.point.position;
    const float t = glm::dot(task.point.position - ray.origin, normal) / down;
    return ray.origin + t * ray.direction;
  };
  const Vec3 here = meets(middle);
  dx = meets(middle + Vec2(1.0f, 0.0f)) - here;
  dy = meets(middle + Vec2(0.0f, 1.0f)) - here;
}

}  // namespace

const ShadePoints& MaterialPoints::fill(const RenderContext& context, const Program& program,
                                        const ShadeTask* tasks, std::uint32_t count) {
  points_.count = count;
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
  put(PointInput::kWindow, [&](const ShadeTask& t) {
    return Vec3((static_cast<float>(t.x) + 0.5f) / context.frame_width,
                (static_cast<float>(t.y) + 0.5f) / context.frame_height, 0.0f);
  });
  put(PointInput::kParametric, [](const ShadeTask& t) { return Vec3(t.hit.u, t.hit.v, 0.0f); });
  put(PointInput::kTangent, [&](const ShadeTask& t) { return tangent(Placed(context, t), t); });
  put(PointInput::kObjectLocation, [&](const ShadeTask& t) {
    return Vec3(Placed(context, t).object_location() + context.origin);
  });
  constexpr PointInput kAxes[] = {PointInput::kObjectX, PointInput::kObjectY, PointInput::kObjectZ};
  for (int axis = 0; axis < 3; ++axis) {
    put(kAxes[axis],
        [&](const ShadeTask& t) { return Placed(context, t).instance->world_from_local[axis]; });
  }
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
  if (program.asks(PointInput::kDx) || program.asks(PointInput::kDy)) {
    Vec3 dx[Program::kLanes], dy[Program::kLanes];
    for (std::uint32_t i = 0; i < count; ++i) differentials(context, tasks[i], dx[i], dy[i]);
    put(PointInput::kDx, [&](const ShadeTask& t) { return dx[&t - tasks]; });
    put(PointInput::kDy, [&](const ShadeTask& t) { return dy[&t - tasks]; });
  }
  fill_attributes(context, program, tasks, count);
  return points_;
}

void MaterialPoints::fill_attributes(const RenderContext& context, const Program& program,
                                     const ShadeTask* tasks, std::uint32_t count) {
  constexpr std::size_t kLanes = Program::kLanes;
  const auto& names = program.attributes();
  attributes_.resize(4 * kLanes * names.size());
  attribute_columns_.resize(4 * names.size());
  for (std::size_t a = 0; a < names.size(); ++a) {
    float* const to = &attributes_[4 * kLanes * a];
    for (std::size_t c = 0; c < 4; ++c) attribute_columns_[4 * a + c] = to + c * kLanes;
    // "dx:" and "dy:" before a name: how much it changes over that step
    const bool changes = names[a].starts_with("dx:") || names[a].starts_with("dy:");
    const auto way = names[a].starts_with("dy:") ? PointInput::kDy : PointInput::kDx;
    const bool steps = changes && program.asks(way);
    const Column* const step = inputs_[static_cast<std::size_t>(way)];
    const MeshView* known = nullptr;
    const AttributeView* found = nullptr;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Hit& hit = tasks[i].hit;
      const MeshView& mesh = context.scene.meshes[context.scene.instances[hit.instance].mesh];
      if (&mesh != known) {
        known = &mesh;
        found = find_attribute(mesh, names[a].c_str() + (changes ? 3 : 0));
      }
      float value[4] = {0.0f, 0.0f, 0.0f, 0.0f};
      if (found != nullptr && (!changes || steps)) {
        attribute_at(mesh, *found, hit.primitive, hit.u, hit.v, value);
      }
      if (found != nullptr && steps) {
        float there[4] = {0.0f, 0.0f, 0.0f, 0.0f};
        const Vec2 moved = barycentric_step(Placed(context, tasks[i]), tasks[i],
                                            Vec3(step[0][i], step[1][i], step[2][i]));
        attribute_at(mesh, *found, hit.primitive, hit.u + moved.x, hit.v + moved.y, there);
        for (int c = 0; c < 4; ++c) value[c] = there[c] - value[c];
      }
      for (std::size_t c = 0; c < 4; ++c) to[c * kLanes + i] = value[c];
    }
  }
  points_.attribute = reinterpret_cast<const float* const(*)[4]>(attribute_columns_.data());
}

}  // namespace komorebi
