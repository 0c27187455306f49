#include "render/mesh_attributes.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include "bvh/topology.h"

namespace komorebi {
namespace {

[[noreturn]] void refuse(const std::string& what, const AttributeInput& input,
                         const std::string& why) {
  throw std::invalid_argument(what + ": attribute \"" + input.name + "\" " + why);
}

const AttributeRows& rows_of(const std::string& what, const AttributeInput& input,
                             std::span<const AttributeRows> rows) {
  const auto found = std::ranges::find(rows, input.domain, &AttributeRows::domain);
  if (found == rows.end()) refuse(what, input, "has a domain that is not there");
  if (input.components < 1 || input.components > 4) {
    refuse(what, input, "must have one to four components");
  }
  if (input.data.size() != found->given * input.components) {
    refuse(what, input, std::string("must have one row a ") + found->element);
  }
  return *found;
}

/// Fills `to` with the rows that a hit finds; how many numbers in them are not finite.
std::size_t gather(const AttributeInput& input, const AttributeRows& rows, Array<float>& to,
                   ThreadPool& pool, const Cancel& cancel) {
  constexpr std::size_t kGrain = 1 << 14;
  const std::size_t width = input.components;
  to.resize(rows.kept * width);
  std::atomic<std::size_t> bad{0};
  pool.for_each_chunk(rows.kept, kGrain, [&](std::size_t begin, std::size_t end) {
    check(cancel);
    std::size_t found = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const float* from = &input.data[width * (rows.gather.empty() ? i : rows.gather[i])];
      for (std::size_t k = 0; k < width; ++k) {
        const bool finite = std::isfinite(from[k]);
        to[width * i + k] = finite ? from[k] : 0.0f;
        found += finite ? 0 : 1;
      }
    }
    if (found) bad += found;
  });
  if (bad == 0) return 0;
  return static_cast<std::size_t>(
      std::ranges::count_if(input.data, [](float x) { return !std::isfinite(x); }));
}

}  // namespace

MeshAttributes::MeshAttributes(const std::string& what, std::span<const AttributeInput> inputs,
                               std::span<const AttributeRows> rows, ThreadPool& pool,
                               const Cancel& cancel) {
  names_.reserve(inputs.size());  // views point to them
  for (const AttributeInput& input : inputs) {
    if (std::ranges::find(names_, input.name) != names_.end()) refuse(what, input, "comes twice");
    const AttributeRows& its = rows_of(what, input, rows);
    const std::size_t bad = gather(input, its, data_.emplace_back(), pool, cancel);
    names_.push_back(input.name);
    if (bad > 0) {
      warnings_.push_back(what + ": attribute \"" + input.name + "\" has " + std::to_string(bad) +
                          (bad == 1 ? " number that is" : " numbers that are") +
                          " not finite and taken for 0");
    }
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    views_.push_back({names_[i].c_str(), inputs[i].domain, inputs[i].components, data_[i].data()});
  }
}

std::size_t MeshAttributes::byte_count() const {
  std::size_t sum = sizeof(MeshAttributes) + views_.capacity() * sizeof(AttributeView);
  for (const auto& data : data_) sum += data.capacity() * sizeof(float);
  for (const auto& name : names_) sum += sizeof(std::string) + name.capacity();
  return sum;
}

}  // namespace komorebi
