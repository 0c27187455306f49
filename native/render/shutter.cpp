#include "render/shutter.h"

#include <algorithm>
#include <stdexcept>

namespace komorebi {

ShutterTable::ShutterTable(const ShutterDesc& desc, std::uint32_t height) : still_(desc.still) {
  if (still_ && (desc.rolling || !desc.curve.empty())) {
    throw std::invalid_argument("camera: a shutter that stays shut has no curve and does not roll");
  }
  if (desc.rolling) {
    if (!(desc.rolling_duration >= 0.0 && desc.rolling_duration <= 1.0)) {
      throw std::invalid_argument("camera: the rolling shutter's duration must be 0 to 1");
    }
    rolling_height_ = static_cast<float>(height);
    rolling_duration_ = static_cast<float>(desc.rolling_duration);
  }
  const std::vector<float>& curve = desc.curve;
  if (curve.empty()) return;
  const auto is_bad = [](float weight) { return !(weight >= 0.0f && weight <= 1e30f); };
  if (curve.size() < 2 || curve.size() > 1u << 16 ||
      std::any_of(curve.begin(), curve.end(), is_bad) || std::ranges::max(curve) == 0.0f) {
    throw std::invalid_argument(
        "camera: the shutter curve needs 2 to 65536 weights, finite, not negative and not all 0");
  }
  if (std::ranges::count(curve, curve.front()) == static_cast<std::ptrdiff_t>(curve.size())) return;
  density_ = curve;
  std::vector<double> sums{0.0};
  for (std::size_t i = 1; i < curve.size(); ++i) {
    sums.push_back(sums.back() + (double{curve[i - 1]} + double{curve[i]}));
  }
  for (const double sum : sums) cdf_.push_back(static_cast<float>(sum / sums.back()));
}

ShutterView ShutterTable::view() const {
  ShutterView view;
  if (!density_.empty()) view.cells = static_cast<std::uint32_t>(density_.size() - 1);
  view.cdf = cdf_.data();
  view.density = density_.data();
  view.rolling_height = rolling_height_;
  view.rolling_duration = rolling_duration_;
  view.still = still_;
  return view;
}

}  // namespace komorebi
