#include "render/settings.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace komorebi {
namespace {

/// Blender's own limits for samples and resolution are below these; the film's sums rely on them.
constexpr std::uint32_t kMaxSamples = 1u << 24;
constexpr std::uint32_t kMaxLightSamples = 1u << 12;
constexpr std::uint32_t kMaxBounces = 1024;

void require(bool holds, const char* sentence) {
  if (!holds) throw std::invalid_argument(sentence);
}

}  // namespace

double bounce_gain(const Settings& s) {
  const double most = double{std::max(std::max(s.clay_color.x, s.clay_color.y), s.clay_color.z)};
  double gain = 1.0, share = 1.0;
  for (std::uint32_t i = 0; i < s.bounces; ++i) gain += share *= most;
  if (!s.use_fast_gi) return gain;
  const double factor = double{s.fast_gi_factor};
  return gain * (s.fast_gi_method == FastGiMethod::kAdd ? 1.0 + factor : std::max(1.0, factor));
}

void check_settings(const Settings& s, std::uint32_t width, std::uint32_t height) {
  require(s.samples >= 1 && s.samples <= kMaxSamples, "samples must be 1 to 16777216");
  require(s.sample_offset <= kMaxSamples - s.samples,
          "sample_offset + samples must not exceed 16777216");
  require(s.samples_per_pass >= 1, "samples_per_pass must be at least 1");
  require(s.light_samples <= kMaxLightSamples, "light_samples must be 0 (automatic) to 4096");
  require(std::uint64_t{s.sample_offset + s.samples} * s.light_samples <= 0xffffffffu,
          "(sample_offset + samples) times light_samples must stay below 2^32");
  require(std::isfinite(s.adaptive_threshold) && s.adaptive_threshold >= 0.0f &&
              s.adaptive_threshold <= 1.0f,
          "adaptive_threshold must be 0 (automatic) to 1");
  require(s.adaptive_min_samples <= kMaxSamples,
          "adaptive_min_samples must be 0 (automatic) to 16777216");
  require(!(s.use_adaptive_sampling && s.sample_offset > 0),
          "use_adaptive_sampling needs all samples from the first on: with a sample_offset, parts "
          "that each stop on their own do not add up to the whole");
  require(std::isfinite(s.time_limit) && s.time_limit >= 0.0f,
          "time_limit must be finite and not negative (0 is none)");
  require(
      s.time_limit == 0.0f || s.sample_offset + s.samples <= kManySamples,
      "with a time_limit, sample_offset + samples must not exceed 65536: a larger picture could "
      "not be repeated to the bit by its number of samples");
  require(std::isfinite(s.ao_distance) && s.ao_distance >= 0.0f,
          "ao_distance must be finite and not negative (0 is unlimited)");
  for (int c = 0; c < 3; ++c) {
    require(std::isfinite(s.clay_color[c]) && s.clay_color[c] >= 0.0f && s.clay_color[c] <= 1.0f,
            "each channel of clay_color must be 0 to 1");
  }
  require(s.bounces <= kMaxBounces, "bounces must be 0 to 1024");
  require(
      std::isfinite(s.sample_clamp_direct) && s.sample_clamp_direct >= 0.0f &&
          std::isfinite(s.sample_clamp_indirect) && s.sample_clamp_indirect >= 0.0f,
      "sample_clamp_direct and sample_clamp_indirect must be finite and not negative (0 is none)");
  require(s.world_max_bounces <= kMaxBounces, "world_max_bounces must be 0 to 1024");
  require(s.fast_gi_bounces <= kMaxBounces, "fast_gi_bounces must be 0 (never) to 1024");
  require(std::isfinite(s.fast_gi_distance) && s.fast_gi_distance >= 0.0f,
          "fast_gi_distance must be finite and not negative");
  require(std::isfinite(s.fast_gi_factor) && s.fast_gi_factor >= 0.0f && s.fast_gi_factor <= 1e6f,
          "fast_gi_factor must be 0 to 1000000");
  require(std::isfinite(s.filter_width) && s.filter_width >= 0.01f && s.filter_width <= 10.0f,
          "filter_width must be 0.01 to 10 pixels");
  require(std::isfinite(s.mist_start) && std::isfinite(s.mist_depth) && s.mist_depth >= 0.0f,
          "mist_start and mist_depth must be finite, mist_depth not negative");
  require(s.tile_size >= 8 && s.tile_size <= 1024, "tile_size must be 8 to 1024 pixels");
  require(s.threads <= 1024, "threads must be 0 (automatic) to 1024");
  if (s.has_region) {
    const Rect& r = s.region;
    require(r.x_min < r.x_max && r.y_min < r.y_max && r.x_max <= width && r.y_max <= height,
            "region must be a rectangle of at least one pixel inside the frame");
  }
}

}  // namespace komorebi
