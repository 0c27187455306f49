#include "python/attribute_input.h"

#include <pybind11/stl.h>

#include <algorithm>

#include "core/attribute.h"
#include "python/bind.h"
#include "render/mesh.h"

namespace komorebi::python {
namespace {

AttributeDomain domain_from_name(const std::string& name, const std::string& what) {
  if (name == "POINT") return AttributeDomain::kVertex;
  if (name == "CORNER") return AttributeDomain::kCorner;
  if (name == "FACE" || name == "CURVE") return AttributeDomain::kFace;
  throw std::invalid_argument(what + " must have the domain POINT, CORNER, FACE or CURVE, not " +
                              name);
}

py::tuple attribute_of(const Mesh& mesh, const std::string& name, std::uint32_t primitive, float u,
                       float v) {
  const MeshView view = mesh.view();
  const AttributeView* attribute = find_attribute(view, name.c_str());
  if (attribute == nullptr) throw py::key_error(name);
  if (primitive >= mesh.primitive_count()) {
    throw py::index_error("there is no primitive " + std::to_string(primitive));
  }
  const glm::vec4 at = attribute_at(view, *attribute, primitive, u, v);
  return py::make_tuple(at.x, at.y, at.z, at.w);
}

}  // namespace

std::vector<AttributeInput> attributes_of(const py::object& attributes, const std::string& what) {
  std::vector<AttributeInput> inputs;
  if (attributes.is_none()) return inputs;
  for (const auto& [key, value] : py::cast<py::dict>(attributes)) {
    AttributeInput input;
    input.name = py::cast<std::string>(key);
    const std::string which = what + "attribute \"" + input.name + "\"";
    if (!py::isinstance<py::tuple>(value) || py::len(value) != 2) {
      throw std::invalid_argument(which + " must be a pair of domain and array");
    }
    const auto pair = py::reinterpret_borrow<py::tuple>(value);
    input.domain = domain_from_name(py::cast<std::string>(pair[0]), which);
    input.data = view<float>(pair[1], which, {-1, -1});
    input.components =
        static_cast<std::uint32_t>(std::min<py::ssize_t>(py::cast<py::array>(pair[1]).shape(1), 5));
    inputs.push_back(std::move(input));
  }
  return inputs;
}

void bind_attributes(py::class_<Mesh, std::shared_ptr<Mesh>>& mesh) {
  mesh.def_property_readonly(
          "attributes",
          [](const Mesh& of) {
            std::vector<std::string> names;
            if (of.attributes() == nullptr) return names;
            for (const AttributeView& view : of.attributes()->views())
              names.emplace_back(view.name);
            return names;
          },
          "The names of its attributes.")
      .def_property_readonly(
          "warnings",
          [](const Mesh& of) {
            return of.attributes() ? of.attributes()->warnings() : std::vector<std::string>();
          },
          "A sentence for each attribute of which numbers had to be mended.")
      .def("attribute_at", &attribute_of, py::arg("name"), py::arg("primitive"), py::arg("u"),
           py::arg("v"),
           "What an attribute is at a hit: four floats, of which one alone counts as three and the "
           "last is 1 unless there are four. Raises KeyError, IndexError.");
}

}  // namespace komorebi::python
