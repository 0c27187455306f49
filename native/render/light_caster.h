#pragma once

#include <bit>
#include <vector>

#include "bvh/traverse.h"
#include "render/light_block.h"
#include "render/surface_batch.h"

namespace komorebi {

struct RayTally {
  std::uint64_t cast = 0, blocked = 0;
};

/// Draws and traces the light rays of a batch's surfaces, block by block. Its arrays grow once.
class LightCaster {
 public:
  explicit LightCaster(const RenderContext& context)
      : context_(context), block_(context.light_samples) {}

  std::uint32_t block_size() const { return block_.capacity(); }
  std::uint64_t ray_count() const { return rays_; }
  /// Rays of cast(), and those of them that something blocked.
  RayTally tally() const { return tally_; }

  /// Calls visit(surface, direction, contribution, visible) for every ray of surfaces
  /// [begin, end), at most block_size() of them, that could bring light, in the order drawn.
  template <class Visit>
  void cast(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
            const Visit& visit) {
    draw(surfaces, begin, end);
    trace(surfaces, begin, end, context_.light_mask, first_ray_, places_, blocked_);
    tally_.cast += places_.size();
    for (const std::uint32_t word : blocked_) {
      tally_.blocked += static_cast<std::uint64_t>(std::popcount(word));
    }
    for (std::uint32_t p = 0; p < end - begin; ++p) {
      for (std::uint32_t k = first_ray_[p]; k < first_ray_[p + 1]; ++k) {
        const std::uint32_t place = places_[k];
        visit(begin + p, block_.direction(place), block_.contribution(place), !bit(blocked_, k));
      }
    }
  }

  /// After cast: calls visit(surface, contribution) for the rays of surfaces that `is_catcher`
  /// says true of, which reach the sky if there is nothing but shadow catchers. In the order drawn.
  template <class IsCatcher, class Visit>
  void cast_alone(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
                  const IsCatcher& is_catcher, const Visit& visit) {
    again_first_.clear();
    again_.clear();
    for (std::uint32_t p = 0; p < end - begin; ++p) {
      again_first_.push_back(static_cast<std::uint32_t>(again_.size()));
      if (!is_catcher(begin + p)) continue;
      for (std::uint32_t k = first_ray_[p]; k < first_ray_[p + 1]; ++k) {
        if (bit(blocked_, k)) again_.push_back(places_[k]);  // what nothing blocks, no catcher does
      }
    }
    again_first_.push_back(static_cast<std::uint32_t>(again_.size()));
    trace(surfaces, begin, end, context_.light_mask << kMaskCatcherShift, again_first_, again_,
          blocked_again_);
    for (std::uint32_t p = 0; p < end - begin; ++p) {
      if (!is_catcher(begin + p)) continue;
      std::uint32_t next = again_first_[p];
      for (std::uint32_t k = first_ray_[p]; k < first_ray_[p + 1]; ++k) {
        if (bit(blocked_, k) && bit(blocked_again_, next++)) continue;
        visit(begin + p, block_.contribution(places_[k]));
      }
    }
  }

 private:
  static bool bit(const std::vector<std::uint32_t>& bits, std::uint32_t i) {
    return (bits[i / 32] >> (i % 32)) & 1u;
  }

  void draw(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end) {
    block_.draw(context_, surfaces.light_block(begin, end));
    first_ray_.clear();
    places_.clear();
    for (std::uint32_t p = 0; p < end - begin; ++p) {
      first_ray_.push_back(static_cast<std::uint32_t>(places_.size()));
      for (std::uint32_t j = 0; j < context_.light_samples; ++j) {
        const std::uint32_t place = block_.place(p, j);
        if (block_.contribution(place) != Vec3(0.0f)) places_.push_back(place);
      }
    }
    first_ray_.push_back(static_cast<std::uint32_t>(places_.size()));
  }

  void trace(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
             std::uint32_t mask, const std::vector<std::uint32_t>& first_ray,
             const std::vector<std::uint32_t>& places, std::vector<std::uint32_t>& blocked) {
    RayBundles bundles{};
    surfaces.lend(bundles, begin, end);
    block_.lend(bundles, context_.light_distance);
    bundles.first_ray = first_ray.data();
    bundles.place = places.data();
    bundles.mask = mask;
    blocked.resize((places.size() + 31) / 32);
    occluded(context_.scene, bundles, blocked.data());
    rays_ += places.size();
  }

  RenderContext context_;
  LightBlockBuffer block_;
  std::vector<std::uint32_t> first_ray_, places_, blocked_;  // of the rays traced: RayBundles
  std::vector<std::uint32_t> again_first_, again_, blocked_again_;
  std::uint64_t rays_ = 0;
  RayTally tally_;
};

}  // namespace komorebi
