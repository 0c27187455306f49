#include "render/environment.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "render/quantized_cdf.h"

namespace komorebi {
Environment::Environment(std::string name, std::uint32_t width, std::uint32_t height,
                         std::vector<float> texels)
    : name_(std::move(name)), width_(width), height_(height), texels_(std::move(texels)) {
  const std::uint64_t count = std::uint64_t{width} * height;
  if (count == 0 || width > 1u << 20 || height > 1u << 20) {
    throw std::invalid_argument("environment \"" + name_ + "\": cannot be " +
                                std::to_string(width) + " × " + std::to_string(height) + " pixels");
  }
  if (texels_.size() != 3 * count) {
    throw std::invalid_argument("environment \"" + name_ + "\": " + std::to_string(3 * count) +
                                " values expected, " + std::to_string(texels_.size()) + " given");
  }
  clean_texels();
  build_tables();
}

void Environment::clean_texels() {
  for (std::size_t i = 0; i < texels_.size(); i += 3) {
    float* p = &texels_[i];
    if (!(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]))) {
      p[0] = p[1] = p[2] = 0.0f;
      ++nonfinite_texels_;
    } else if (p[0] < 0.0f || p[1] < 0.0f || p[2] < 0.0f) {
      for (int c = 0; c < 3; ++c) p[c] = p[c] < 0.0f ? 0.0f : p[c];
      ++negative_texels_;
    }
    for (int c = 0; c < 3; ++c) max_radiance_ = p[c] > max_radiance_ ? p[c] : max_radiance_;
  }
}

void Environment::build_tables() {
  const std::uint32_t rows = height_ + 1;
  row_z_.resize(rows + 1);
  row_z_[0] = -1.0;
  row_z_[rows] = 1.0;
  for (std::uint32_t r = 1; r < rows; ++r) {  // edges at the texel rows' centres
    const double v = (r - 0.5) / height_;
    row_z_[r] = sin_cos_turns(0.5 * v - 0.25).sin;
  }

  EnvironmentView e;
  e.width = width_;
  e.height = height_;
  e.texels = texels_.data();
  column_cdf_.resize(std::size_t{rows} * (width_ + 1));
  row_cdf_.resize(rows + 1);
  std::vector<double> column_weight(width_), row_weight(rows);
  for (std::uint32_t r = 0; r < rows; ++r) {
    for (std::uint32_t c = 0; c < width_; ++c) {
      const auto w = detail::patch_weights(e, detail::environment_patch(e, r, c));
      column_weight[c] =
          double{w.low_left} + double{w.low_right} + double{w.high_left} + double{w.high_right};
    }
    row_weight[r] = quantize_cdf(column_weight, &column_cdf_[std::size_t{r} * (width_ + 1)]) *
                    (row_z_[r + 1] - row_z_[r]);
  }
  if (!(quantize_cdf(row_weight, row_cdf_.data()) > 0.0)) {
    row_cdf_.clear();
    column_cdf_.clear();
    row_z_.clear();
  }
}

EnvironmentView Environment::view(double strength, const Mat3d& texture_from_world) const {
  if (!(strength >= 0.0 && std::isfinite(strength))) {
    throw std::invalid_argument("environment \"" + name_ + "\": the strength must not be negative");
  }
  const Mat3d product = glm::transpose(texture_from_world) * texture_from_world;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      if (!(std::abs(product[c][r] - (c == r ? 1.0 : 0.0)) < 1e-4)) {
        throw std::invalid_argument("environment \"" + name_ +
                                    "\": its mapping must be a rotation");
      }
    }
  }
  if (black()) return constant_environment(Vec3(0.0f));
  EnvironmentView view;
  view.texture_from_world = Mat3(texture_from_world);
  view.strength = static_cast<float>(strength);
  view.width = width_;
  view.height = height_;
  view.texels = texels_.data();
  view.row_cdf = row_cdf_.data();
  view.column_cdf = column_cdf_.data();
  view.row_z = row_z_.data();
  return view;
}

const ProductTable& Environment::product_table() const {
  std::call_once(product_once_,
                 [this] { product_table_ = std::make_unique<const ProductTable>(view()); });
  return *product_table_;
}

double Environment::mean_flux() const {
  std::call_once(flux_once_, [this] {
    const auto z_at = [&](std::uint32_t row) {  // the lower edge of a row of texels
      return sin_cos_turns(0.5 * row / height_ - 0.25).sin;
    };
    const float* texel = texels_.data();
    for (std::uint32_t r = 0; r < height_; ++r) {
      double sum = 0.0;
      for (std::uint32_t i = 0; i < 3 * width_; ++i) sum += double{*texel++};
      mean_flux_ += sum / 3.0 * (2.0 * kPi / width_) * (z_at(r + 1) - z_at(r));
    }
  });
  return mean_flux_;
}

std::size_t Environment::byte_count() const {
  return sizeof(float) * texels_.size() +
         sizeof(std::uint32_t) * (row_cdf_.size() + column_cdf_.size()) +
         sizeof(double) * row_z_.size();
}

EnvironmentView constant_environment(const Vec3& radiance) {
  EnvironmentView view;
  view.constant = radiance;
  return view;
}

}  // namespace komorebi
