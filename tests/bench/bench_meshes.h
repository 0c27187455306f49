#pragma once

#include "bench/made_meshes.h"
#include "bench/options.h"
#include "bvh/topology.h"
#include "support/read_mesh.h"

namespace komorebi::bench {

/// `--mesh`: "forest:TREES", "sphere:TRIANGLES", "subdivided:FILE", or a file.
inline testing::TriangleMesh load_mesh(const std::string& source) {
  const std::size_t colon = source.find(':');
  const std::string rest = source.substr(colon == std::string::npos ? 0 : colon + 1);
  testing::TriangleMesh mesh;
  if (source.rfind("forest:", 0) == 0) {
    mesh = forest(std::stoi(rest));
  } else if (source.rfind("sphere:", 0) == 0) {
    mesh = bumpy_sphere(std::stod(rest));
  } else if (source.rfind("subdivided:", 0) == 0) {
    mesh = subdivided(testing::read_mesh(rest));
  } else {
    mesh = testing::read_mesh(source);
  }
  mesh.vtx2xyz.reserve(mesh.vtx2xyz.size() + 1);  // Embree reads whole vectors of four
  return mesh;
}

/// Those builders of `--builders` that the library has.
inline std::vector<std::string> known_builders(const Options& options) {
  std::vector<std::string> known;
  for (const std::string& name : options.list("builders", "LINEAR,SAH")) {
    try {
      builder_from_name(name);
      known.push_back(name);
    } catch (const std::invalid_argument& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
  }
  return known;
}

}  // namespace komorebi::bench
