#include <algorithm>
#include <bit>
#include <stdexcept>
#include <unordered_map>

#include "shader/op_table.h"
#include "shader/program.h"

namespace komorebi {

/// Checks what an exporter wrote down, works out what is constant, drops what nothing needs, and
/// gives values their rows.
class ProgramBuilder {
 public:
  ProgramBuilder(Program& program, std::vector<OpInput> ops, std::vector<Operand> outputs)
      : program_(program), ops_(std::move(ops)), outputs_(std::move(outputs)) {}

  void build() {
    check();
    fold();
    mark_needed();
    find_last_uses();
    emit();
  }

 private:
  struct Value {  // an operation's outputs
    std::uint32_t first = 0, count = 0;
  };
  enum class Kind { kOp, kInput, kAttribute };

  [[noreturn]] void fail(std::size_t op, const std::string& what) const {
    throw std::invalid_argument(program_.name_ + ": operation " + std::to_string(op) + " (\"" +
                                ops_[op].op + "\") " + what);
  }

  void check() {
    for (std::size_t i = 0; i < ops_.size(); ++i) {
      const OpInput& op = ops_[i];
      std::uint32_t width = 0;
      if (op.op == "input") {
        infos_.push_back(nullptr);
        kinds_.push_back(Kind::kInput);
        width = kPointInputInfo[find_input(i)].width;
      } else if (op.op == "attribute") {
        infos_.push_back(nullptr);
        kinds_.push_back(Kind::kAttribute);
        width = 4;
      } else {
        const OpInfo* info = find_op(op.op);
        if (info == nullptr) fail(i, "is not known");
        infos_.push_back(info);
        kinds_.push_back(Kind::kOp);
        check_sizes(i, *info);
        width = info->outputs;
      }
      for (const Operand& operand : op.operands) check_operand(i, operand);
      values_.push_back({value_count_, width});
      value_count_ += width;
    }
    for (const Operand& output : outputs_) {
      if (output.op != Operand::kConstant &&
          (output.op >= ops_.size() || output.output >= values_[output.op].count)) {
        throw std::invalid_argument(program_.name_ + ": an output is of no operation");
      }
    }
  }

  void check_sizes(std::size_t i, const OpInfo& info) const {
    const OpInput& op = ops_[i];
    if (op.operands.size() != info.inputs) {
      fail(i, "takes " + std::to_string(info.inputs) + " operands, not " +
                  std::to_string(op.operands.size()));
    }
    if (op.numbers.size() != info.numbers) {
      fail(i, "takes " + std::to_string(info.numbers) + " numbers, not " +
                  std::to_string(op.numbers.size()));
    }
    if (op.table.empty() == info.has_table) fail(i, "needs a table, or has one too many");
    if ((op.texture == nullptr) == info.has_texture) {
      fail(i, "needs a texture, or has one too many");
    }
  }

  void check_operand(std::size_t i, const Operand& operand) const {
    if (operand.op == Operand::kConstant) return;
    if (operand.op >= i) fail(i, "comes before what it needs");
    if (operand.output >= values_[operand.op].count) fail(i, "needs an output that is not there");
  }

  std::uint32_t find_input(std::size_t i) const {
    for (std::uint32_t k = 0; k < kPointInputs; ++k) {
      if (kPointInputInfo[k].name == ops_[i].name) return k;
    }
    fail(i, "asks for \"" + ops_[i].name + "\", which no point has");
  }

  std::uint32_t value_of(const Operand& operand) const {
    return values_[operand.op].first + operand.output;
  }

  bool is_constant(const Operand& operand) const {
    return operand.op == Operand::kConstant || known_[value_of(operand)];
  }
  float constant_of(const Operand& operand) const {
    return operand.op == Operand::kConstant ? operand.constant : constants_[value_of(operand)];
  }

  // Whatever has constants alone to work on is worked out here, on one lane.
  void fold() {
    known_.assign(value_count_, false);
    constants_.assign(value_count_, 0.0f);
    for (std::size_t i = 0; i < ops_.size(); ++i) {
      if (kinds_[i] != Kind::kOp) continue;
      float inputs[kMostInputs];
      const float* in[kMostInputs];
      bool all = true;
      for (std::size_t k = 0; k < ops_[i].operands.size() && all; ++k) {
        all = is_constant(ops_[i].operands[k]);
        if (all) inputs[k] = constant_of(ops_[i].operands[k]);
        in[k] = &inputs[k];
      }
      if (!all) {
        fold_product_by_zero(i);
        continue;
      }
      float* out[kMostOutputs];
      for (std::uint32_t k = 0; k < values_[i].count; ++k) {
        out[k] = &constants_[values_[i].first + k];
        known_[values_[i].first + k] = true;
      }
      const OpCall call{
          1, in, out, ops_[i].numbers.data(), ops_[i].table, ops_[i].texture.get(), nullptr};
      infos_[i]->run(call);
    }
  }

  // What a mix leaves out altogether need not be worked out, so that a graph for one kind of ray
  // alone costs the others nothing.
  void fold_product_by_zero(std::size_t i) {
    const OpInput& op = ops_[i];
    const auto zero = [&](std::size_t k) {
      return is_constant(op.operands[k]) && constant_of(op.operands[k]) == 0.0f;
    };
    if (op.op == "multiply" && (zero(0) || zero(1))) {
      known_[values_[i].first] = true;
      constants_[values_[i].first] = 0.0f;
    }
  }

  void mark_needed() {
    needed_.assign(ops_.size(), false);
    const auto mark = [&](const Operand& operand) {
      if (!is_constant(operand)) needed_[operand.op] = true;
    };
    for (const Operand& output : outputs_) mark(output);
    for (std::size_t i = ops_.size(); i-- > 0;) {
      if (!needed_[i]) continue;
      for (const Operand& operand : ops_[i].operands) mark(operand);
    }
  }

  void find_last_uses() {
    last_use_.assign(value_count_, 0);
    for (std::size_t i = 0; i < ops_.size(); ++i) {
      if (!needed_[i]) continue;
      for (const Operand& operand : ops_[i].operands) {
        if (!is_constant(operand)) last_use_[value_of(operand)] = i;
      }
    }
    for (const Operand& output : outputs_) {
      if (!is_constant(output)) last_use_[value_of(output)] = ops_.size();
    }
  }

  std::uint32_t constant_row(float constant) {
    const auto bits = std::bit_cast<std::uint32_t>(constant);
    const auto [found, is_new] =
        constant_rows_.emplace(bits, static_cast<std::uint32_t>(program_.constants_.size()));
    if (is_new) program_.constants_.push_back(constant);
    return found->second;
  }

  // Rows of constants are numbered first; the others follow, so they are numbered from 0 here and
  // moved up at the end.
  void emit() {
    static constexpr std::uint32_t kOther = 0x80000000u;
    std::vector<std::uint32_t> row_of(value_count_, 0), free;
    std::uint32_t others = 0;
    for (std::size_t i = 0; i < ops_.size(); ++i) {
      if (!needed_[i]) continue;
      const OpInput& op = ops_[i];
      Program::Step step;
      step.op = infos_[i];
      step.kind = static_cast<Program::Kind>(kinds_[i]);
      step.first_row = static_cast<std::uint32_t>(program_.rows_.size());
      for (const Operand& operand : op.operands) {
        program_.rows_.push_back(is_constant(operand) ? constant_row(constant_of(operand))
                                                      : row_of[value_of(operand)]);
      }
      for (std::uint32_t k = 0; k < values_[i].count; ++k) {
        const std::uint32_t value = values_[i].first + k;
        if (free.empty()) free.push_back(kOther + others++);
        row_of[value] = free.back();
        free.pop_back();
        program_.rows_.push_back(row_of[value]);
      }
      release(i, row_of, free);
      describe(step, i);
      program_.steps_.push_back(step);
    }
    const auto first = static_cast<std::uint32_t>(program_.constants_.size());
    const auto moved = [&](std::uint32_t row) {
      return row & kOther ? first + (row & ~kOther) : row;
    };
    for (std::uint32_t& row : program_.rows_) row = moved(row);
    for (const Operand& output : outputs_) {
      Program::Source source;
      if (is_constant(output)) {
        source.constant = constant_of(output);
      } else {
        source.row = moved(row_of[value_of(output)]);
      }
      program_.outputs_.push_back(source);
    }
    program_.row_count_ = first + others;
  }

  // Gives back the rows of values that nothing after operation i reads.
  void release(std::size_t i, const std::vector<std::uint32_t>& row_of,
               std::vector<std::uint32_t>& free) {
    const auto give_back = [&](std::uint32_t value) {
      if (last_use_[value] > i || given_back_[value]) return;
      given_back_[value] = true;
      free.push_back(row_of[value]);
    };
    if (given_back_.empty()) given_back_.assign(value_count_, false);
    for (const Operand& operand : ops_[i].operands) {
      if (!is_constant(operand)) give_back(value_of(operand));
    }
    for (std::uint32_t k = 0; k < values_[i].count; ++k) give_back(values_[i].first + k);
  }

  void describe(Program::Step& step, std::size_t i) {
    const OpInput& op = ops_[i];
    if (kinds_[i] == Kind::kInput) {
      step.which = find_input(i);
      program_.inputs_ |= 1u << step.which;
    } else if (kinds_[i] == Kind::kAttribute) {
      auto& names = program_.attributes_;
      const auto found = std::find(names.begin(), names.end(), op.name);
      step.which = static_cast<std::uint32_t>(found - names.begin());
      if (found == names.end()) names.push_back(op.name);
    }
    step.first_number = static_cast<std::uint32_t>(program_.numbers_.size());
    program_.numbers_.insert(program_.numbers_.end(), op.numbers.begin(), op.numbers.end());
    step.first_table = static_cast<std::uint32_t>(program_.tables_.size());
    step.table_size = static_cast<std::uint32_t>(op.table.size());
    program_.tables_.insert(program_.tables_.end(), op.table.begin(), op.table.end());
    step.texture = op.texture.get();
    if (op.texture) program_.textures_.push_back(op.texture);
  }

  Program& program_;
  std::vector<OpInput> ops_;
  std::vector<Operand> outputs_;
  std::vector<const OpInfo*> infos_;
  std::vector<Kind> kinds_;
  std::vector<Value> values_;
  std::uint32_t value_count_ = 0;
  std::vector<bool> known_, needed_, given_back_;
  std::vector<float> constants_;
  std::vector<std::size_t> last_use_;
  std::unordered_map<std::uint32_t, std::uint32_t> constant_rows_;
};

Program::Program(std::string name, std::vector<OpInput> ops, std::vector<Operand> outputs)
    : name_(std::move(name)) {
  ProgramBuilder(*this, std::move(ops), std::move(outputs)).build();
}

}  // namespace komorebi
