#include "shader/program_bounds.h"

#include <algorithm>

namespace komorebi {

const TextureBounds& TextureBoundsTable::of(const std::shared_ptr<const Texture>& texture,
                                            ThreadPool& pool) {
  auto& found = bounds_[texture];
  if (!found) found = std::make_unique<TextureBounds>(*texture, pool);
  return *found;
}

ProgramBounds::ProgramBounds(const Program& program, TextureBoundsTable& textures,
                             ThreadPool& pool) {
  const WrittenProgram written = program.written();
  const auto source = [&](const Operand& operand) {
    if (operand.op == Operand::kConstant) return Source{0, FloatRange::of(operand.constant), true};
    return Source{steps_[operand.op].first_value + operand.output, FloatRange(), false};
  };
  for (const OpInput& op : written.ops) {
    Step step;
    step.first_value = value_count_;
    step.outputs = kMostOutputs;
    if (op.op == "attribute" && !asks_for_step(op.name)) {
      const auto found = std::find(attributes_.begin(), attributes_.end(), op.name);
      step.attribute = static_cast<std::uint32_t>(found - attributes_.begin());
      if (found == attributes_.end()) attributes_.push_back(op.name);
    } else {
      step.bounds = find_op_bounds(op.op);
      for (const Operand& operand : op.operands) step.in.push_back(source(operand));
      step.numbers = op.numbers;
      if (op.texture && step.bounds != nullptr) step.texture = &textures.of(op.texture, pool);
    }
    value_count_ += step.outputs;
    steps_.push_back(std::move(step));
  }
  for (const Operand& output : written.outputs) outputs_.push_back(source(output));
}

void ProgramBounds::run(const FloatRange (*attributes)[4], std::vector<FloatRange>& values,
                        FloatRange* out) const {
  values.resize(value_count_);
  const auto value_of = [&](const Source& source) {
    return source.is_constant ? source.constant : values[source.value];
  };
  for (const Step& step : steps_) {
    FloatRange* const to = &values[step.first_value];
    if (step.attribute != 0xffffffffu) {
      std::copy_n(attributes[step.attribute], 4, to);
    } else if (step.bounds == nullptr) {
      std::fill_n(to, step.outputs, FloatRange());
    } else {
      FloatRange in[kMostInputs];
      for (std::size_t i = 0; i < step.in.size(); ++i) in[i] = value_of(step.in[i]);
      step.bounds({in, to, step.numbers.data(), step.texture});
    }
  }
  for (std::size_t i = 0; i < outputs_.size(); ++i) out[i] = value_of(outputs_[i]);
}

}  // namespace komorebi
