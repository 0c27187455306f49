#include "render/matte.h"

#include <algorithm>
#include <bit>

namespace komorebi {

void MatteSums::reset(std::size_t pixels) {
  if (pixels_.size() < pixels) pixels_.resize(pixels);
  for (std::size_t p = 0; p < pixels; ++p) pixels_[p].clear();
}

void MatteSums::add(std::size_t pixel, std::uint32_t id) {
  if (id == 0) return;
  for (IdCount& known : pixels_[pixel]) {
    if (known.id != id) continue;
    ++known.count;
    return;
  }
  pixels_[pixel].push_back({id, 1});
}

void MatteCell::add(std::uint32_t pixel, const std::vector<IdCount>& counts) {
  const auto before = [](const Entry& e, std::uint32_t p) { return e.pixel < p; };
  const auto after = [](std::uint32_t p, const Entry& e) { return p < e.pixel; };
  for (const IdCount& counted : counts) {
    auto at = std::lower_bound(entries_.begin(), entries_.end(), pixel, before);
    const auto end = std::upper_bound(at, entries_.end(), pixel, after);
    at = std::find_if(at, end, [&](const Entry& e) { return e.counted.id == counted.id; });
    if (at != end) {
      at->counted.count += counted.count;
    } else {
      entries_.insert(end, {pixel, counted});
    }
  }
}

void MatteCell::read(std::uint32_t pixel, std::uint32_t part, double samples, float* out) const {
  std::vector<IdCount> ranks;
  for (const Entry& e : entries_) {
    if (e.pixel == pixel) ranks.push_back(e.counted);
  }
  std::sort(ranks.begin(), ranks.end(), [](const IdCount& a, const IdCount& b) {
    return a.count != b.count ? a.count > b.count : a.id < b.id;
  });
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t rank = std::size_t{2} * part + k;
    const IdCount seen = rank < ranks.size() ? ranks[rank] : IdCount{};
    out[2 * k] = std::bit_cast<float>(seen.id);
    out[2 * k + 1] = static_cast<float>(seen.count / samples);
  }
}

}  // namespace komorebi
