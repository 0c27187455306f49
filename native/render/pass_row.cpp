#include "render/pass_row.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/motion_vector.h"
#include "core/surface_point.h"
#include "render/camera_axes.h"
#include "render/world_program.h"

namespace komorebi {
namespace {

/// How much of a point is lost in the mist: 0 near the camera, 1 from mist_start + mist_depth on.
float mist(const RenderContext& context, const Vec3d& position) {
  const CameraView& camera = context.camera;
  const Vec3d from_camera = position - camera.origin;
  const double distance = camera.kind == CameraKind::kOrthographic
                              ? std::abs(glm::dot(from_camera, camera.depth_gradient))
                              : std::sqrt(glm::dot(from_camera, from_camera));
  const double depth = double{context.mist_depth};
  const double beyond = distance - double{context.mist_start};
  const double share = depth > 0.0 ? std::clamp(beyond / depth, 0.0, 1.0) : beyond > 0.0;
  switch (context.mist_falloff) {
    case MistFalloff::kQuadratic:
      return static_cast<float>(share * share);
    case MistFalloff::kInverseQuadratic:
      return static_cast<float>(std::sqrt(share));
    case MistFalloff::kLinear:
      break;
  }
  return static_cast<float>(share);
}

Vec3 uv_at(const MeshView& mesh, const Hit& hit) {
  if (!mesh.tri2uv) return Vec3(0.0f);
  if (is_round(mesh.kind)) {
    const float* uv = mesh.tri2uv + 2 * std::size_t{hit.primitive};
    return Vec3(uv[0], uv[1], 1.0f);
  }
  const float* uv = mesh.tri2uv + 6 * std::size_t{hit.primitive};
  const float w = 1.0f - hit.u - hit.v;
  return Vec3(w * uv[0] + hit.u * uv[2] + hit.v * uv[4], w * uv[1] + hit.u * uv[3] + hit.v * uv[5],
              1.0f);
}

/// Who and where a surface is, of which only the first sample of a pixel counts.
void put_first(const RenderContext& context, const Hit& hit, const Ray& ray, float depth,
               const ObjectInfo& object, const MaterialInfo& material, float* row) {
  const PassLayout& layout = context.passes;
  layout.put(row, Quantity::kDepth, depth);
  layout.put(row, Quantity::kObjectIndex, object.pass_index);
  layout.put(row, Quantity::kMaterialIndex, material.pass_index);
  layout.put(row, Quantity::kInstanceIndex, static_cast<float>(hit.instance + 1));
  if (layout.keeps(Quantity::kPosition)) {
    const Vec3d position(surface_point(context.scene, hit, ray).position);
    layout.put(row, Quantity::kPosition, Vec3(position + context.origin));
  }
}

std::uint32_t material_of(const RenderContext& context, const Hit& hit) {
  const InstanceView& instance = context.scene.instances[hit.instance];
  const MeshView& mesh = context.scene.meshes[instance.mesh];
  return context.tables->material_index(instance.material_slots,
                                        mesh.tri2material ? mesh.tri2material[hit.primitive] : 0);
}

}  // namespace

void clear_row(const PassLayout& layout, float* row) {
  std::fill_n(row, layout.size(), 0.0f);
  layout.put(row, Quantity::kDepth, 1e10f);  // Blender's background
  layout.put(row, Quantity::kMist, 1.0f);
}

void put_values(const RenderContext& context, const Hit& hit, float* row) {
  const PassLayout& layout = context.passes;
  if (layout.values == 0) return;
  const std::uint32_t material = material_of(context, hit);
  if (material == kNone) return;
  const SceneTables& tables = *context.tables;
  std::copy_n(&tables.values[std::size_t{material} * tables.value_count], layout.values,
              row_of_values(layout, row));
}

float* row_of_values(const PassLayout& layout, float* row) {
  return row + layout.place[static_cast<std::size_t>(Quantity::kMaterialValue)];
}

void put_surface(const RenderContext& context, const Hit& hit, const Ray& ray, const Vec3& normal,
                 float depth, const Shading& shading, std::uint32_t sample, float* row) {
  const PassLayout& layout = context.passes;
  const InstanceView& instance = context.scene.instances[hit.instance];
  const MeshView& mesh = context.scene.meshes[instance.mesh];
  const bool first = layout.firsts > 0 && sample == context.first_sample;
  if (first || layout.ids > 0) {
    const ObjectInfo object = context.tables->object(instance.object_index);
    const MaterialInfo material = context.tables->material(material_of(context, hit));
    if (first) put_first(context, hit, ray, depth, object, material, row);
    layout.put(row, Quantity::kMatteObject, std::bit_cast<float>(object.matte));
    layout.put(row, Quantity::kMatteAsset, std::bit_cast<float>(object.matte_asset));
    layout.put(row, Quantity::kMatteMaterial, std::bit_cast<float>(material.matte));
  }
  put_values(context, hit, row);
  layout.put(row, Quantity::kNormal, normal);
  layout.put(row, Quantity::kDiffuseColor, shading.color);
  layout.put(row, Quantity::kEmission, shading.emission);
  layout.put(row, Quantity::kDenoisingRoughness, 1.0f);  // of matt surfaces, as in Cycles
  layout.put(row, Quantity::kDenoisingDepth, hit.t);
  if (context.has_vector) {
    const glm::vec4 vector = motion_vector(context.scene, context.steps, context.film_steps, hit);
    float* to = row + layout.place[static_cast<std::size_t>(Quantity::kVector)];
    for (int c = 0; c < 4; ++c) to[c] = vector[c];
    layout.put(row, Quantity::kVectorWeight, 1.0f);
  }
  if (layout.keeps(Quantity::kUv)) layout.put(row, Quantity::kUv, uv_at(mesh, hit));
  if (layout.keeps(Quantity::kMist)) {
    const Vec3d at = Vec3d(ray.origin) + double{hit.t} * Vec3d(ray.direction);
    layout.put(row, Quantity::kMist, mist(context, at));
  }
  if (layout.keeps(Quantity::kDenoisingNormal)) {
    layout.put(row, Quantity::kDenoisingNormal, Vec3(Vec3d(normal) * camera_axes(context.camera)));
  }
}

void put_world_values(const RenderContext& context, const Vec3& direction, float* row) {
  const Program* program = context.tables->world_values.get();
  if (context.passes.values == 0 || program == nullptr) return;
  world_values(*program, direction, context.passes.values, row_of_values(context.passes, row));
}

void put_environment(const RenderContext& context, const Vec3& direction, float* row) {
  if (!context.passes.keeps(Quantity::kEnvironment)) return;
  context.passes.put(row, Quantity::kEnvironment, world_radiance(context, direction));
}

void put_matte(const PassLayout& layout, const PixelSample& sample, float* row) {
  if (!layout.keeps(Quantity::kMatte)) return;
  layout.put(row, Quantity::kMatte, sample.radiance);
  row[layout.place[static_cast<std::size_t>(Quantity::kMatte)] + 3] = sample.alpha;
}

}  // namespace komorebi
