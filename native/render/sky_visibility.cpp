#include "render/sky_visibility.h"

#include <algorithm>
#include <cmath>

#include "bvh/traverse.h"
#include "core/octahedral.h"
#include "core/path_key.h"
#include "core/warp.h"
#include "render/bundle_batch.h"
#include "render/one_ray.h"
#include "render/pixel_grid.h"
#include "render/ray_batch.h"

namespace komorebi {
namespace {

constexpr double kPoints = 9216.0;  // or every pixel of a small frame
constexpr std::uint32_t kRays = 16 * 9216, kLeastRaysPerPoint = 16, kMostRaysPerPoint = 64;

/// What is known of all sides counts as much as so many rays of one side.
constexpr float kPriorRays = 8.0f;

}  // namespace

SkyVisibility::SkyVisibility()
    : counts_(std::make_unique<Count[]>(std::size_t{kSides} * kGrid * kGrid)) {}

std::uint32_t SkyVisibility::side(const Vec3& n) {
  const Vec3 a(n.x < 0.0f ? -n.x : n.x, n.y < 0.0f ? -n.y : n.y, n.z < 0.0f ? -n.z : n.z);
  const int axis = a.z < a.x || a.z < a.y ? (a.y < a.x ? 0 : 1) : 2;
  return 2u * static_cast<std::uint32_t>(axis) + (n[axis] < 0.0f ? 1u : 0u);
}

void SkyVisibility::count(const Vec3& normal, const Vec3& direction, bool seen) {
  Count& c = counts_[side(normal) * kGrid * kGrid + octahedral_cell(direction, kGrid)];
  c.cast.fetch_add(1, std::memory_order_relaxed);
  if (seen) c.seen.fetch_add(1, std::memory_order_relaxed);
}

float SkyVisibility::share_of_cell(std::uint32_t side, std::uint32_t cell) const {
  std::uint32_t cast = 0, seen = 0;
  for (std::uint32_t s = 0; s < kSides; ++s) {
    cast += counts_[s * kGrid * kGrid + cell].cast;
    seen += counts_[s * kGrid * kGrid + cell].seen;
  }
  const float all = (static_cast<float>(seen) + 1.0f) / (static_cast<float>(cast) + 2.0f);
  const Count& own = counts_[side * kGrid * kGrid + cell];
  return (static_cast<float>(own.seen) + kPriorRays * all) /
         (static_cast<float>(own.cast) + kPriorRays);
}

float SkyVisibility::share(std::uint32_t side, const Vec3& direction) const {
  return share_of_cell(side, octahedral_cell(direction, kGrid));
}

float SkyVisibility::variance_left() const {
  double guided = 0.0, even = 0.0;
  for (std::uint32_t side = 0; side < kSides; ++side) {
    double rays = 0.0, share = 0.0, root = 0.0;
    for (std::uint32_t cell = 0; cell < kGrid * kGrid; ++cell) {
      const double cast = counts_[side * kGrid * kGrid + cell].cast;
      const double seen = static_cast<double>(share_of_cell(side, cell));
      rays += cast;
      share += cast * seen;
      root += cast * std::sqrt(seen);
    }
    if (rays == 0.0) continue;
    guided += (root * root - share * share) / rays;
    even += share - share * share / rays;
  }
  return even > 0.0 ? static_cast<float>(guided / even) : 1.0f;
}

bool measure_sky_visibility(const RenderContext& given, ThreadPool& pool, const Cancel& cancel,
                            SkyVisibility& visibility) {
  RenderContext context = given;
  context.seed = 0;  // the same for all seeds
  const PixelGrid grid(context.camera, kPoints);
  const std::uint32_t columns = grid.columns();
  const std::uint32_t per_point = std::clamp(kRays / static_cast<std::uint32_t>(grid.size()),
                                             kLeastRaysPerPoint, kMostRaysPerPoint);
  const Mat3& into_map = context.sky.texture_from_world;
  pool.for_each_chunk(grid.rows(), 1, [&](std::size_t begin, std::size_t end) {
    RayBatch camera_rays;
    BundleBatch batch;
    std::vector<Hit> hits;
    std::vector<std::uint32_t> bits, more_bits;
    std::vector<float> surface_t_max;
    std::vector<Vec3> normals;
    for (std::size_t row = begin; row < end && !cancel.raised(); ++row) {
      const std::uint32_t y = grid.y(static_cast<std::uint32_t>(row));
      camera_rays.clear();
      for (std::uint32_t column = 0; column < columns; ++column) {
        camera_rays.push(start_ray(context, grid.x(column), y, 0));
      }
      hits.resize(columns);
      intersect(context.scene, camera_rays.span(), hits.data());
      batch.clear();
      normals.clear();
      for (std::uint32_t column = 0; column < columns; ++column) {
        const Hit& hit = hits[column];
        if (!hit.valid()) continue;
        const Ray ray = camera_rays.span()[column];
        const SurfacePoint point = surface_point(context.scene, hit, ray);
        batch.begin_point(leaving_origin(point), ray.time, hit);
        normals.push_back(into_map * point.normal);
        const Frame frame = make_frame(point.normal);
        const Sampler sampler(context.seed, grid.x(column), y);
        for (std::uint32_t i = 0; i < per_point; ++i) {
          const std::uint32_t dimension = vertex_dimension(0, kVertexLightDirection);
          const Vec2 u = sampler.sample_2d(dimension, i);
          batch.push_ray(frame.to_world(cosine_hemisphere_disk(u)), context.light_distance,
                         path_key(sampler.pixel_seed, dimension, i));
        }
      }
      const RayBundles bundles = batch.bundles(context.light_mask);
      bits.resize((bundles.ray_count() + 31) / 32);
      occluded(context.scene, bundles, bits.data());
      if (context.surface_mask != 0) {  // light comes where either of Cycles' kinds of rays does
        RayBundles of_surface = bundles;
        of_surface.mask = context.surface_mask;
        surface_t_max.assign(bundles.ray_count(), context.surface_distance);
        of_surface.t_max = surface_t_max.data();
        more_bits.resize(bits.size());
        occluded(context.scene, of_surface, more_bits.data());
        for (std::size_t i = 0; i < bits.size(); ++i) bits[i] &= more_bits[i];
      }
      for (std::uint32_t i = 0; i < bundles.ray_count(); ++i) {
        const Vec3 direction(bundles.direction_x[i], bundles.direction_y[i],
                             bundles.direction_z[i]);
        visibility.count(normals[i / per_point], into_map * direction,
                         !((bits[i / 32] >> (i % 32)) & 1u));
      }
    }
  });
  return !cancel.raised();
}

}  // namespace komorebi
