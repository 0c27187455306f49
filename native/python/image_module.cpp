// A module of its own for image files: OpenImageIO brings some 200 libraries along, which cost a
// process 0.2 s to load, and a render without a file of a map needs none of them.
#include <pybind11/pybind11.h>

#include <memory>
#include <span>
#include <string_view>

#include "io/image.h"
#include "io/texels.h"

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

py::capsule texels_capsule(Texels texels) {
  return {new Texels(std::move(texels)), "komorebi.Texels",
          [](void* it) { delete static_cast<Texels*>(it); }};
}

/// Texels that the caller's capsule owns, for Texture.from_file to take.
py::capsule read_file(const std::string& path, const std::string&, bool associate, bool leave_out,
                      bool halves) {
  Texels texels;
  {
    const py::gil_scoped_release release;
    texels = read_texels(path, {associate, leave_out, halves});
  }
  return texels_capsule(std::move(texels));
}

py::capsule read_packed(const py::bytes& file, const std::string& name, bool associate,
                        bool leave_out, bool halves) {
  const std::string_view data = file;
  Texels texels;
  {
    const py::gil_scoped_release release;
    texels = read_texels(std::as_bytes(std::span(data.data(), data.size())), name,
                         {associate, leave_out, halves});
  }
  return texels_capsule(std::move(texels));
}

}  // namespace

PYBIND11_MODULE(_image, module) {
  module.doc() = "Reads image files for komorebi_core.Environment and Texture.";
  module.def("read", &read, py::arg("path"), py::arg("color_space"));
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
