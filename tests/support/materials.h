#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/material.h"

namespace komorebi::testing {

/// Writes programs down, as an exporter does.
class MadeProgram {
 public:
  using Vec = std::vector<Operand>;  // 1 or 3

  static Vec number(double r) { return {constant(r)}; }
  static Vec color(double r, double g, double b) { return {constant(r), constant(g), constant(b)}; }

  Vec input(const std::string& name, std::uint32_t width = 3) {
    return add({"input", {}, {}, {}, name, nullptr}, width);
  }
  Vec attribute(const std::string& name) {
    return add({"attribute", {}, {}, {}, name, nullptr}, 4);
  }
  /// Channel by channel; one number goes with all.
  Vec each(const std::string& op, const Vec& a, const Vec& b) {
    Vec out;
    for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
      out.push_back(
          add({op, {a[a.size() > 1 ? i : 0], b[b.size() > 1 ? i : 0]}, {}, {}, "", nullptr}, 1)[0]);
    }
    return out;
  }

  /// Any operation, on one vector after the other.
  Vec op(OpInput made, std::uint32_t outputs, const std::vector<Vec>& operands) {
    for (const Vec& v : operands) {
      made.operands.insert(made.operands.end(), v.begin(), v.end());
    }
    return add(std::move(made), outputs);
  }
  /// What of a value the ray's cone covers, if it changes as the position does.
  Vec footprint(const Vec& place) {
    Vec all = place;
    for (const char* way : {"cone_x", "cone_y"}) {
      const Vec aside = each("add", place, input(way));
      all.insert(all.end(), aside.begin(), aside.end());
    }
    return add({"footprint", all, {}, {}, "", nullptr}, 1);
  }

  std::shared_ptr<const Program> program(const std::vector<Vec>& outputs) const {
    std::vector<Operand> all;
    for (const Vec& v : outputs) all.insert(all.end(), v.begin(), v.end());
    return std::make_shared<const Program>("made", ops_, all);
  }

 private:
  static Operand constant(double value) {
    Operand operand;
    operand.constant = static_cast<float>(value);
    return operand;
  }
  Vec add(OpInput op, std::uint32_t width) {
    ops_.push_back(std::move(op));
    Vec out;
    for (std::uint32_t i = 0; i < width; ++i) {
      Operand operand;
      operand.op = static_cast<std::uint32_t>(ops_.size() - 1);
      operand.output = i;
      out.push_back(operand);
    }
    return out;
  }

  std::vector<OpInput> ops_;
};

/// A surface of even colours; `clear` goes straight through.
inline Material even_material(const Vec3d& reflected, const Vec3d& through = Vec3d(0.0),
                              double clear = 0.0, double hole = 0.0,
                              const Vec3d& emission = Vec3d(0.0)) {
  const auto color = [](const Vec3d& c) { return MadeProgram::color(c.x, c.y, c.z); };
  const auto straight = MadeProgram::color(clear, clear, clear);
  std::vector<MadeProgram::Vec> outputs = {color(emission), straight, MadeProgram::number(hole),
                                           color(reflected)};
  std::vector<SurfaceProgram::LobeInput> lobes = {{false, false}};
  if (through != Vec3d(0.0)) {
    outputs.push_back(color(through));
    lobes.push_back({true, false});
  }
  Material material;
  material.camera = SurfaceProgram(MadeProgram().program(outputs), lobes);
  if (clear > 0.0) material.clear = MadeProgram().program({straight});
  return material;
}

}  // namespace komorebi::testing
