// komorebi: renders a dumped scene without Blender, for benchmarks, bug reports and sanitizers.

#include <cstdio>
#include <exception>
#include <stdexcept>

#include "cli/options.h"
#include "io/image.h"
#include "render/dump.h"
#include "render/session.h"

namespace {

using namespace komorebi;

std::vector<float> interleaved_passes(const Session& session, const Rect& region) {
  std::vector<float> rgba(4 * region.area()), depth(region.area()), normal(3 * region.area());
  session.film().read("Combined", region, rgba.data());
  session.film().read("Depth", region, depth.data());
  session.film().read("Normal", region, normal.data());
  std::vector<float> all;
  all.reserve(8 * region.area());
  for (std::size_t i = 0; i < region.area(); ++i) {
    all.insert(all.end(), &rgba[4 * i], &rgba[4 * i] + 4);
    all.push_back(depth[i]);
    all.insert(all.end(), &normal[3 * i], &normal[3 * i] + 3);
  }
  return all;
}

Settings chosen(Settings settings, const CliOptions& options) {
  settings.threads = options.threads;
  if (options.samples) settings.samples = *options.samples;
  if (options.seed) settings.seed = *options.seed;
  if (options.light_samples) settings.light_samples = *options.light_samples;
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
  dumped.scene->commit(pool, never);
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
  image.channels = {"R", "G", "B", "A", "Depth.Z", "Normal.X", "Normal.Y", "Normal.Z"};
  image.pixels = interleaved_passes(session, region);
  image.metadata = {{"komorebi:samples", std::to_string(settings.samples)},
                    {"komorebi:seed", std::to_string(settings.seed)},
                    {"komorebi:version", KOMOREBI_VERSION}};
  write_exr(options.output, image);
  std::printf("%.2f s, %.2f million rays a second\nSaved: '%s'\n", p.elapsed,
              static_cast<double>(p.rays) / 1e6 / p.elapsed, options.output.c_str());
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
    return render(*options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "komorebi: %s\n", error.what());
    return 1;
  }
}
