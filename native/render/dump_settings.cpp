#include "io/array_file.h"
#include "render/dump.h"

namespace komorebi {
namespace {

/// Calls visit(name, member) for every setting that a dump holds, so that writing and reading
/// cannot disagree.
template <class SettingsLike, class Visit>
void for_each_setting(SettingsLike& s, const Visit& visit) {
  visit("method", s.method);
  visit("samples", s.samples);
  visit("light_samples", s.light_samples);
  visit("sample_offset", s.sample_offset);
  visit("seed", s.seed);
  visit("use_adaptive_sampling", s.use_adaptive_sampling);
  visit("adaptive_threshold", s.adaptive_threshold);
  visit("adaptive_min_samples", s.adaptive_min_samples);
  visit("time_limit", s.time_limit);
  visit("ao_distance", s.ao_distance);
  visit("ao_sampling", s.ao_sampling);
  visit("clay_color_r", s.clay_color.x);
  visit("clay_color_g", s.clay_color.y);
  visit("clay_color_b", s.clay_color.z);
  visit("bounces", s.bounces);
  visit("sample_clamp_direct", s.sample_clamp_direct);
  visit("sample_clamp_indirect", s.sample_clamp_indirect);
  visit("world_max_bounces", s.world_max_bounces);
  visit("use_fast_gi", s.use_fast_gi);
  visit("fast_gi_method", s.fast_gi_method);
  visit("fast_gi_bounces", s.fast_gi_bounces);
  visit("fast_gi_distance", s.fast_gi_distance);
  visit("fast_gi_factor", s.fast_gi_factor);
  visit("environment_sampling", s.environment_sampling);
  visit("pixel_filter", s.pixel_filter);
  visit("filter_width", s.filter_width);
  visit("use_progressive", s.use_progressive);
  visit("film_transparent", s.film_transparent);
  visit("mist_start", s.mist_start);
  visit("mist_depth", s.mist_depth);
  visit("mist_falloff", s.mist_falloff);
  visit("tile_size", s.tile_size);
  visit("has_region", s.has_region);
  visit("region_x_min", s.region.x_min);
  visit("region_y_min", s.region.y_min);
  visit("region_x_max", s.region.x_max);
  visit("region_y_max", s.region.y_max);
}

/// An enumeration's count of names, for the check of what is read.
constexpr std::uint32_t last_value(Method) {
  return 1;
}
constexpr std::uint32_t last_value(AoSampling) {
  return 1;
}
constexpr std::uint32_t last_value(FastGiMethod) {
  return 1;
}
constexpr std::uint32_t last_value(EnvironmentSampling) {
  return 3;
}
constexpr std::uint32_t last_value(PixelFilter) {
  return 2;
}
constexpr std::uint32_t last_value(MistFalloff) {
  return 2;
}

}  // namespace

void put_settings(ArrayFile& file, const Settings& settings) {
  for_each_setting(settings, [&](const char* name, const auto& value) {
    const std::string key = std::string("settings/") + name;
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, float>) {
      file.put_value<float>(key, value);
    } else {
      file.put_value<std::uint32_t>(key, static_cast<std::uint32_t>(value));
    }
  });
}

Settings get_settings(const ArrayFile& file) {
  Settings settings;
  for_each_setting(settings, [&](const char* name, auto& value) {
    using Value = std::decay_t<decltype(value)>;
    const std::string key = std::string("settings/") + name;
    if (!file.has(key)) return;  // an older dump: its renders had the default
    if constexpr (std::is_same_v<Value, float>) {
      value = file.get_value<float>(key);
    } else {
      const auto number = file.get_value<std::uint32_t>(key);
      if constexpr (std::is_enum_v<Value>) {
        if (number > last_value(value)) {
          throw std::invalid_argument("the scene's \"" + key + "\" is no value of that setting");
        }
      }
      value = static_cast<Value>(number);
    }
  });
  return settings;
}

}  // namespace komorebi
