#pragma once

#include <vector>

#include "bvh/traverse.h"
#include "render/lifted_rays.h"
#include "render/light.h"
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
      : context_(context), block_(context.light_samples), state_(block_.size()) {}

  std::uint32_t block_size() const { return block_.capacity(); }
  std::uint64_t ray_count() const { return rays_; }
  /// Rays of cast(), and those of them that something blocked.
  RayTally tally() const { return tally_; }

  /// Calls visit(surface, direction, contribution, visible) for every ray of surfaces
  /// [begin, end), at most block_size() of them, that could bring light, in the order drawn.
  template <class Visit>
  void cast(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
            const Visit& visit) {
    block_.draw(context_, surfaces.light_block(context_, begin, end));
    terminate_rays(surfaces, begin, end);
    const std::uint64_t before = rays_;
    tally_.blocked += trace(surfaces, begin, end, context_.light_mask, kDrawn, kBlocked);
    tally_.cast += rays_ - before;
    for_each_drawn(end - begin, [&](std::uint32_t p, std::uint32_t place) {
      visit(begin + p, block_.direction(place), block_.contribution(place),
            !(state_[place] & kBlocked));
    });
  }

  /// After cast: calls visit(surface, contribution) for the rays of surfaces that `is_catcher`
  /// says true of, which reach the sky if there is nothing but shadow catchers. In the order drawn.
  template <class IsCatcher, class Visit>
  void cast_alone(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
                  const IsCatcher& is_catcher, const Visit& visit) {
    for_each_drawn(end - begin, [&](std::uint32_t p, std::uint32_t place) {
      // What nothing blocks, no catcher does.
      if ((state_[place] & kBlocked) && is_catcher(begin + p)) state_[place] |= kAgain;
    });
    trace(surfaces, begin, end, context_.light_mask << kMaskCatcherShift, kAgain, kBlockedAgain);
    for_each_drawn(end - begin, [&](std::uint32_t p, std::uint32_t place) {
      if (!is_catcher(begin + p) || (state_[place] & kBlockedAgain)) return;
      visit(begin + p, block_.contribution(place));
    });
  }

 private:
  /// Of a ray: drawn with light to bring, lifted from its point, below its own triangle, blocked;
  /// to be traced again among shadow catchers, blocked by one.
  enum State : std::uint8_t {
    kDrawn = 1,
    kLifted = 2,
    kBelow = 4,
    kBlocked = 8,
    kAgain = 16,
    kBlockedAgain = 32
  };

  /// Calls visit(point, place) in the order drawn.
  template <class Visit>
  void for_each_drawn(std::uint32_t points, const Visit& visit) const {
    for (std::uint32_t p = 0; p < points; ++p) {
      for (std::uint32_t j = 0; j < context_.light_samples; ++j) {
        const std::uint32_t place = block_.place(p, j);
        if (state_[place] & kDrawn) visit(p, place);
      }
    }
  }

  /// Sets every ray's state, and how far it is lifted.
  void terminate_rays(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end) {
    const bool terminators = context_.has_terminators;
    if (terminators) share_.resize(block_.size());
    for (std::uint32_t p = 0; p < end - begin; ++p) {
      const Terminator t = terminators ? surfaces.terminator(begin + p) : Terminator();
      const bool plain = t.cutoff == 0.0f && t.frequency == 1.0f;
      for (std::uint32_t j = 0; j < context_.light_samples; ++j) {
        const std::uint32_t place = block_.place(p, j);
        Vec3 contribution = block_.contribution(place);
        state_[place] = contribution != Vec3(0.0f) ? kDrawn : 0;
        if (plain || !state_[place]) continue;
        const Vec3 direction = block_.direction(place);
        const float cosine = glm::dot(direction, surfaces.geometric_normal(begin + p));
        share_[place] = terminate(context_, t, glm::dot(direction, surfaces.normal(begin + p)),
                                  cosine, contribution);
        if (context_.cuts_cosines && t.frequency > 1.0f)
          block_.set_contribution(place, contribution);
        if (share_[place] > 0.0f) state_[place] |= cosine > 0.0f ? kLifted : kLifted | kBelow;
      }
    }
  }

  /// Traces the rays that have the bit `wanted`, and sets `blocked` in those that hit something;
  /// returns how many.
  std::uint64_t trace(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
                      std::uint32_t mask, std::uint8_t wanted, std::uint8_t blocked) {
    first_ray_.clear();
    places_.clear();
    lifted_.clear();
    for (std::uint32_t p = 0; p < end - begin; ++p) {
      first_ray_.push_back(static_cast<std::uint32_t>(places_.size()));
      for (std::uint32_t j = 0; j < context_.light_samples; ++j) {
        const std::uint32_t place = block_.place(p, j);
        if (!(state_[place] & wanted)) continue;
        if (state_[place] & kLifted) {
          lifted_.push(surfaces, begin + p, place, share_[place], state_[place] & kBelow);
        } else {
          places_.push_back(place);
        }
      }
    }
    first_ray_.push_back(static_cast<std::uint32_t>(places_.size()));
    RayBundles bundles{};
    surfaces.lend(bundles, begin, end);
    bundles.first_ray = first_ray_.data();
    bundles.place = places_.data();
    std::uint64_t count = trace(bundles, places_, mask, blocked);
    if (lifted_.size() == 0) return count;
    bundles = {};
    lifted_.lend(bundles);
    return count + trace(bundles, lifted_.places(), mask, blocked);
  }

  std::uint64_t trace(RayBundles& bundles, const std::vector<std::uint32_t>& places,
                      std::uint32_t mask, std::uint8_t blocked) {
    block_.lend(bundles, context_.light_distance);
    bundles.mask = mask;
    bits_.resize((places.size() + 31) / 32);
    occluded(context_.scene, bundles, bits_.data());
    rays_ += places.size();
    std::uint64_t count = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (!((bits_[k / 32] >> (k % 32)) & 1u)) continue;
      state_[places[k]] |= blocked;
      ++count;
    }
    return count;
  }

  RenderContext context_;
  LightBlockBuffer block_;
  std::vector<std::uint8_t> state_;                       // State bits of each place
  std::vector<float> share_;                              // of the lift, of each place
  std::vector<std::uint32_t> first_ray_, places_, bits_;  // of the rays traced: RayBundles
  LiftedRays lifted_;
  std::uint64_t rays_ = 0;
  RayTally tally_;
};

}  // namespace komorebi
