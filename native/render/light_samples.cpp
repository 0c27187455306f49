#include "render/light_samples.h"

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

/// The mean over pixels of the variance of a camera sample's radiance with so many light rays,
/// from two samples a pixel; 0 when cancelled.
double sample_variance(const RenderContext& context, const PixelGrid& grid, ThreadPool& pool,
                       const Cancel& cancel) {
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
    for (std::size_t p = 0; p < pixels.size(); ++p) {
      const Vec3 difference = radiance[2 * p] - radiance[2 * p + 1];
      row_sums[begin + p / grid.columns()] += 0.5 * double(glm::dot(difference, difference));
    }
  });
  double sum = 0.0;
  for (const double row : row_sums) sum += row;
  return cancel.raised() ? 0.0 : sum / static_cast<double>(grid.size());
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
  const double many = sample_variance(context, grid, pool, cancel);
  context.light_samples = kAutomaticLightSamples / 2;
  const double few = sample_variance(context, grid, pool, cancel);
  return few < kWorthwhile * many ? kAutomaticLightSamples / 2 : kAutomaticLightSamples;
}

}  // namespace komorebi
