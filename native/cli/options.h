#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace komorebi {

struct CliOptions {
  std::string scene;
  std::string output = "komorebi.exr";
  std::uint32_t threads = 0;
  std::optional<std::uint32_t> samples, seed;  ///< in place of the scene's own
};

const char* usage();

/// Nothing when help was asked for; throws std::runtime_error naming a word it does not know.
std::optional<CliOptions> parse_options(int argc, char** argv);

}  // namespace komorebi
