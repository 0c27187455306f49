#include <pybind11/stl.h>

#include <algorithm>

#include "python/arrays.h"
#include "python/bind.h"
#include "render/material.h"
#include "shader/op_table.h"
#include "shader/program.h"
#include "texture/texture.h"

namespace komorebi::python {
namespace {

Operand operand_from(const py::handle& object) {
  Operand operand;
  if (py::isinstance<py::tuple>(object)) {
    const auto [op, output] = object.cast<std::pair<std::uint32_t, std::uint32_t>>();
    operand.op = op;
    operand.output = output;
  } else {
    operand.constant = object.cast<float>();
  }
  return operand;
}

std::shared_ptr<Program> make_program(const std::string& name, const py::list& ops,
                                      const py::list& outputs) {
  std::vector<OpInput> inputs;
  for (const py::handle& item : ops) {
    OpInput op;
    op.op = item.attr("op").cast<std::string>();
    for (const py::handle& operand : item.attr("operands")) {
      op.operands.push_back(operand_from(operand));
    }
    op.numbers = item.attr("numbers").cast<std::vector<float>>();
    const py::object table = item.attr("table");
    const auto values = optional_view<float>(table, name + ": table of \"" + op.op + "\"", {-1});
    op.table.assign(values.begin(), values.end());
    op.name = item.attr("name").cast<std::string>();
    const py::object texture = item.attr("texture");
    if (!texture.is_none()) op.texture = texture.cast<std::shared_ptr<Texture>>();
    inputs.push_back(std::move(op));
  }
  std::vector<Operand> wanted;
  for (const py::handle& output : outputs) wanted.push_back(operand_from(output));
  return std::make_shared<Program>(name, std::move(inputs), std::move(wanted));
}

/// Runs a program over points given as arrays, for tests.
py::array_t<float> evaluate(const Program& program, std::uint32_t count, const py::dict& inputs,
                            const py::dict& attributes) {
  std::vector<std::vector<float>> columns;
  const auto column = [&](std::span<const float> values, std::size_t width, std::size_t c) {
    std::vector<float> out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = values[width * i + c];
    columns.push_back(std::move(out));
    return columns.size() - 1;
  };
  const std::size_t zero = column(std::vector<float>(count), 1, 0);
  std::size_t places[kPointInputs][3];
  for (std::size_t k = 0; k < kPointInputs; ++k) {
    const PointInputInfo& info = kPointInputInfo[k];
    std::fill_n(places[k], 3, zero);
    const py::str key(info.name.data(), info.name.size());
    if (!inputs.contains(key)) continue;
    const auto values = view<float>(inputs[key], std::string(info.name),
                                    {static_cast<py::ssize_t>(count), info.width});
    for (std::size_t c = 0; c < info.width; ++c) places[k][c] = column(values, info.width, c);
  }
  std::vector<std::size_t> attribute_places;
  for (const std::string& name : program.attributes()) {
    const bool given = attributes.contains(name.c_str());
    const auto values =
        given ? view<float>(attributes[name.c_str()], name, {static_cast<py::ssize_t>(count), 4})
              : std::span<const float>();
    for (std::size_t c = 0; c < 4; ++c) {
      attribute_places.push_back(given ? column(values, 4, c) : zero);
    }
  }
  const auto outputs = static_cast<py::ssize_t>(program.output_count());
  py::array_t<float> result({static_cast<py::ssize_t>(count), outputs});
  float* to = result.mutable_data();
  Program::Scratch scratch;
  std::vector<std::vector<float>> rows(program.output_count(), std::vector<float>(Program::kLanes));
  std::vector<float*> out;
  out.reserve(rows.size());
  for (auto& row : rows) out.push_back(row.data());
  for (std::uint32_t first = 0; first < count; first += Program::kLanes) {
    ShadePoints points;
    points.count = std::min(Program::kLanes, count - first);
    for (std::size_t k = 0; k < kPointInputs; ++k) {
      for (std::size_t c = 0; c < 3; ++c) points.input[k][c] = &columns[places[k][c]][first];
    }
    std::vector<const float*> pointers;
    pointers.reserve(attribute_places.size());
    for (const std::size_t place : attribute_places) pointers.push_back(&columns[place][first]);
    points.attribute = reinterpret_cast<const float* const(*)[4]>(pointers.data());
    program.run(points, scratch, out.data());
    for (std::uint32_t i = 0; i < points.count; ++i) {
      for (const auto& row : rows) *to++ = row[i];
    }
  }
  return result;
}

py::list constants(const Program& program) {
  py::list values;
  for (std::size_t i = 0; i < program.output_count(); ++i) {
    if (program.constant(i)) {
      values.append(program.constant_value(i));
    } else {
      values.append(py::none());
    }
  }
  return values;
}

}  // namespace

void bind_shader(py::module_& module) {
  module.def(
      "has_op", [](const std::string& name) { return find_op(name) != nullptr; }, py::arg("name"),
      "Whether programs can have an operation of this name.");
  py::class_<SurfaceProgram>(module, "SurfaceProgram",
                             "What a material says of surfaces to one kind of ray.")
      .def(py::init([](std::shared_ptr<Program> program,
                       const std::vector<std::pair<bool, bool>>& lobes) {
             std::vector<SurfaceProgram::LobeInput> inputs;
             inputs.reserve(lobes.size());
             for (const auto& [transmits, has_normal] : lobes) {
               inputs.push_back({transmits, has_normal});
             }
             return SurfaceProgram(std::move(program), inputs);
           }),
           py::arg("program"), py::arg("lobes"),
           "Outputs of the program: emission (3), transparency (3), holdout (1), then of each lobe "
           "its weight (3) and, if it has one, its normal (3). lobes: (transmits, has_normal) "
           "each.");
  py::class_<Program, std::shared_ptr<Program>>(
      module, "Program", "A world's or material's nodes as operations; immutable.")
      .def(py::init(&make_program), py::arg("name"), py::arg("ops"), py::arg("outputs"),
           R"(ops: objects with op (its name), operands, numbers (list of floats), table (float32
[N] or None) and name (of a point's input or attribute, for the ops "input" and "attribute").
An operand is a number, or (i, k): output k of the op i. outputs: operands likewise.
Raises ValueError naming the program and the op.)")
      .def_property_readonly("constants", &constants,
                             "Of each output its value if it is the same everywhere, else None.")
      .def_property_readonly("attributes", &Program::attributes)
      .def_property_readonly("step_count", &Program::step_count)
      .def_property_readonly("row_count", &Program::row_count)
      .def("evaluate", &evaluate, py::arg("count"), py::arg("inputs") = py::dict(),
           py::arg("attributes") = py::dict(),
           "Runs it over `count` points. inputs: by name float32 [count, width]; attributes: by "
           "name float32 [count, 4]; what is missing is 0. Returns float32 [count, outputs].");
}

}  // namespace komorebi::python
