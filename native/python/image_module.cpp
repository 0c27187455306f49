// A module of its own for image files: OpenImageIO brings some 200 libraries along, which cost a
// process 0.2 s to load, and a render without a file of a map needs none of them.
#include <pybind11/pybind11.h>

#include <memory>
#include <span>
#include <string_view>

#include "io/light_map.h"
#include "io/texels.h"

namespace komorebi::python {
namespace {

namespace py = pybind11;

/// The flag of a caller in the other module. Cancelled is an exception of each module's own, so
/// None is what says that a call was.
const Cancel& flag(const py::capsule& cancel) {
  return *cancel.get_pointer<Cancel>();
}

/// The map that the caller's capsule owns, for environment_from_file to take.
py::object read(const std::string& path, const std::string& color_space,
                const py::capsule& cancel) {
  if (color_space != "LINEAR" && color_space != "SRGB") {
    throw std::invalid_argument("color_space must be LINEAR or SRGB, not " + color_space);
  }
  std::unique_ptr<LightMap> map;
  const Cancel& stop = flag(cancel);
  try {
    const py::gil_scoped_release release;
    map = std::make_unique<LightMap>(read_light_map(
        path, color_space == "SRGB" ? ColorSpace::kSrgb : ColorSpace::kLinear, stop));
  } catch (const Cancelled&) {
    return py::none();
  }
  return py::capsule(map.release(), "komorebi.LightMap",
                     [](void* it) { delete static_cast<LightMap*>(it); });
}

py::capsule texels_capsule(Texels texels) {
  return {new Texels(std::move(texels)), "komorebi.Texels",
          [](void* it) { delete static_cast<Texels*>(it); }};
}

/// Texels that the caller's capsule owns, for Texture.from_file to take.
py::object read_file(const std::string& path, const std::string&, bool associate, bool leave_out,
                     bool halves, const py::capsule& cancel) {
  const Cancel& stop = flag(cancel);
  Texels texels;
  try {
    const py::gil_scoped_release release;
    texels = read_texels(path, {associate, leave_out, halves}, stop);
  } catch (const Cancelled&) {
    return py::none();
  }
  return texels_capsule(std::move(texels));
}

py::object read_packed(const py::bytes& file, const std::string& name, bool associate,
                       bool leave_out, bool halves, const py::capsule& cancel) {
  const std::string_view data = file;
  const Cancel& stop = flag(cancel);
  Texels texels;
  try {
    const py::gil_scoped_release release;
    texels = read_texels(std::as_bytes(std::span(data.data(), data.size())), name,
                         {associate, leave_out, halves}, stop);
  } catch (const Cancelled&) {
    return py::none();
  }
  return texels_capsule(std::move(texels));
}

}  // namespace

PYBIND11_MODULE(_image, module) {
  module.doc() = "Reads image files for komorebi_core.Environment and Texture.";
  module.def("read", &read, py::arg("path"), py::arg("color_space"), py::arg("cancel"));
  module.def("read_texels", &read_file);
  module.def("read_packed_texels", &read_packed);
  module.def("read_texel_header",
             [](const std::string& path) { return texels_capsule(read_texel_header(path)); });
  module.def("read_packed_header", [](const py::bytes& file, const std::string& name) {
    const std::string_view data = file;
    return texels_capsule(
        read_texel_header(std::as_bytes(std::span(data.data(), data.size())), name));
  });
}

}  // namespace komorebi::python
