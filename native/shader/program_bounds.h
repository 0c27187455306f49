#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "shader/op_bounds.h"
#include "shader/program.h"
#include "texture/texture_bounds.h"

namespace komorebi {

/// Bounds of the textures of some programs, each made when it is first asked for.
class TextureBoundsTable {
 public:
  const TextureBounds& of(const std::shared_ptr<const Texture>& texture, ThreadPool& pool);

 private:
  std::map<std::shared_ptr<const Texture>, std::unique_ptr<TextureBounds>> bounds_;
};

/// Between which numbers a program's outputs lie where its attributes lie between some: the same
/// operations on intervals (shader/op_bounds.h). Of what depends on anything else of a point, or
/// takes another operation, nothing is known.
class ProgramBounds {
 public:
  /// @param textures  outlives this
  ProgramBounds(const Program& program, TextureBoundsTable& textures, ThreadPool& pool);

  /// Names of those that run() takes.
  const std::vector<std::string>& attributes() const { return attributes_; }
  std::size_t output_count() const { return outputs_.size(); }

  /// @param attributes  [attributes()][4]
  /// @param values      what it works with; grows once
  /// @param out         [output_count()]
  void run(const FloatRange (*attributes)[4], std::vector<FloatRange>& values,
           FloatRange* out) const;

 private:
  struct Source {
    std::uint32_t value = 0;
    FloatRange constant;
    bool is_constant = false;
  };
  struct Step {
    OpBounds* bounds = nullptr;  // null: an attribute, or nothing is known
    std::uint32_t attribute = 0xffffffffu;
    std::uint32_t first_value = 0, outputs = 0;  // in run()'s values
    std::vector<Source> in;
    std::vector<float> numbers;
    const TextureBounds* texture = nullptr;
  };

  std::vector<Step> steps_;
  std::vector<Source> outputs_;
  std::vector<std::string> attributes_;
  std::uint32_t value_count_ = 0;
};

}  // namespace komorebi
