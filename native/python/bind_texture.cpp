#include <pybind11/stl.h>

#include <cstring>
#include <map>

#include "core/half.h"
#include "python/arrays.h"
#include "python/bind.h"
#include "texture/texture.h"

namespace komorebi::python {
namespace {

struct PictureUse {
  TextureColor color;
  AlphaUse alpha;
};

PictureUse picture_use(const std::string& color_space, const std::string& alpha_mode,
                       const py::object& matrix) {
  PictureUse use;
  const bool non_color = color_space == "NON_COLOR";
  use.color.srgb = color_space == "SRGB";
  if (!non_color && !use.color.srgb && color_space != "LINEAR") {
    throw std::invalid_argument("color_space must be LINEAR, SRGB or NON_COLOR, not " +
                                color_space);
  }
  const bool weighs = alpha_mode == "STRAIGHT" || alpha_mode == "PREMUL";
  if (!weighs && alpha_mode != "CHANNEL_PACKED" && alpha_mode != "NONE") {
    throw std::invalid_argument(
        "alpha_mode must be STRAIGHT, PREMUL, CHANNEL_PACKED or NONE, not " + alpha_mode);
  }
  use.color.data = non_color || !weighs;
  use.alpha.associate = !use.color.data;
  use.alpha.leave_out = alpha_mode == "NONE";
  if (!matrix.is_none()) {
    const auto rows = view<double>(matrix, "matrix", {3, 3});
    use.color.has_matrix = use.alpha.halves = true;
    for (std::size_t i = 0; i < 9; ++i) use.color.matrix[i] = static_cast<float>(rows[i]);
  }
  return use;
}

std::shared_ptr<Texture> make_texture(const std::string& name, Texels texels, const PictureUse& use,
                                      const TextureLevels& kept, unsigned threads,
                                      const Cancel& cancel) {
  return std::make_shared<Texture>(name, std::move(texels), use.color, *build_pool(threads), kept,
                                   cancel);
}

/// What _image's function `reader` reads; the name is for messages.
std::shared_ptr<Texture> from_reader(const char* reader, const py::object& file,
                                     const std::string& name, const std::string& color_space,
                                     const std::string& alpha_mode, const py::object& matrix,
                                     const TextureLevels& kept, unsigned threads,
                                     const std::shared_ptr<Cancel>& cancel) {
  const PictureUse use = picture_use(color_space, alpha_mode, matrix);
  const Cancel& stop = cancel_or_never(cancel);
  const auto [owner, texels] = read_image_file<Texels>(
      reader, stop, file, name, use.alpha.associate, use.alpha.leave_out, use.alpha.halves);
  const py::gil_scoped_release release;
  return make_texture(name, std::move(*texels), use, kept, threads, stop);
}

template <class T>
Texels texels_from(const py::array& pixels, const std::string& what, TexelType type) {
  const auto values = view<T>(pixels, what, {-1, -1, -1});
  Texels texels;
  texels.height = static_cast<std::uint32_t>(pixels.shape(0));
  texels.width = static_cast<std::uint32_t>(pixels.shape(1));
  texels.channels = static_cast<std::uint32_t>(pixels.shape(2));
  texels.type = type;
  if (texels.channels != 1 && texels.channels != 4) {
    throw std::invalid_argument(what + " must have 1 or 4 channels");
  }
  texels.data.reset(new std::byte[values.size_bytes()]);
  std::memcpy(texels.data.get(), values.data(), values.size_bytes());
  return texels;
}

/// Bytes are straight, as Blender has them; floats are weighed by alpha already.
void use_alpha(Texels& texels, AlphaUse alpha) {
  if (texels.channels != 4) return;
  const std::size_t count = std::size_t{texels.width} * texels.height;
  if (texels.type == TexelType::kByte && alpha.halves) {
    const std::unique_ptr<std::byte[]> bytes = std::move(texels.data);
    const auto* from = reinterpret_cast<const std::uint8_t*>(bytes.get());
    texels.type = TexelType::kHalf;
    texels.data.reset(new std::byte[texels.byte_count()]);
    auto* to = reinterpret_cast<std::uint16_t*>(texels.data.get());
    for (std::size_t i = 0; i < count; ++i, from += 4, to += 4) {
      const float a = alpha.leave_out ? 1.0f : static_cast<float>(from[3]) * (1.0f / 255.0f);
      for (int c = 0; c < 3; ++c) {
        const float value = static_cast<float>(from[c]) * (1.0f / 255.0f);
        to[c] = half_from_float(alpha.associate ? value * a : value);
      }
      to[3] = half_from_float(a);
    }
  } else if (texels.type == TexelType::kByte) {
    auto* p = reinterpret_cast<std::uint8_t*>(texels.data.get());
    for (std::size_t i = 0; i < count; ++i, p += 4) {
      for (int c = 0; alpha.associate && c < 3; ++c) {
        p[c] = static_cast<std::uint8_t>(unsigned{p[c]} * p[3] / 255u);
      }
      if (alpha.leave_out) p[3] = 255;
    }
  } else if (alpha.leave_out) {
    auto* p = reinterpret_cast<float*>(texels.data.get());
    for (std::size_t i = 0; i < count; ++i) p[4 * i + 3] = 1.0f;
  }
}

std::shared_ptr<Texture> from_pixels(const std::string& name, const py::array& pixels,
                                     const std::string& color_space, const std::string& alpha_mode,
                                     const py::object& matrix, std::uint32_t skip, bool coarser,
                                     unsigned threads, const std::shared_ptr<Cancel>& cancel) {
  const TextureLevels kept = {skip, coarser};
  const PictureUse use = picture_use(color_space, alpha_mode, matrix);
  const std::string what = "image \"" + name + "\": pixels";
  const bool bytes = py::isinstance<py::array_t<std::uint8_t>>(pixels);
  Texels texels = bytes ? texels_from<std::uint8_t>(pixels, what, TexelType::kByte)
                        : texels_from<float>(pixels, what, TexelType::kFloat);
  const py::gil_scoped_release release;
  use_alpha(texels, use.alpha);
  return make_texture(name, std::move(texels), use, kept, threads, cancel_or_never(cancel));
}

std::shared_ptr<Texture> from_tiles(
    const std::string& name, const std::map<std::uint32_t, std::shared_ptr<Texture>>& tiles) {
  return std::make_shared<Texture>(name, std::vector<Texture::Tile>(tiles.begin(), tiles.end()));
}

std::size_t bytes_of(const py::object& header, const py::object& matrix, bool coarser) {
  TextureColor color;
  color.has_matrix = !matrix.is_none();
  const auto& texels = *header.cast<py::capsule>().get_pointer<Texels>();
  return Texture::byte_count(texels, color, {0, coarser});
}

std::size_t file_bytes(const std::string& path, const py::object& matrix, bool coarser) {
  return bytes_of(py::module_::import("komorebi_core._image").attr("read_texel_header")(path),
                  matrix, coarser);
}

std::size_t packed_bytes(const std::string& name, const py::bytes& file, const py::object& matrix,
                         bool coarser) {
  return bytes_of(
      py::module_::import("komorebi_core._image").attr("read_packed_header")(file, name), matrix,
      coarser);
}

template <class E, std::size_t N>
E by_name(const char* what, const std::string& name, const char* const (&names)[N]) {
  for (std::size_t i = 0; i < N; ++i) {
    if (name == names[i]) return static_cast<E>(i);
  }
  throw std::invalid_argument("there is no " + std::string(what) + " \"" + name + "\"");
}

py::array_t<float> lookup(const Texture& texture, const py::object& uv, float footprint,
                          const std::string& interpolation, const std::string& extension,
                          bool straight) {
  const auto places = view<float>(uv, "uv", {-1, 2});
  TextureSampling how;
  how.interpolation = interpolation_from_name(interpolation);
  how.extension = extension_from_name(extension);
  how.straight = straight;
  const std::size_t count = places.size() / 2;
  py::array_t<float> result({static_cast<py::ssize_t>(count), py::ssize_t{4}});
  float* out = result.mutable_data();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec4 value = texture.lookup(how, places[2 * i], places[2 * i + 1], footprint);
    for (int c = 0; c < 4; ++c) *out++ = value[c];
  }
  return result;
}

}  // namespace

Interpolation interpolation_from_name(const std::string& name) {
  return by_name<Interpolation>("interpolation", name, {"Closest", "Linear", "Cubic", "Smart"});
}

Extension extension_from_name(const std::string& name) {
  return by_name<Extension>("extension", name, {"REPEAT", "EXTEND", "CLIP", "MIRROR"});
}

void bind_texture(py::module_& module) {
  const auto use = [](auto&& define) {
    return define(py::kw_only(), py::arg("color_space") = "LINEAR",
                  py::arg("alpha_mode") = "STRAIGHT", py::arg("matrix") = py::none(),
                  py::arg("skip") = 0, py::arg("coarser") = true, py::arg("threads") = 0,
                  py::arg("cancel") = std::shared_ptr<Cancel>());
  };
  py::class_<Texture, std::shared_ptr<Texture>> texture(
      module, "Texture",
      R"(A picture with coarser levels, looked up as Cycles does; immutable.

color_space: LINEAR, SRGB or NON_COLOR. alpha_mode: STRAIGHT, PREMUL, CHANNEL_PACKED or NONE, as
Blender has it. matrix: linear Rec. 709 from the picture's own primaries, float64 [3, 3], applied
after the curve. skip: how many of the finest levels are left out. coarser: whether levels
beyond the finest are made, which a footprint asks for. cancel: ends it by Cancelled.)");
  use([&](const auto&... arguments) {
    texture.def_static(
        "from_file",
        [](const std::string& path, const std::string& color_space, const std::string& alpha_mode,
           const py::object& matrix, std::uint32_t skip, bool coarser, unsigned threads,
           const std::shared_ptr<Cancel>& cancel) {
          return from_reader("read_texels", py::str(path), path, color_space, alpha_mode, matrix,
                             {skip, coarser}, threads, cancel);
        },
        py::arg("path"), arguments...,
        "Reads any image that OpenImageIO can, in its own type of number; RuntimeError naming the "
        "file.");
    texture.def_static(
        "from_bytes",
        [](const std::string& name, const py::bytes& file, const std::string& color_space,
           const std::string& alpha_mode, const py::object& matrix, std::uint32_t skip,
           bool coarser, unsigned threads, const std::shared_ptr<Cancel>& cancel) {
          return from_reader("read_packed_texels", file, name, color_space, alpha_mode, matrix,
                             {skip, coarser}, threads, cancel);
        },
        py::arg("name"), py::arg("file"), arguments...,
        "A file in memory; the end of its name may tell its format. RuntimeError naming it.");
    texture.def_static("from_pixels", &from_pixels, py::arg("name"), py::arg("pixels"),
                       arguments...,
                       "uint8 [H, W, 4], straight, or float32 [H, W, 1 or 4], weighed by alpha; "
                       "row 0 at the bottom.");
    return 0;
  });
  texture
      .def_static("from_tiles", &from_tiles, py::arg("name"), py::arg("tiles"),
                  "A dict of Textures by their UDIM numbers, 1001 and so on.")
      .def_static(
          "missing",
          [](const std::string& name) {
            return std::const_pointer_cast<Texture>(Texture::missing(name));
          },
          py::arg("name"), "Cycles' magenta.")
      .def_static("file_bytes", &file_bytes, py::arg("path"), py::arg("matrix") = py::none(),
                  py::arg("coarser") = true,
                  "What a file's Texture would take, from its header alone.")
      .def_static("packed_bytes", &packed_bytes, py::arg("name"), py::arg("file"),
                  py::arg("matrix") = py::none(), py::arg("coarser") = true,
                  "The same of a file in memory.")
      .def("lookup", &lookup, py::arg("uv"), py::arg("footprint") = 0.0f, py::kw_only(),
           py::arg("interpolation") = "Linear", py::arg("extension") = "REPEAT",
           py::arg("straight") = false,
           "uv: float32 [N, 2]. Returns float32 [N, 4], linear Rec. 709 and alpha; with straight, "
           "colours divided by alpha.")
      .def_property_readonly("name", &Texture::name)
      .def_property_readonly("width", &Texture::width)
      .def_property_readonly("height", &Texture::height)
      .def_property_readonly("level_count", &Texture::level_count)
      .def_property_readonly("nonfinite_texels", &Texture::nonfinite_texels)
      .def_property_readonly(
          "byte_count", [](const Texture& t) { return t.byte_count(); }, "Memory of all levels.");
}

}  // namespace komorebi::python
