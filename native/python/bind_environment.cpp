#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <bit>

#include "io/light_map.h"
#include "python/arrays.h"
#include "python/attribute_input.h"
#include "python/bind.h"
#include "render/scene.h"
#include "render/world_program.h"

namespace komorebi::python {
namespace {

std::shared_ptr<Environment> environment_from_file(const std::string& path,
                                                   const std::string& color_space) {
  const py::capsule owner =
      py::module_::import("komorebi_core._image").attr("read")(path, color_space);
  auto& map = *owner.get_pointer<LightMap>();
  const py::gil_scoped_release release;
  return std::make_shared<Environment>(std::move(map), *build_pool(0));
}

std::shared_ptr<Environment> environment_from_pixels(const std::string& name,
                                                     const py::array& pixels) {
  const auto values = view<float>(pixels, "image \"" + name + "\": pixels", {-1, -1, 3});
  const auto height = static_cast<std::uint32_t>(pixels.shape(0));
  const auto width = static_cast<std::uint32_t>(pixels.shape(1));
  const py::gil_scoped_release release;
  return std::make_shared<Environment>(name, width, height,
                                       std::vector<float>(values.begin(), values.end()));
}

std::shared_ptr<Environment> environment_from_program(const Program& program, std::uint32_t width,
                                                      std::uint32_t height, unsigned threads,
                                                      const std::shared_ptr<Cancel>& cancel) {
  const py::gil_scoped_release release;
  return std::make_shared<Environment>(
      program.name(), width, height,
      world_texels(program, width, height, *build_pool(threads), cancel_or_never(cancel)));
}

}  // namespace

void bind_environment(py::module_& module) {
  py::class_<Environment, std::shared_ptr<Environment>>(
      module, "Environment", "An equirectangular map with its sampling tables; immutable.")
      .def_static("from_file", &environment_from_file, py::arg("path"),
                  py::arg("color_space") = "LINEAR",
                  "Reads any image that OpenImageIO can; RuntimeError naming the file.")
      .def_static("from_pixels", &environment_from_pixels, py::arg("name"), py::arg("pixels"),
                  "float32 [H, W, 3], linear Rec. 709, row 0 at the bottom.")
      .def_static("from_program", &environment_from_program, py::arg("program"), py::arg("width"),
                  py::arg("height"), py::arg("threads") = 0,
                  py::arg("cancel") = std::shared_ptr<Cancel>(),
                  "The first three outputs of a world's program, run over the texels' directions. "
                  "Raises Cancelled.")
      .def_property_readonly("width", &Environment::width)
      .def_property_readonly("height", &Environment::height)
      .def_property_readonly("nonfinite_texels", &Environment::nonfinite_texels)
      .def_property_readonly("negative_texels", &Environment::negative_texels)
      .def_property_readonly("byte_count", &Environment::byte_count);
}

}  // namespace komorebi::python
