#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/vector.h"

namespace komorebi::python {

namespace py = pybind11;

/// The name that an error gives a type.
template <class T>
const char* type_name();
template <>
inline const char* type_name<float>() {
  return "float32";
}
template <>
inline const char* type_name<double>() {
  return "float64";
}
template <>
inline const char* type_name<std::int32_t>() {
  return "int32";
}
template <>
inline const char* type_name<std::uint32_t>() {
  return "uint32";
}
template <>
inline const char* type_name<std::uint8_t>() {
  return "uint8";
}
template <>
inline const char* type_name<bool>() {
  return "bool";
}

/// Views an array without copying. `shape` holds the expected extents, −1 for any. Throws
/// std::invalid_argument (ValueError in Python) naming `what` unless dtype, shape and C order are
/// exactly as asked: a silent conversion would cost a copy and hide a mistake.
template <class T>
std::span<const T> view(const py::handle& object, const std::string& what,
                        const std::vector<py::ssize_t>& shape) {
  if (!py::isinstance<py::array>(object))
    throw std::invalid_argument(what + " must be a NumPy array");
  const auto array = py::reinterpret_borrow<py::array>(object);
  if (!py::isinstance<py::array_t<T>>(array)) {
    throw std::invalid_argument(what + " must have dtype " + type_name<T>() + ", not " +
                                std::string(py::str(array.dtype())));
  }
  bool fits = array.ndim() == static_cast<py::ssize_t>(shape.size());
  std::string expected;
  for (std::size_t d = 0; d < shape.size(); ++d) {
    fits = fits && (shape[d] < 0 || array.shape(static_cast<py::ssize_t>(d)) == shape[d]);
    expected += (d ? ", " : "") + (shape[d] < 0 ? std::string("any") : std::to_string(shape[d]));
  }
  if (!fits) {
    throw std::invalid_argument(what + " must have shape (" + expected + "), not " +
                                std::string(py::str(array.attr("shape"))));
  }
  if (!(array.flags() & py::array::c_style)) {
    throw std::invalid_argument(what + " must be contiguous in C order");
  }
  return {static_cast<const T*>(array.data()), static_cast<std::size_t>(array.size())};
}

/// The same for an argument that may be None: an empty span then.
template <class T>
std::span<const T> optional_view(const py::object& object, const std::string& what,
                                 const std::vector<py::ssize_t>& shape) {
  if (object.is_none()) return {};
  return view<T>(object, what, shape);
}

/// NumPy's row-major matrix as GLM's column-major one.
template <class T>
Mat4d matrix4(const T* rows) {
  Mat4d m;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) m[c][r] = static_cast<double>(rows[4 * r + c]);
  }
  return m;
}

}  // namespace komorebi::python
