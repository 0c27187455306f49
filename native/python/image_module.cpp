// A module of its own for image files: OpenImageIO brings some 200 libraries along, which cost a
// process 0.2 s to load, and a render without a file of a map needs none of them.
#include <pybind11/pybind11.h>

#include <memory>

#include "io/image.h"

namespace komorebi::python {
namespace {

namespace py = pybind11;

/// The image that the caller's capsule owns, for environment_from_file to take.
py::capsule read(const std::string& path, const std::string& color_space) {
  if (color_space != "LINEAR" && color_space != "SRGB") {
    throw std::invalid_argument("color_space must be LINEAR or SRGB, not " + color_space);
  }
  auto image = std::make_unique<Image>();
  {
    const py::gil_scoped_release release;
    *image = read_image(path, color_space == "SRGB" ? ColorSpace::kSrgb : ColorSpace::kLinear);
  }
  return {image.release(), "komorebi.Image", [](void* it) { delete static_cast<Image*>(it); }};
}

}  // namespace

PYBIND11_MODULE(_image, module) {
  module.doc() = "Reads image files for komorebi_core.Environment.from_file.";
  module.def("read", &read, py::arg("path"), py::arg("color_space"));
}

}  // namespace komorebi::python
