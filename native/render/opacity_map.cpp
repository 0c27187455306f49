#include "render/opacity_map.h"

#include <algorithm>
#include <bit>
#include <memory>

#include "core/attribute.h"
#include "core/sampler.h"
#include "shader/program_bounds.h"

namespace komorebi {
namespace {

constexpr std::uint32_t kMostLists = 4;          // of a mesh that have a map
constexpr std::size_t kMostPatterns = 1u << 17;  // triangles that are told apart
constexpr std::size_t kMostCells = 1u << 21;     // of all; four are a byte
constexpr std::uint32_t kLongestSide = 128;

/// Beyond what a hit's barycentrics and an attribute that is interpolated by them err by, as a part
/// of the largest of the attribute's values at the corners.
constexpr float kAttributeError = 1.0f / (1 << 19);

/// A part of the barycentric square: of side size / side from (i, j) / side, cut off at u + v = 1.
struct Square {
  std::uint32_t i, j, size;
};

}  // namespace

/// The programs of one material on intervals.
class MaterialBounds {
 public:
  MaterialBounds(const ClearPrograms& clear, TextureBoundsTable& textures, ThreadPool& pool) {
    for (std::size_t kind = 0; kind < 3; ++kind) {
      const Program* program = clear.of_kind[kind].get();
      bool known = false;
      for (std::size_t k = 0; k < kind; ++k) known |= clear.of_kind[k].get() == program;
      if (!known) programs_.emplace_back(*program, textures, pool);
    }
    for (const ProgramBounds& program : programs_) {
      for (const std::string& name : program.attributes()) {
        if (std::ranges::find(names_, name) == names_.end()) names_.push_back(name);
      }
    }
  }

  /// Of all of the programs' attributes.
  const std::vector<std::string>& names() const { return names_; }

  /// @param attributes  [names()][4]
  OpacityMap::Cell cell(const FloatRange (*attributes)[4], std::vector<FloatRange>& values) const {
    bool solid = true, clear = true;
    for (const ProgramBounds& program : programs_) {
      FloatRange own[kMostAttributes][4];
      const std::size_t count = program.attributes().size();
      if (count > kMostAttributes) return OpacityMap::Cell::kUnknown;
      for (std::size_t a = 0; a < count; ++a) {
        const auto at = std::ranges::find(names_, program.attributes()[a]) - names_.begin();
        std::copy_n(attributes[at], 4, own[a]);
      }
      FloatRange out[3];
      program.run(own, values, out);
      // As clear_share() has it.
      const FloatRange share = ((out[0] + out[1]) + out[2]) * FloatRange::of(1.0f / 3.0f);
      solid = solid && share.hi <= OpacityMap::kSure;
      clear = clear && share.known() && share.lo >= 1.0f - OpacityMap::kSure;
    }
    return solid   ? OpacityMap::Cell::kSolid
           : clear ? OpacityMap::Cell::kClear
                   : OpacityMap::Cell::kUnknown;
  }

  static constexpr std::size_t kMostAttributes = 8;

 private:
  std::vector<ProgramBounds> programs_;
  std::vector<std::string> names_;
};

class OpacityMapBuilder {
 public:
  OpacityMapBuilder(OpacityMap& map, const SceneView& scene, const SceneTables& tables,
                    std::span<const ClearPrograms> clear, ThreadPool& pool, const Cancel& cancel)
      : map_(map), scene_(scene), tables_(tables), clear_(clear), pool_(pool), cancel_(cancel) {}

  void build() {
    bounds_.resize(clear_.size());
    for (std::size_t m = 0; m < clear_.size(); ++m) {
      if (clear_[m].exist()) {
        bounds_[m] = std::make_unique<MaterialBounds>(clear_[m], textures_, pool_);
      }
    }
    find_lists();
    find_patterns();
    choose_side();
    fill();
  }

 private:
  /// A material on a triangle that stands for all others with the same attributes.
  struct Pattern {
    std::uint32_t material, mesh, triangle, hash;
  };

  void find_lists() {
    std::vector<std::vector<std::uint32_t>> lists(scene_.mesh_count);
    for (std::uint32_t i = 0; i < scene_.instance_count; ++i) {
      const InstanceView& instance = scene_.instances[i];
      if (!instance.filtered || is_round(scene_.meshes[instance.mesh].kind)) continue;
      auto& own = lists[instance.mesh];
      if (std::ranges::find(own, instance.material_slots) != own.end()) continue;
      if (own.size() < kMostLists) own.push_back(instance.material_slots);
    }
    std::size_t triangles = 0;
    for (std::uint32_t m = 0; m < scene_.mesh_count; ++m) {
      map_.mesh2first_.push_back(static_cast<std::uint32_t>(map_.lists_.size()));
      for (const std::uint32_t list : lists[m]) {
        map_.lists_.push_back({list, triangles});
        triangles += scene_.meshes[m].triangle_count;
      }
    }
    map_.mesh2first_.push_back(static_cast<std::uint32_t>(map_.lists_.size()));
    map_.tri2pattern_.resize(triangles);
  }

  void find_patterns() {
    table_.assign(1024, kNone);
    for (std::uint32_t m = 0; m < scene_.mesh_count; ++m) {
      const MeshView& mesh = scene_.meshes[m];
      for (std::uint32_t l = map_.mesh2first_[m]; l < map_.mesh2first_[m + 1]; ++l) {
        std::uint32_t* const patterns = &map_.tri2pattern_[map_.lists_[l].first_triangle];
        for (std::uint32_t t = 0; t < mesh.triangle_count; ++t) {
          if (t % 65536 == 0 && cancel_.raised()) throw Cancelled();
          const std::uint32_t slot = mesh.tri2material ? mesh.tri2material[t] : 0;
          const std::uint32_t material =
              tables_.material_index(map_.lists_[l].material_slots, slot);
          if (material >= bounds_.size() || !bounds_[material]) {
            patterns[t] = static_cast<std::uint32_t>(OpacityMap::Cell::kSolid);
          } else {
            patterns[t] = pattern_of({material, m, t, 0});
          }
        }
      }
    }
    map_.pattern_count_ = patterns_.size();
  }

  /// Calls f(value) for what the material's attributes are at a triangle's corners.
  template <class F>
  void each_corner(const Pattern& p, F f) const {
    const MeshView& mesh = scene_.meshes[p.mesh];
    for (const std::string& name : bounds_[p.material]->names()) {
      const AttributeView* found = find_attribute(mesh, name.c_str());
      if (found == nullptr) {
        f(Vec4(0.0f));
        continue;
      }
      f(attribute_at(mesh, *found, p.triangle, 0.0f, 0.0f));
      f(attribute_at(mesh, *found, p.triangle, 1.0f, 0.0f));
      f(attribute_at(mesh, *found, p.triangle, 0.0f, 1.0f));
    }
  }

  void corners(const Pattern& p, std::vector<Vec4>& values) const {
    values.clear();
    each_corner(p, [&](const Vec4& value) { values.push_back(value); });
  }

  std::uint32_t pattern_of(Pattern pattern) {
    pattern.hash = hash_bits(pattern.material + 1);
    each_corner(pattern, [&](const Vec4& value) {
      for (int c = 0; c < 4; ++c) {
        pattern.hash = hash_combine(pattern.hash, std::bit_cast<std::uint32_t>(value[c]));
      }
    });
    const auto mask = static_cast<std::uint32_t>(table_.size() - 1);
    std::uint32_t at = pattern.hash & mask;
    for (; table_[at] != kNone; at = (at + 1) & mask) {
      if (same(patterns_[table_[at]], pattern)) return OpacityMap::kFirstPattern + table_[at];
    }
    if (patterns_.size() == kMostPatterns) {
      return static_cast<std::uint32_t>(OpacityMap::Cell::kUnknown);
    }
    table_[at] = static_cast<std::uint32_t>(patterns_.size());
    patterns_.push_back(pattern);
    if (2 * patterns_.size() > table_.size()) grow();
    return OpacityMap::kFirstPattern + static_cast<std::uint32_t>(patterns_.size() - 1);
  }

  bool same(const Pattern& a, const Pattern& b) {
    if (a.hash != b.hash || a.material != b.material) return false;
    corners(a, of_a_);
    corners(b, of_b_);
    return of_a_ == of_b_;
  }

  void grow() {
    std::vector<std::uint32_t>(2 * table_.size(), kNone).swap(table_);
    const auto mask = static_cast<std::uint32_t>(table_.size() - 1);
    for (std::uint32_t p = 0; p < patterns_.size(); ++p) {
      std::uint32_t at = patterns_[p].hash & mask;
      while (table_[at] != kNone) at = (at + 1) & mask;
      table_[at] = p;
    }
  }

  void choose_side() {
    const auto cells = [](std::size_t side) { return (side * (side + 1) / 2 + 3) / 4 * 4; };
    map_.side_ = kLongestSide;
    while (map_.side_ > 1 && patterns_.size() * cells(map_.side_) > kMostCells) map_.side_ /= 2;
    map_.cells_ = cells(map_.side_);
    map_.bits_.resize(patterns_.size() * map_.cells_ / 4);
  }

  void fill() {
    pool_.for_each_chunk(patterns_.size(), 16, [&](std::size_t begin, std::size_t end) {
      std::vector<FloatRange> values;
      for (std::size_t p = begin; p < end; ++p) {
        if (cancel_.raised()) return;
        fill_square(p, {0, 0, map_.side_}, values);
      }
    });
    if (cancel_.raised()) throw Cancelled();
  }

  /// A square is halved until it is all alike, or a cell.
  void fill_square(std::size_t pattern, const Square& square, std::vector<FloatRange>& values) {
    const OpacityMap::Cell found = judge(patterns_[pattern], square, values);
    if (found == OpacityMap::Cell::kUnknown && square.size > 1) {
      const std::uint32_t half = square.size / 2;
      for (std::uint32_t k = 0; k < 4; ++k) {
        const Square part{square.i + (k & 1 ? half : 0), square.j + (k & 2 ? half : 0), half};
        if (part.i + part.j < map_.side_) fill_square(pattern, part, values);
      }
      return;
    }
    for (std::uint32_t j = square.j; j < square.j + square.size; ++j) {
      for (std::uint32_t i = square.i; i < square.i + square.size && i + j < map_.side_; ++i) {
        const std::size_t at = pattern * map_.cells_ + map_.place(i, j);
        map_.bits_[at / 4] |=
            static_cast<std::uint8_t>(static_cast<unsigned>(found) << (2 * (at % 4)));
      }
    }
  }

  OpacityMap::Cell judge(const Pattern& pattern, const Square& square,
                         std::vector<FloatRange>& values) const {
    const MaterialBounds& bounds = *bounds_[pattern.material];
    const std::vector<std::string>& names = bounds.names();
    if (names.size() > MaterialBounds::kMostAttributes) return OpacityMap::Cell::kUnknown;
    const MeshView& mesh = scene_.meshes[pattern.mesh];
    const float per_cell = 1.0f / static_cast<float>(map_.side_);
    const float u = static_cast<float>(square.i) * per_cell;
    const float v = static_cast<float>(square.j) * per_cell;
    const float size = static_cast<float>(square.size) * per_cell;
    const int places = square.i + square.j + square.size < map_.side_ ? 4 : 3;  // on the diagonal
    FloatRange attributes[MaterialBounds::kMostAttributes][4];
    for (std::size_t a = 0; a < names.size(); ++a) {
      const AttributeView* found = find_attribute(mesh, names[a].c_str());
      if (found == nullptr) {
        std::fill_n(attributes[a], 4, FloatRange::of(0.0f));
        continue;
      }
      const auto at = [&](float x, float y) {
        return attribute_at(mesh, *found, pattern.triangle, x, y);
      };
      const Vec4 ends[] = {at(u, v), at(u + size, v), at(u, v + size), at(u + size, v + size)};
      const Vec4 far = glm::max(glm::abs(at(0.0f, 0.0f)),
                                glm::max(glm::abs(at(1.0f, 0.0f)), glm::abs(at(0.0f, 1.0f))));
      for (int c = 0; c < 4; ++c) {
        FloatRange all = FloatRange::of(ends[0][c]);
        for (int k = 1; k < places; ++k) all = joined(all, FloatRange::of(ends[k][c]));
        attributes[a][c] = widened(all, kAttributeError * far[c]);
      }
    }
    return bounds.cell(attributes, values);
  }

  OpacityMap& map_;
  const SceneView& scene_;
  const SceneTables& tables_;
  std::span<const ClearPrograms> clear_;
  ThreadPool& pool_;
  const Cancel& cancel_;
  TextureBoundsTable textures_;
  std::vector<std::unique_ptr<MaterialBounds>> bounds_;  // of materials; null: opaque
  std::vector<Pattern> patterns_;
  std::vector<std::uint32_t> table_;  // of patterns by hash; kNone: free
  std::vector<Vec4> of_a_, of_b_;
};

OpacityMap::OpacityMap(const SceneView& scene, const SceneTables& tables,
                       std::span<const ClearPrograms> clear, ThreadPool& pool,
                       const Cancel& cancel) {
  OpacityMapBuilder(*this, scene, tables, clear, pool, cancel).build();
}

std::size_t OpacityMap::byte_count() const {
  return mesh2first_.capacity() * sizeof(std::uint32_t) + lists_.capacity() * sizeof(List) +
         tri2pattern_.capacity() * sizeof(std::uint32_t) + bits_.capacity();
}

}  // namespace komorebi
