#include "cli/options.h"

#include <charconv>
#include <cstring>
#include <stdexcept>

namespace komorebi {
namespace {

std::uint32_t number(const char* option, const char* text) {
  std::uint32_t value = 0;
  const char* end = text + std::strlen(text);
  const auto [stopped, error] = std::from_chars(text, end, value);
  if (error != std::errc() || stopped != end) {
    throw std::runtime_error(std::string(option) + " needs a whole number, not \"" + text + "\"");
  }
  return value;
}

float real_number(const char* option, const char* text) {
  float value = 0;
  const char* end = text + std::strlen(text);
  const auto [stopped, error] = std::from_chars(text, end, value);
  if (error != std::errc() || stopped != end) {
    throw std::runtime_error(std::string(option) + " needs a number, not \"" + text + "\"");
  }
  return value;
}

}  // namespace

const char* usage() {
  return "usage: komorebi SCENE [-o FILE.exr] [OPTION...]\n"
         "Renders a scene that the add-on dumped and writes its passes into one EXR file.\n"
         "In place of the scene's own settings:\n"
         "  --samples N               camera samples a pixel\n"
         "  --light-samples N         light rays a camera sample (0: automatic)\n"
         "  --bounces N               from surface to surface\n"
         "  --seed N\n"
         "  --adaptive-threshold X    stop where the noise is below X (0: automatic)\n"
         "  --adaptive-min-samples N  but not before N samples (0: automatic)\n"
         "  --no-adaptive-sampling\n"
         "  --time-limit SECONDS      end after the pass of the frame that is then on (0: none)\n"
         "  --threads N               (0: one a core)\n";
}

std::optional<CliOptions> parse_options(int argc, char** argv) {
  CliOptions options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&]() -> const char* {
      if (i + 1 == argc) throw std::runtime_error(word + " needs a value");
      return argv[++i];
    };
    if (word == "-h" || word == "--help") return std::nullopt;
    if (word == "-o" || word == "--output") {
      options.output = value();
    } else if (word == "--samples") {
      options.samples = number("--samples", value());
    } else if (word == "--seed") {
      options.seed = number("--seed", value());
    } else if (word == "--light-samples") {
      options.light_samples = number("--light-samples", value());
    } else if (word == "--bounces") {
      options.bounces = number("--bounces", value());
    } else if (word == "--adaptive-threshold") {
      options.adaptive_threshold = real_number("--adaptive-threshold", value());
    } else if (word == "--adaptive-min-samples") {
      options.adaptive_min_samples = number("--adaptive-min-samples", value());
    } else if (word == "--no-adaptive-sampling") {
      options.no_adaptive_sampling = true;
    } else if (word == "--time-limit") {
      options.time_limit = real_number("--time-limit", value());
    } else if (word == "--threads") {
      options.threads = number("--threads", value());
    } else if (word.starts_with("-") || !options.scene.empty()) {
      throw std::runtime_error("\"" + word + "\" is not understood; see komorebi --help");
    } else {
      options.scene = word;
    }
  }
  if (options.scene.empty()) throw std::runtime_error("which scene? see komorebi --help");
  return options;
}

}  // namespace komorebi
