#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace komorebi {

struct CliOptions {
  std::string scene;
  std::string output = "komorebi.exr";
  std::uint32_t threads = 0;
  // In place of the scene's own.
  std::optional<std::uint32_t> samples, seed, light_samples, bounces, adaptive_min_samples;
  std::optional<float> adaptive_threshold;  ///< turns adaptive sampling on
  bool no_adaptive_sampling = false;
  std::optional<float> time_limit;
};

const char* usage();

/// Nothing when help was asked for; throws std::runtime_error naming a word it does not know.
std::optional<CliOptions> parse_options(int argc, char** argv);

}  // namespace komorebi
