#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace komorebi {

/// How many samples of a pixel saw the thing of this id (the bits of a Cryptomatte float).
struct IdCount {
  std::uint32_t id = 0, count = 0;
};

/// Ids that the samples of some pixels saw. Nothing is ever dropped, whatever the number of ranks
/// that are read, so that no order of samples can show.
class MatteSums {
 public:
  void reset(std::size_t pixels);
  /// 0 is no id: the sample saw nothing.
  void add(std::size_t pixel, std::uint32_t id);
  const std::vector<IdCount>& of(std::size_t pixel) const { return pixels_[pixel]; }

 private:
  std::vector<std::vector<IdCount>> pixels_;  // few ids each; they keep their memory
};

/// The same for one cell of the film, in twelve bytes an id.
class MatteCell {
 public:
  /// Adds a pixel's counts; `pixel` counts within the cell.
  void add(std::uint32_t pixel, const std::vector<IdCount>& counts);
  /// Writes ranks 2 · part and 2 · part + 1 of a pixel as id, coverage, id, coverage, of so many
  /// samples. The ranks go by coverage, and by id among equals.
  void read(std::uint32_t pixel, std::uint32_t part, double samples, float* out) const;
  std::size_t byte_count() const { return entries_.capacity() * sizeof(Entry); }

 private:
  struct Entry {
    std::uint32_t pixel;
    IdCount counted;
  };
  std::vector<Entry> entries_;  // by pixel
};

}  // namespace komorebi
