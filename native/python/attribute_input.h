#pragma once

#include <vector>

#include "python/arrays.h"
#include "render/mesh_attributes.h"

namespace komorebi::python {

/// A dict of named arrays, {name: (domain, float32 [rows, 1 to 4])}, or None.
/// @param what  names the mesh in messages
/// @throws std::invalid_argument
std::vector<AttributeInput> attributes_of(const py::object& attributes, const std::string& what);

}  // namespace komorebi::python
