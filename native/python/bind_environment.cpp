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
                                                   const std::string& color_space,
                                                   const std::shared_ptr<Cancel>& cancel) {
  const Cancel& stop = cancel_or_never(cancel);
  const auto [owner, map] = read_image_file<LightMap>("read", stop, path, color_space);
  const py::gil_scoped_release release;
  return std::make_shared<Environment>(std::move(*map), *build_pool(0), stop);
}

std::shared_ptr<Environment> environment_from_pixels(const std::string& name,
                                                     const py::array& pixels,
                                                     const std::shared_ptr<Cancel>& cancel) {
  const auto values = view<float>(pixels, "image \"" + name + "\": pixels", {-1, -1, 3});
  const auto height = static_cast<std::uint32_t>(pixels.shape(0));
  const auto width = static_cast<std::uint32_t>(pixels.shape(1));
  const py::gil_scoped_release release;
  const Cancel& stop = cancel_or_never(cancel);
  return std::make_shared<Environment>(make_light_map(name, width, height, values, stop),
                                       *build_pool(0), stop);
}

std::shared_ptr<Environment> environment_from_program(const Program& program, std::uint32_t width,
                                                      std::uint32_t height, unsigned threads,
                                                      const std::shared_ptr<Cancel>& cancel) {
  const py::gil_scoped_release release;
  const Cancel& stop = cancel_or_never(cancel);
  const auto pool = build_pool(threads);
  return std::make_shared<Environment>(
      make_light_map(program.name(), width, height,
                     world_texels(program, width, height, *pool, stop), stop),
      *pool, stop);
}

}  // namespace

void bind_environment(py::module_& module) {
  py::class_<Environment, std::shared_ptr<Environment>>(
      module, "Environment", "An equirectangular map with its sampling tables; immutable.")
      .def_static("from_file", &environment_from_file, py::arg("path"),
                  py::arg("color_space") = "LINEAR", py::arg("cancel") = std::shared_ptr<Cancel>(),
                  "Reads any image that OpenImageIO can; RuntimeError naming the file. Raises "
                  "Cancelled.")
      .def_static("from_pixels", &environment_from_pixels, py::arg("name"), py::arg("pixels"),
                  py::arg("cancel") = std::shared_ptr<Cancel>(),
                  "float32 [H, W, 3], linear Rec. 709, row 0 at the bottom. Raises Cancelled.")
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
