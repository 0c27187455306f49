#include "shader/program.h"

#include <algorithm>
#include <cstring>

namespace komorebi {

bool Program::constant() const {
  return std::all_of(outputs_.begin(), outputs_.end(),
                     [](const Source& s) { return s.row == kNoRow; });
}

float Program::largest_constant() const {
  float largest = 1.0f;
  for (const float c : constants_) largest = std::max(largest, c);
  return largest;
}

void Program::run(const ShadePoints& points, Scratch& scratch, float* const* out) const {
  const std::uint32_t count = points.count;
  if (scratch.rows_.size() < std::size_t{row_count_} * kLanes) {
    scratch.rows_.resize(std::size_t{row_count_} * kLanes);
  }
  float* const rows = scratch.rows_.data();
  const auto row = [&](std::uint32_t index) { return rows + std::size_t{index} * kLanes; };
  for (std::size_t i = 0; i < constants_.size(); ++i) {
    std::fill_n(row(static_cast<std::uint32_t>(i)), count, constants_[i]);
  }
  const float* in[kMostInputs];
  float* to[kMostOutputs];
  for (const Step& step : steps_) {
    const std::uint32_t* index = &rows_[step.first_row];
    if (step.kind == Kind::kInput) {
      const std::uint32_t width = kPointInputInfo[step.which].width;
      for (std::uint32_t c = 0; c < width; ++c) {
        std::copy_n(points.input[step.which][c], count, row(index[c]));
      }
      continue;
    }
    if (step.kind == Kind::kAttribute) {
      for (std::uint32_t c = 0; c < 4; ++c) {
        std::copy_n(points.attribute[step.which][c], count, row(index[c]));
      }
      continue;
    }
    for (std::uint32_t i = 0; i < step.op->inputs; ++i) in[i] = row(*index++);
    for (std::uint32_t i = 0; i < step.op->outputs; ++i) to[i] = row(*index++);
    OpCall call;
    call.count = count;
    call.in = in;
    call.out = to;
    call.numbers = numbers_.data() + step.first_number;
    call.table = {tables_.data() + step.first_table, step.table_size};
    call.texture = step.texture;
    call.points = &points;
    step.op->run(call);
  }
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (outputs_[i].row == kNoRow) {
      std::fill_n(out[i], count, outputs_[i].constant);
    } else {
      std::copy_n(row(outputs_[i].row), count, out[i]);
    }
  }
}

WrittenProgram Program::written() const {
  WrittenProgram written;
  std::vector<Operand> holds(row_count_);  // what is in each row so far
  for (std::size_t i = 0; i < constants_.size(); ++i) holds[i].constant = constants_[i];
  for (const Step& step : steps_) {
    const std::uint32_t* index = &rows_[step.first_row];
    OpInput op;
    std::uint32_t outputs = 4;
    if (step.kind == Kind::kInput) {
      op.op = "input";
      op.name = kPointInputInfo[step.which].name;
      outputs = kPointInputInfo[step.which].width;
    } else if (step.kind == Kind::kAttribute) {
      op.op = "attribute";
      op.name = attributes_[step.which];
    } else {
      op.op = step.op->name;
      for (std::uint32_t i = 0; i < step.op->inputs; ++i) op.operands.push_back(holds[*index++]);
      const float* const numbers = numbers_.data() + step.first_number;
      op.numbers.assign(numbers, numbers + step.op->numbers);
      const float* const table = tables_.data() + step.first_table;
      op.table.assign(table, table + step.table_size);
      const auto of_step = [&](const auto& texture) { return texture.get() == step.texture; };
      const auto found = std::find_if(textures_.begin(), textures_.end(), of_step);
      if (found != textures_.end() && step.texture != nullptr) op.texture = *found;
      outputs = step.op->outputs;
    }
    for (std::uint32_t i = 0; i < outputs; ++i) {
      holds[*index++] = {static_cast<std::uint32_t>(written.ops.size()), i, 0.0f};
    }
    written.ops.push_back(std::move(op));
  }
  for (const Source& source : outputs_) {
    Operand constant;
    constant.constant = source.constant;
    written.outputs.push_back(source.row == kNoRow ? constant : holds[source.row]);
  }
  return written;
}

}  // namespace komorebi
