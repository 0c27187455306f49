#pragma once

#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace komorebi::testing {

/// Triangles as the core takes them. Polygons are cut into fans: for tests any cut will do.
struct TriangleMesh {
  std::vector<float> vtx2xyz;
  std::vector<std::uint32_t> tri2vtx;
  std::size_t dropped_triangles = 0;  ///< with a position that is not finite

  std::size_t triangle_count() const { return tri2vtx.size() / 3; }

  void add_polygon(const std::vector<std::int64_t>& corners) {
    const auto count = static_cast<std::int64_t>(vtx2xyz.size() / 3);
    for (const std::int64_t corner : corners) {
      if (corner < 0 || corner >= count) throw std::runtime_error("corner out of range");
    }
    for (std::size_t k = 2; k < corners.size(); ++k) {
      tri2vtx.push_back(static_cast<std::uint32_t>(corners[0]));
      tri2vtx.push_back(static_cast<std::uint32_t>(corners[k - 1]));
      tri2vtx.push_back(static_cast<std::uint32_t>(corners[k]));
    }
  }

  /// What the boundary of the core refuses is left out here, and counted.
  void drop_not_finite() {
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < tri2vtx.size(); i += 3) {
      bool finite = true;
      for (std::size_t k = 0; k < 9; ++k) {
        finite = finite && std::isfinite(vtx2xyz[3 * std::size_t{tri2vtx[i + k / 3]} + k % 3]);
      }
      if (!finite) {
        ++dropped_triangles;
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) kept.push_back(tri2vtx[i + k]);
    }
    tri2vtx = std::move(kept);
  }
};

/// The bytes of a file, unpacked if it is a .gz.
inline std::string read_bytes(const std::filesystem::path& path) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), &gzclose);
  if (!file) throw std::runtime_error("cannot open " + path.string());
  std::string bytes;
  std::vector<char> part(1 << 20);
  for (int got = 1; got > 0;) {
    got = gzread(file.get(), part.data(), static_cast<unsigned>(part.size()));
    if (got < 0) throw std::runtime_error("cannot read " + path.string());
    bytes.append(part.data(), static_cast<std::size_t>(got));
  }
  return bytes;
}

/// Words of a text, one after the other.
class Words {
 public:
  explicit Words(const char* at) : at_(at) {}
  double number() {
    char* end = nullptr;
    const double value = std::strtod(at_, &end);
    if (end == at_) throw std::runtime_error("a number is missing");
    at_ = end;
    return value;
  }

 private:
  const char* at_;
};

}  // namespace komorebi::testing
