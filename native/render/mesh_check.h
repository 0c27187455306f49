#pragma once

#include "render/mesh.h"

namespace komorebi {

/// Refuses a mesh that could make the builders or the shading read astray: throws
/// std::invalid_argument with one sentence that names the mesh and says how many entries are wrong.
void check_mesh(const MeshInput& input, ThreadPool& pool);

}  // namespace komorebi
