#pragma once

#include <vector>

#include "bvh/traverse.h"
#include "core/path_key.h"
#include "render/light.h"
#include "render/light_block.h"
#include "render/light_points.h"
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

  /// By which rays are drawn from now on, as many as before.
  void set_context(const RenderContext& context) { context_ = context; }
  std::uint32_t block_size() const { return block_.capacity(); }
  std::uint64_t ray_count() const { return rays_; }
  /// Rays of cast(), and those of them that something blocked.
  RayTally tally() const { return tally_; }

  /// Calls visit(surface, direction, contribution, visible) for every ray of surfaces
  /// [begin, end), at most block_size() of them, that could bring light, in the order drawn; of one
  /// that only some of Cycles' rays would see the share is left that these find.
  template <class Visit>
  void cast(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
            const Visit& visit) {
    block_.draw(context_, surfaces.light_block(context_, begin, end));
    terminate_rays(surfaces, begin, end);
    if (context_.scene.filter.exists()) find_path_keys(surfaces, begin, end);
    const std::uint64_t before = rays_;
    tally_.blocked += trace(surfaces, begin, end, light_rays(), kDrawn, kBlocked);
    tally_.cast += rays_ - before;
    if (context_.surface_mask == 0) {
      for_each_drawn(end - begin, [&](std::uint32_t p, std::uint32_t place) {
        visit(begin + p, block_.direction(place), block_.contribution(place),
              !(state_[place] & kBlocked));
      });
      return;
    }
    trace(surfaces, begin, end, surface_rays(), kDrawn, kSurfaceBlocked);
    for_each_drawn(end - begin, [&](std::uint32_t p, std::uint32_t place) {
      const float share = arriving(surfaces, begin + p, place, kBlocked, kSurfaceBlocked);
      visit(begin + p, block_.direction(place), block_.contribution(place) * share, share > 0.0f);
    });
  }

  /// After cast: calls visit(surface, contribution) for the rays of surfaces that `is_catcher`
  /// says true of, which reach the sky if there is nothing but shadow catchers. In the order drawn.
  template <class IsCatcher, class Visit>
  void cast_alone(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
                  const IsCatcher& is_catcher, const Visit& visit) {
    for_each_drawn(end - begin, [&](std::uint32_t p, std::uint32_t place) {
      // What nothing blocks, no catcher does.
      if ((state_[place] & (kBlocked | kSurfaceBlocked)) && is_catcher(begin + p)) {
        state_[place] |= kAgain;
      }
    });
    trace(surfaces, begin, end, alone(light_rays()), kAgain, kBlockedAgain);
    const bool splits = context_.surface_mask != 0;
    if (splits) {
      trace(surfaces, begin, end, alone(surface_rays()), kAgain, kSurfaceBlockedAgain);
    }
    for_each_drawn(end - begin, [&](std::uint32_t p, std::uint32_t place) {
      if (!is_catcher(begin + p)) return;
      if (!splits) {
        if (!(state_[place] & kBlockedAgain)) visit(begin + p, block_.contribution(place));
        return;
      }
      const float share = arriving(surfaces, begin + p, place, kBlockedAgain, kSurfaceBlockedAgain);
      if (share > 0.0f) visit(begin + p, block_.contribution(place) * share);
    });
  }

 private:
  /// Of a ray: drawn with light to bring, lifted from its point, below its own triangle, blocked;
  /// to be traced again among shadow catchers, blocked by one; the same for what blocks the rays of
  /// surface_mask.
  enum State : std::uint8_t {
    kDrawn = 1,
    kLifted = 2,
    kBelow = 4,
    kBlocked = 8,
    kAgain = 16,
    kBlockedAgain = 32,
    kSurfaceBlocked = 64,
    kSurfaceBlockedAgain = 128
  };

  /// What blocks rays: things of a mask, up to a distance.
  struct Obstacles {
    std::uint32_t mask;
    float distance;
  };
  Obstacles light_rays() const { return {context_.light_mask, context_.light_distance}; }
  Obstacles surface_rays() const { return {context_.surface_mask, context_.surface_distance}; }
  static Obstacles alone(Obstacles o) { return {o.mask << kMaskCatcherShift, o.distance}; }

  /// arriving_share of a ray, given the bits that say what blocks it.
  float arriving(const SurfaceBatch& surfaces, std::uint32_t surface, std::uint32_t place,
                 std::uint8_t blocked, std::uint8_t surface_blocked) const {
    return arriving_share(context_, surfaces.normal(surface), block_.direction(place),
                          !(state_[place] & blocked), !(state_[place] & surface_blocked));
  }

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
    const bool lifts = context_.has_terminators && context_.lifts_rays;
    if (lifts) share_.resize(block_.size());
    for (std::uint32_t j = 0; j < context_.light_samples; ++j) {
      const std::uint32_t first = block_.place(0, j), last = first + (end - begin);
      for (std::uint32_t place = first; place < last; ++place) {
        state_[place] = block_.contribution(place) != Vec3(0.0f) ? kDrawn : 0;
      }
      if (!lifts) continue;
      surfaces.find_lifted_shares(begin, end, block_.directions(first), &share_[first]);
      for (std::uint32_t place = first; place < last; ++place) {
        if (!(share_[place] > 0.0f) || !state_[place]) continue;
        const Vec3 normal = surfaces.geometric_normal(begin + (place - first));
        const bool below = !(glm::dot(block_.direction(place), normal) > 0.0f);
        state_[place] |= below ? kLifted | kBelow : kLifted;
      }
    }
    if (context_.cuts_cosines) cut_cosines(surfaces, begin, end);
  }

  void find_path_keys(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end) {
    path_keys_.resize(block_.size());
    const std::uint32_t dimension = context_.light_dimension;
    for (std::uint32_t s = begin; s < end; ++s) {
      for (std::uint32_t j = 0; j < context_.light_samples; ++j) {
        path_keys_[block_.place(s - begin, j)] =
            path_key(surfaces.pixel_seed(s), dimension, surfaces.first_index(s) + j);
      }
    }
  }

  void cut_cosines(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = 0; p < end - begin; ++p) {
      const float frequency = surfaces.frequency(begin + p);
      if (!(frequency > 1.0f)) continue;
      for (std::uint32_t j = 0; j < context_.light_samples; ++j) {
        const std::uint32_t place = block_.place(p, j);
        if (!state_[place]) continue;
        const float cosine = glm::dot(block_.direction(place), surfaces.normal(begin + p));
        block_.set_contribution(place, block_.contribution(place) * cosine_left(frequency, cosine));
      }
    }
  }

  /// Traces the rays that have the bit `wanted`, and sets `blocked` in those that hit something;
  /// returns how many.
  std::uint64_t trace(const SurfaceBatch& surfaces, std::uint32_t begin, std::uint32_t end,
                      Obstacles obstacles, std::uint8_t wanted, std::uint8_t blocked) {
    points_.clear(block_.size());
    for (std::uint32_t s = begin; s < end; ++s) {
      points_.begin(surfaces, s);
      bool lifted = false;
      for (std::uint32_t j = 0; j < context_.light_samples; ++j) {
        const std::uint32_t place = block_.place(s - begin, j);
        if (!(state_[place] & wanted)) continue;
        if (state_[place] & kLifted) {
          lifted = true;
        } else {
          points_.push_ray(place);
        }
      }
      for (std::uint32_t j = 0; lifted && j < context_.light_samples; ++j) {
        const std::uint32_t place = block_.place(s - begin, j);
        if (!(state_[place] & wanted) || !(state_[place] & kLifted)) continue;
        points_.begin_lifted(surfaces, s, share_[place], state_[place] & kBelow);
        points_.push_ray(place);
      }
    }
    RayBundles bundles{};
    points_.lend(bundles);
    block_.lend(bundles, obstacles.distance);
    bundles.mask = obstacles.mask;
    bundles.path_key = path_keys_.data();
    const std::uint32_t rays = bundles.ray_count();
    bits_.resize((rays + 31) / 32);
    occluded(context_.scene, bundles, bits_.data());
    rays_ += rays;
    std::uint64_t count = 0;
    for (std::uint32_t k = 0; k < rays; ++k) {
      if (!((bits_[k / 32] >> (k % 32)) & 1u)) continue;
      state_[bundles.place[k]] |= blocked;
      ++count;
    }
    return count;
  }

  RenderContext context_;
  LightBlockBuffer block_;
  std::vector<std::uint8_t> state_;       // State bits of each place
  std::vector<float> share_;              // of the lift, of each place
  std::vector<std::uint32_t> path_keys_;  // of each place, where the scene has a filter
  LightPoints points_;
  std::vector<std::uint32_t> bits_;  // of the rays traced
  std::uint64_t rays_ = 0;
  RayTally tally_;
};

}  // namespace komorebi
