#include "render/light_samples.h"

#include <atomic>
#include <vector>

#include "render/batch.h"
#include "render/pixel_grid.h"

namespace komorebi {
namespace {

constexpr double kPoints = 2304.0;
/// One pixel of so many is looked at: 0.5 % of the rays of a picture of 32 samples.
constexpr double kPixelsPerPoint = 25.0;
constexpr std::size_t kFewestPoints = 500;
constexpr std::uint32_t kRowsPerChunk = 4;  ///< enough rays for the tracer to sort

/// Eight light rays in place of four take 1.5 times the time, and what they leave of the variance
/// within a camera sample is averaged over the camera samples too. Measured ratios: 1.2 and 1.5
/// where four are better (10,000 dragons in the sun), 1.4 where it makes no difference, 1.56 to 2.6
/// where eight are better by 1.2 to 1.4 times (docs/performance.md).
constexpr double kWorthwhile = 1.55;

/// What a camera sample costs in units of a light ray: by the ratio above, without light rays, and
/// each ray of its bounces (of sponza's, which are looked at as closest hits and by light rays).
constexpr double kCostWithoutLight = 3.27, kCostOfBounceRay = 3.0;

/// What was found of camera samples with so many light rays.
struct Trial {
  double variance = 0.0;     // of a sample's radiance, mean over pixels; 0 when cancelled
  double bounce_rays = 0.0;  // a sample
};

/// Of two samples a pixel.
Trial try_samples(const RenderContext& context, const PixelGrid& grid, ThreadPool& pool,
                  const Cancel& cancel) {
  std::atomic<std::uint64_t> bounce_rays{0};
  std::vector<double> row_sums(grid.rows(), 0.0);  // added up in order, whoever made them
  pool.for_each_chunk(grid.rows(), kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
    BatchIntegrator integrator(context);
    std::vector<PixelPlace> pixels;
    for (std::size_t row = begin; row < end; ++row) {
      for (std::uint32_t column = 0; column < grid.columns(); ++column) {
        pixels.push_back({grid.x(column), grid.y(static_cast<std::uint32_t>(row))});
      }
    }
    std::vector<Vec3> radiance(2 * pixels.size());
    if (!integrator.sample(pixels, 2, radiance.data(), cancel)) return;
    bounce_rays += integrator.bounce_ray_count();
    for (std::size_t p = 0; p < pixels.size(); ++p) {
      const Vec3 difference = radiance[2 * p] - radiance[2 * p + 1];
      row_sums[begin + p / grid.columns()] += 0.5 * double(glm::dot(difference, difference));
    }
  });
  double sum = 0.0;
  for (const double row : row_sums) sum += row;
  const auto points = static_cast<double>(grid.size());
  if (cancel.raised()) return {};
  return {sum / points, static_cast<double>(bounce_rays) / (2.0 * points)};
}

/// How much more time samples may take that cast `many` light rays in place of half as many.
double worthwhile(std::uint32_t many, const Trial& trial) {
  if (trial.bounce_rays == 0.0) return kWorthwhile;
  const double rest = kCostWithoutLight + kCostOfBounceRay * trial.bounce_rays;
  return (rest + many) / (rest + 0.5 * many);
}

}  // namespace

std::uint32_t choose_light_samples(const RenderContext& given, ThreadPool& pool,
                                   const Cancel& cancel) {
  RenderContext context = given;
  context.seed = 0;
  context.passes = {};
  const double pixels = 4.0 * context.camera.film_center_x * context.camera.film_center_y;
  const PixelGrid grid(context.camera, std::min(kPoints, pixels / kPixelsPerPoint));
  if (grid.size() < kFewestPoints) return kAutomaticLightSamples;
  context.light_samples = kAutomaticLightSamples;
  Trial many = try_samples(context, grid, pool, cancel);
  const std::uint32_t fewest = context.bounces > 0 ? 1 : kAutomaticLightSamples / 2;
  for (std::uint32_t n = kAutomaticLightSamples; n > fewest; n /= 2) {
    context.light_samples = n / 2;
    const Trial few = try_samples(context, grid, pool, cancel);
    if (!(few.variance < worthwhile(n, many) * many.variance)) return n;
    many = few;
  }
  return fewest;
}

}  // namespace komorebi
