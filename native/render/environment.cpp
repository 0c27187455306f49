#include "render/environment.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "render/quantized_cdf.h"

namespace komorebi {
namespace {

/// The luminance of a row of texels.
void row_luminance(const EnvironmentView& e, std::uint32_t row, float* out) {
  for (std::uint32_t c = 0; c < e.width; ++c) {
    out[c] = luminance(detail::environment_texel(e, c, row));
  }
}

}  // namespace

Environment::Environment(LightMap map, ThreadPool& pool, const Cancel& cancel)
    : map_(std::move(map)) {
  build_tables(pool, cancel);
}

Environment::Environment(std::string name, std::uint32_t width, std::uint32_t height,
                         const std::vector<float>& texels)
    : map_(make_light_map(std::move(name), width, height, texels)) {
  ThreadPool pool(1);
  build_tables(pool, Cancel::never());
}

EnvironmentView Environment::texel_view() const {
  EnvironmentView e;
  e.width = width();
  e.height = height();
  e.storage = map_.storage();
  e.texels = map_.floats();
  e.words = map_.words();
  return e;
}

void Environment::build_tables(ThreadPool& pool, const Cancel& cancel) {
  const std::uint32_t rows = height() + 1, columns = width();
  row_z_.resize(rows + 1);
  row_z_[0] = -1.0;
  row_z_[rows] = 1.0;
  for (std::uint32_t r = 1; r < rows; ++r) {  // edges at the texel rows' centres
    const double v = (r - 0.5) / height();
    row_z_[r] = sin_cos_turns(0.5 * v - 0.25).sin;
  }

  const EnvironmentView e = texel_view();
  column_cdf_.resize(std::size_t{rows} * (columns + 1));
  row_cdf_.resize(rows + 1);
  std::vector<double> row_weight(rows);
  pool.for_each_chunk(rows, 16, [&](std::size_t first, std::size_t last) {
    if (cancel.raised()) return;
    std::vector<double> weight(columns);
    std::vector<float> low(columns), high(columns);
    row_luminance(e, first == 0 ? height() - 1 : static_cast<std::uint32_t>(first - 1),
                  high.data());
    for (std::size_t r = first; r < last; ++r) {
      std::swap(low, high);
      row_luminance(e, r == height() ? 0 : static_cast<std::uint32_t>(r), high.data());
      for (std::uint32_t c = 0; c < columns; ++c) {
        const std::uint32_t right = c + 1 == columns ? 0 : c + 1;
        const auto w = detail::patch_weights(r == 0, r == height(),
                                             {low[c], low[right], high[c], high[right]});
        weight[c] =
            double{w.low_left} + double{w.low_right} + double{w.high_left} + double{w.high_right};
      }
      row_weight[r] =
          quantize_cdf(weight, &column_cdf_[r * (columns + 1)]) * (row_z_[r + 1] - row_z_[r]);
    }
  });
  cancel.check();
  if (!(quantize_cdf(row_weight, row_cdf_.data()) > 0.0)) {
    row_cdf_.clear();
    column_cdf_ = {};
    row_z_.clear();
  }
}

EnvironmentView Environment::view(double strength, const Mat3d& texture_from_world) const {
  if (!(strength >= 0.0 && std::isfinite(strength))) {
    throw std::invalid_argument("environment \"" + name() +
                                "\": the strength must not be negative");
  }
  const Mat3d product = glm::transpose(texture_from_world) * texture_from_world;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      if (!(std::abs(product[c][r] - (c == r ? 1.0 : 0.0)) < 1e-4)) {
        throw std::invalid_argument("environment \"" + name() +
                                    "\": its mapping must be a rotation");
      }
    }
  }
  if (black()) return constant_environment(Vec3(0.0f));
  EnvironmentView view = texel_view();
  view.texture_from_world = Mat3(texture_from_world);
  view.strength = static_cast<float>(strength);
  view.row_cdf = row_cdf_.data();
  view.column_cdf = column_cdf_.data();
  view.row_z = row_z_.data();
  return view;
}

const ProductTable& Environment::product_table(const Cancel& cancel) const {
  std::call_once(product_once_,
                 [&] { product_table_ = std::make_unique<const ProductTable>(view(), cancel); });
  return *product_table_;
}

double Environment::mean_flux(const Cancel& cancel) const {
  std::call_once(flux_once_, [&] {
    const auto z_at = [&](std::uint32_t row) {  // the lower edge of a row of texels
      return sin_cos_turns(0.5 * row / height() - 0.25).sin;
    };
    std::uint64_t texel = 0;
    mean_flux_ = 0.0;
    for (std::uint32_t r = 0; r < height(); ++r) {
      cancel.check();
      double sum = 0.0;
      for (std::uint32_t i = 0; i < width(); ++i) {
        const Vec3 value = map_.texel(texel++);
        for (int c = 0; c < 3; ++c) sum += double{value[c]};
      }
      mean_flux_ += sum / 3.0 * (2.0 * kPi / width()) * (z_at(r + 1) - z_at(r));
    }
  });
  return mean_flux_;
}

std::size_t Environment::byte_count() const {
  return map_.byte_count() + sizeof(std::uint32_t) * (row_cdf_.size() + column_cdf_.size()) +
         sizeof(double) * row_z_.size();
}

EnvironmentView constant_environment(const Vec3& radiance) {
  EnvironmentView view;
  view.constant = radiance;
  return view;
}

}  // namespace komorebi
