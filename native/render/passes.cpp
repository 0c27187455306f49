#include "render/passes.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace komorebi {
namespace {

using enum PassRule;

constexpr PassDesc kPasses[] = {
    {"Combined", 4, kMean},
    {"Depth", 1, kFirstSample, Quantity::kDepth},
    {"Position", 3, kFirstSample, Quantity::kPosition},
    {"Object Index", 1, kFirstSample, Quantity::kObjectIndex},
    {"Material Index", 1, kFirstSample, Quantity::kMaterialIndex},
    {"Instance Index", 1, kFirstSample, Quantity::kInstanceIndex},
    {"Normal", 3, kMean, Quantity::kNormal},
    {"UV", 3, kMean, Quantity::kUv},
    {"Vector", 4, kMeanOfHits, Quantity::kVector},
    {"Mist", 1, kMean, Quantity::kMist},
    {"Environment", 3, kMean, Quantity::kEnvironment},
    {"Diffuse Color", 3, kMean, Quantity::kDiffuseColor},
    {"Emission", 3, kMean, Quantity::kEmission},
    {"Denoising Normal", 3, kMean, Quantity::kDenoisingNormal},
    {"Denoising Roughness", 1, kMean, Quantity::kDenoisingRoughness},
    {"Denoising Depth", 1, kMean, Quantity::kDenoisingDepth},
    {"Ambient Occlusion", 1, kMean, Quantity::kAmbientOcclusion},
    {"Sky Visibility", 1, kMean, Quantity::kSkyVisibility},
    {"Bent Normal", 3, kDirection, Quantity::kBentNormal},
    {"Shadow Catcher", 3, kCatcher},
    {"Variance", 3, kVariance},
    {"Debug Sample Count", 1, kCount},
};

constexpr PassDesc kMatteParts[kMattes] = {
    {"CryptoObject", 4, PassRule::kMatte, Quantity::kMatteObject},
    {"CryptoMaterial", 4, PassRule::kMatte, Quantity::kMatteMaterial},
    {"CryptoAsset", 4, PassRule::kMatte, Quantity::kMatteAsset},
};

constexpr PassDesc kMaterialValues[] = {
    {"Material Value", 1, PassRule::kMean, Quantity::kMaterialValue},
    {"Material Value", 2, PassRule::kMean, Quantity::kMaterialValue},
    {"Material Value", 3, PassRule::kMean, Quantity::kMaterialValue},
    {"Material Value", 4, PassRule::kMean, Quantity::kMaterialValue},
};
constexpr std::uint32_t kMaxValues = 4096;

/// The two numbers of "Material Value f n"; n = 0 for another name.
struct ValueRange {
  std::uint32_t first = 0, count = 0;
};
ValueRange value_range(const std::string& name) {
  const std::string prefix = std::string(kMaterialValues[0].name) + " ";
  if (!name.starts_with(prefix)) return {};
  ValueRange range;
  const char* end = name.data() + name.size();
  const auto [rest, bad] = std::from_chars(name.data() + prefix.size(), end, range.first);
  if (bad != std::errc() || rest == end || *rest != ' ') return {};
  const auto [last, worse] = std::from_chars(rest + 1, end, range.count);
  const bool good = worse == std::errc() && last == end && range.count >= 1 && range.count <= 4 &&
                    range.first < kMaxValues;
  return good ? range : ValueRange{};
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_part_of(const std::string& name, const std::string& matte) {
  return name.size() == matte.size() + 2 && name.starts_with(matte) &&
         is_digit(name[name.size() - 2]) && is_digit(name.back()) &&
         matte_part(name) < kMaxMatteRanks / 2;
}

bool in_group(Quantity q, Quantity first, Quantity last) {
  return q >= first && q <= last;
}

}  // namespace

std::span<const PassDesc> known_passes() {
  return kPasses;
}

const PassDesc& find_pass(const std::string& name) {
  for (const PassDesc& p : kPasses) {
    if (name == p.name) return p;
  }
  for (const PassDesc& p : kMatteParts) {
    if (is_part_of(name, p.name)) return p;
  }
  const std::uint32_t values = value_range(name).count;
  if (values > 0) return kMaterialValues[values - 1];
  throw std::invalid_argument("there is no pass \"" + name + "\"");
}

std::uint32_t matte_part(const std::string& name) {
  return static_cast<std::uint32_t>(10 * (name[name.size() - 2] - '0') + (name.back() - '0'));
}

std::uint32_t first_value(const std::string& name) {
  return value_range(name).first;
}

std::uint32_t PassLayout::channels_of(Quantity q) const {
  if (q == Quantity::kMaterialValue) return values;
  if (q == Quantity::kCatcherLight) return 3;
  if (q == Quantity::kMatte) return 4;
  for (const PassDesc& p : kPasses) {
    if (p.quantity == q) return p.channels;
  }
  return 1;  // an id or a weight
}

PassLayout::PassLayout() {
  std::fill(std::begin(place), std::end(place), kNone);
}

bool PassLayout::keeps_ambient() const {
  return keeps(Quantity::kAmbientOcclusion) || keeps(Quantity::kSkyVisibility) ||
         keeps(Quantity::kBentNormal);
}

PassLayout make_pass_layout(const std::vector<std::string>& passes, bool catchers,
                            bool film_transparent) {
  PassLayout layout;
  bool wanted[kQuantities] = {};
  const auto want = [&](Quantity q) { wanted[static_cast<std::size_t>(q)] = true; };
  for (const std::string& name : passes) {
    const PassDesc& pass = find_pass(name);
    if (pass.quantity != Quantity::kCount) want(pass.quantity);
    if (pass.rule == PassRule::kMeanOfHits) want(Quantity::kVectorWeight);
    if (pass.quantity == Quantity::kMaterialValue) {
      const std::uint32_t end = first_value(name) + pass.channels;
      layout.values = std::max(layout.values, static_cast<std::uint16_t>(end));
    }
    layout.keeps_variance |= pass.rule == PassRule::kVariance;
  }
  if (catchers) {
    want(Quantity::kCatcherLight);
    want(Quantity::kMatte);
    if (!film_transparent) want(Quantity::kEnvironment);
  }
  std::uint32_t next = 0;
  const auto place_group = [&](Quantity first, Quantity last) {
    const std::uint32_t begin = next;
    for (std::size_t q = 0; q < kQuantities; ++q) {
      const auto quantity = static_cast<Quantity>(q);
      if (!wanted[q] || !in_group(quantity, first, last)) continue;
      layout.place[q] = static_cast<std::int16_t>(next);
      next += layout.channels_of(quantity);
    }
    return static_cast<std::uint16_t>(next - begin);
  };
  layout.means = place_group(Quantity::kNormal, Quantity::kMatte);
  layout.firsts = place_group(Quantity::kDepth, Quantity::kInstanceIndex);
  layout.ids = place_group(Quantity::kMatteObject, Quantity::kMatteAsset);
  return layout;
}

}  // namespace komorebi
