#pragma once

#include <vector>

#include "bvh/traverse.h"
#include "render/lamp_light.h"
#include "render/light_points.h"
#include "render/surface_batch.h"

namespace komorebi {

/// Draws and traces the rays to lamps of a batch's surfaces. Its arrays grow once.
class LampCaster {
 public:
  explicit LampCaster(const RenderContext& context)
      : context_(context), rays_per_surface_(lamp_rays(context)) {}

  /// Surfaces that are best cast together: as many as the tracer sorts at a time.
  std::uint32_t block_size() const {
    constexpr std::uint32_t kRays = 4096;
    return rays_per_surface_ > 0 ? max_size(kRays / rays_per_surface_) : kRays;
  }
  std::uint64_t ray_count() const { return traced_; }

  /// Adds to light[surface] what the rays of surfaces [begin, end) bring, in the order drawn. They
  /// are at path vertex `vertex`.
  void cast(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
            std::uint32_t vertex, Vec3* light) {
    draw(surfaces, begin, end, vertex);
    trace_and_add(
        surfaces, begin, end, context_.lamp_mask, [](std::uint32_t) { return true; }, light);
  }

  /// After cast: adds what the rays of surfaces that `is_catcher` says true of bring if there is
  /// nothing but shadow catchers.
  template <class IsCatcher>
  void cast_alone(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
                  const IsCatcher& is_catcher, Vec3* light) {
    trace_and_add(surfaces, begin, end, context_.lamp_mask << kMaskCatcherShift, is_catcher, light);
  }

 private:
  static std::uint32_t max_size(std::uint32_t size) { return size > 0 ? size : 1; }

  void draw(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
            std::uint32_t vertex) {
    rays_.resize(std::size_t{end - begin} * rays_per_surface_);
    path_keys_.clear();
    std::uint32_t place = 0;
    for (std::uint32_t s = begin; s < end; ++s) {
      LampPoint point{
          surfaces.leaving_origin(s), surfaces.normal(s), surfaces.geometric_normal(s), {}};
      if (context_.has_terminators) {
        point.end = {surfaces.lift(s), surfaces.cutoff(s), surfaces.frequency(s)};
      }
      const Sampler sampler(surfaces.pixel_seed(s));
      const std::uint32_t sample = surfaces.first_index(s) / context_.light_samples;
      for (std::uint32_t j = 0; j < rays_per_surface_; ++j) {
        rays_[place++] = draw_lamp_ray(context_, point, sampler, vertex, sample, j);
        if (context_.scene.filter.exists()) {
          path_keys_.push_back(lamp_path_key(context_, sampler, vertex, sample, j));
        }
      }
    }
  }

  template <class Wanted>
  void trace_and_add(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
                     std::uint32_t mask, const Wanted& wanted, Vec3* light) {
    const std::uint32_t without = lamps_left_out(mask);
    trace(surfaces, begin, end, mask, wanted, without);
    for (std::uint32_t place = 0; place < rays_.size(); ++place) {
      const LampRay& ray = rays_[place];
      const std::uint32_t surface = begin + place / rays_per_surface_;
      if (ray.contribution == Vec3(0.0f) || (ray.flags & without) || !wanted(surface)) continue;
      if (!blocked_[place]) light[surface] += ray.contribution;
    }
  }

  /// Traces the rays of the surfaces that are wanted, but those to lamps with a flag of `without`,
  /// and sets blocked_.
  template <class Wanted>
  void trace(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
             std::uint32_t mask, const Wanted& wanted, std::uint32_t without) {
    const std::size_t count = rays_.size();
    blocked_.assign(count, 0);
    for (auto& column : columns_) column.resize(count);
    points_.clear(count);
    for (std::uint32_t s = begin; s < end; ++s) {
      if (!wanted(s)) continue;
      const std::uint32_t first = (s - begin) * rays_per_surface_;
      points_.begin(surfaces, s);
      bool lifted = false;
      for (std::uint32_t place = first; place < first + rays_per_surface_; ++place) {
        const LampRay& ray = rays_[place];
        for (int c = 0; c < 3; ++c) columns_[c][place] = ray.direction[c];
        columns_[3][place] = ray.t_max;
        if (!is_cast(ray, without)) continue;
        if (ray.lift > 0.0f) {
          lifted = true;
        } else {
          points_.push_ray(place);
        }
      }
      for (std::uint32_t place = first; lifted && place < first + rays_per_surface_; ++place) {
        const LampRay& ray = rays_[place];
        if (!is_cast(ray, without) || !(ray.lift > 0.0f)) continue;
        points_.begin_lifted(surfaces, s, ray.lift, ray.below);
        points_.push_ray(place);
      }
    }
    RayBundles bundles{};
    points_.lend(bundles);
    bundles.direction_x = columns_[0].data();
    bundles.direction_y = columns_[1].data();
    bundles.direction_z = columns_[2].data();
    bundles.t_max = columns_[3].data();
    bundles.mask = mask;
    if (!path_keys_.empty()) bundles.path_key = path_keys_.data();
    const std::uint32_t rays = bundles.ray_count();
    bits_.resize((rays + 31) / 32);
    occluded(context_.scene, bundles, bits_.data());
    traced_ += rays;
    for (std::uint32_t k = 0; k < rays; ++k) {
      if ((bits_[k / 32] >> (k % 32)) & 1u) blocked_[bundles.place[k]] = 1;
    }
  }

  static bool is_cast(const LampRay& ray, std::uint32_t without) {
    return ray.contribution != Vec3(0.0f) && !(ray.flags & (kLampNoShadow | without));
  }

  RenderContext context_;
  std::uint32_t rays_per_surface_;
  std::vector<LampRay> rays_;  // [surfaces of the block][rays_per_surface_]
  std::vector<std::uint8_t> blocked_;
  std::vector<std::uint32_t> path_keys_;  // of rays_, where the scene has a filter
  std::vector<float> columns_[4];         // direction and t_max of rays_
  LightPoints points_;
  std::vector<std::uint32_t> bits_;  // of the rays traced
  std::uint64_t traced_ = 0;
};

}  // namespace komorebi
