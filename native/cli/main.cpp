// komorebi: renders a dumped scene without Blender, for benchmarks, bug reports and sanitizers.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "bvh/traverse.h"
#include "cli/options.h"
#include "io/image.h"
#include "render/dump.h"
#include "render/session.h"

namespace {

using namespace komorebi;

constexpr std::size_t kChannels = 9;

std::vector<float> interleaved_passes(Session& session, const Rect& region) {
  std::vector<float> all(kChannels * region.area());
  std::size_t first = 0;
  for (const char* name : {"Combined", "Depth", "Normal", "Debug Sample Count"}) {
    const std::size_t channels = find_pass(name).channels;
    std::vector<float> pass(channels * region.area());
    session.read(name, region, pass.data());
    for (std::size_t i = 0; i < region.area(); ++i) {
      std::copy_n(&pass[channels * i], channels, &all[kChannels * i + first]);
    }
    first += channels;
  }
  return all;
}

/// What to ask for to get this very picture again, were it cut short by the time limit or not.
std::vector<std::pair<std::string, std::string>> how_to_repeat(const Session& session) {
  const Settings& s = session.settings();
  const Progress p = session.progress();
  std::vector<std::pair<std::string, std::string>> all{
      {"komorebi:samples", std::to_string(s.time_limit > 0.0f ? p.sample : p.samples)},
      {"komorebi:light_samples", std::to_string(session.light_samples())},
      {"komorebi:seed", std::to_string(s.seed)},
      {"komorebi:version", KOMOREBI_VERSION}};
  if (const AdaptiveRule& rule = session.adaptive_rule(); rule.in_use()) {
    const bool automatic = s.adaptive_threshold == 0.0f && s.time_limit == 0.0f;
    char threshold[32];
    std::snprintf(threshold, sizeof threshold, "%.9g", double{automatic ? 0.0f : rule.threshold()});
    all.emplace_back("komorebi:adaptive_threshold", threshold);
    all.emplace_back("komorebi:adaptive_min_samples", std::to_string(rule.min_samples()));
  }
  return all;
}

Settings chosen(Settings settings, const CliOptions& options) {
  settings.threads = options.threads;
  if (options.samples) settings.samples = *options.samples;
  if (options.seed) settings.seed = *options.seed;
  if (options.light_samples) settings.light_samples = *options.light_samples;
  if (options.bounces) settings.bounces = *options.bounces;
  if (options.adaptive_threshold) {
    settings.use_adaptive_sampling = true;
    settings.adaptive_threshold = *options.adaptive_threshold;
  }
  if (options.adaptive_min_samples) settings.adaptive_min_samples = *options.adaptive_min_samples;
  if (options.no_adaptive_sampling) settings.use_adaptive_sampling = false;
  if (options.time_limit) settings.time_limit = *options.time_limit;
  return settings;
}

int render(const CliOptions& options) {
  ThreadPool pool(options.threads);
  const Cancel never;
  DumpedRender dumped = read_dump(options.scene, pool, never);
  const Settings settings = chosen(dumped.settings, options);
  dumped.scene->commit(pool, never, false);
  std::printf("%llu triangles, %u instances, %.1f MB\n",
              static_cast<unsigned long long>(dumped.scene->triangle_count()),
              dumped.scene->instance_count(),
              static_cast<double>(dumped.scene->byte_count()) / 1e6);

  Session session(dumped.scene, settings);
  while (!session.wait(1.0)) {
    const Progress p = session.progress();
    std::printf("sample %u/%u, %.1f s left\n", p.sample, p.samples, p.remaining);
    std::fflush(stdout);
  }
  if (const std::string error = session.error(); !error.empty()) throw std::runtime_error(error);
  const Progress p = session.progress();
  const Rect region = session.settings().region;
  Image image;
  image.width = region.width();
  image.height = region.height();
  image.channels = {
      "R", "G", "B", "A", "Depth.Z", "Normal.X", "Normal.Y", "Normal.Z", "Debug Sample Count.X"};
  image.pixels = interleaved_passes(session, region);
  image.metadata = how_to_repeat(session);
  write_exr(options.output, image);
  std::printf("%u samples, %.1f a pixel, %.2f million rays, %.2f s, %.2f million rays a second\n",
              p.sample, p.mean_samples, static_cast<double>(p.rays) / 1e6, p.elapsed,
              static_cast<double>(p.rays) / 1e6 / p.elapsed);
  std::printf("Saved: '%s'\n", options.output.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto options = komorebi::parse_options(argc, argv);
    if (!options) {
      std::fputs(komorebi::usage(), stdout);
      return 0;
    }
    komorebi::check_instruction_set();
    return render(*options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "komorebi: %s\n", error.what());
    return 1;
  }
}
