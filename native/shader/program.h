#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "shader/op.h"

namespace komorebi {

/// Where an operation takes a float from: a number, or output `output` of an earlier operation.
struct Operand {
  static constexpr std::uint32_t kConstant = 0xffffffffu;
  std::uint32_t op = kConstant, output = 0;
  float constant = 0.0f;
};

/// An operation as an exporter writes it down. "input" and "attribute" have no operands but a name.
struct OpInput {
  std::string op;
  std::vector<Operand> operands;
  std::vector<float> numbers;
  std::vector<float> table;
  std::string name;  ///< of the PointInput, or of the attribute
  std::shared_ptr<const Texture> texture;
};

/// What a program does, as an exporter could have written it down.
struct WrittenProgram {
  std::vector<OpInput> ops;
  std::vector<Operand> outputs;
};

/// A world's or material's nodes as a list of operations on rows of floats, a lane a point:
/// immutable, to be shared and counted. What is the same at all points is worked out once, by the
/// very operations that work on points; what nothing needs is left out.
class Program {
 public:
  /// @param ops      in an order in which each has its operands before it
  /// @param outputs  what the program is run for
  /// @throws std::invalid_argument naming the program and the operation that is wrong
  Program(std::string name, std::vector<OpInput> ops, std::vector<Operand> outputs);

  /// Lanes that are run together.
  static constexpr std::uint32_t kLanes = 64;

  const std::string& name() const { return name_; }
  std::size_t output_count() const { return outputs_.size(); }
  /// Whether an output is the same at all points, and what it is then.
  bool constant(std::size_t output) const { return outputs_[output].row == kNoRow; }
  float constant_value(std::size_t output) const { return outputs_[output].constant; }
  bool constant() const;
  /// Of the numbers that operations work on, at least 1.
  float largest_constant() const;
  bool asks(PointInput input) const { return inputs_ >> static_cast<std::uint32_t>(input) & 1u; }
  /// Names of the attributes that points need, in the order of ShadePoints::attribute.
  const std::vector<std::string>& attributes() const { return attributes_; }
  /// The operations that are left of it, from which it could be made again.
  WrittenProgram written() const;
  std::size_t step_count() const { return steps_.size(); }
  std::uint32_t row_count() const { return row_count_; }

  /// Rows for one thread; grows once.
  class Scratch {
    friend class Program;
    std::vector<float> rows_;
  };

  /// Runs over the points [0, points.count), at most kLanes of them.
  /// @param out  [output_count()] columns that are written
  void run(const ShadePoints& points, Scratch& scratch, float* const* out) const;

 private:
  static constexpr std::uint32_t kNoRow = 0xffffffffu;
  /// An input of a step: a row, or kNoRow + the constant.
  struct Source {
    std::uint32_t row = kNoRow;
    float constant = 0.0f;
  };
  enum class Kind : std::uint8_t { kOp, kInput, kAttribute };
  struct Step {
    Kind kind = Kind::kOp;
    const OpInfo* op = nullptr;
    std::uint32_t which = 0;         // PointInput or attribute
    std::uint32_t first_row = 0;     // in rows_: inputs, then outputs
    std::uint32_t first_number = 0;  // in numbers_
    std::uint32_t first_table = 0, table_size = 0;
    const Texture* texture = nullptr;
  };
  friend class ProgramBuilder;

  std::string name_;
  std::vector<Step> steps_;
  std::vector<std::uint32_t> rows_;
  std::vector<float> numbers_, tables_;
  std::vector<std::shared_ptr<const Texture>> textures_;
  std::vector<float> constants_;  // fill the first rows
  std::vector<Source> outputs_;
  std::vector<std::string> attributes_;
  std::uint32_t inputs_ = 0, row_count_ = 0;
};

}  // namespace komorebi
