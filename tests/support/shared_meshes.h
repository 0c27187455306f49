#pragma once

#include <cctype>

#include "support/read_mesh.h"
#include "support/shared_data.h"

namespace komorebi::testing {

/// The meshes of ../shared/data/meshes that read_mesh reads; those of GLB files are not among them.
inline const std::vector<std::string>& shared_meshes() {
  static const std::vector<std::string> names = {"boat.obj",
                                                 "brain_colin27_iso60.ply.gz",
                                                 "bunny_hr.obj",
                                                 "dragon_vrip.ply.gz",
                                                 "dragon_vrip_res2.ply.gz",
                                                 "dragon_vrip_res3.ply.gz",
                                                 "motorBike.obj.gz",
                                                 "mountain.obj",
                                                 "pizza.obj",
                                                 "sponza_dabrovic.ply",
                                                 "spot.obj",
                                                 "edge/ChineseDragon-10kv.ply",
                                                 "edge/cube-shuffled.ply",
                                                 "edge/degtri_sliding.ply",
                                                 "edge/elephant-with-holes.ply",
                                                 "edge/empty.ply",
                                                 "edge/hedra_open.ply",
                                                 "edge/multibody.stl",
                                                 "edge/nancolor.obj",
                                                 "edge/obj_wireframe.obj",
                                                 "edge/plate_holes.STL",
                                                 "edge/ply_empty_bin.ply",
                                                 "edge/ply_points_bin.ply",
                                                 "edge/polygon_mesh.ply",
                                                 "edge/soup.stl",
                                                 "edge/tetra_intersected_by_triangle.ply",
                                                 "edge/triangle.ply",
                                                 "edge/wallhole.obj"};
  return names;
}

/// A file name as gtest allows it in a test's name.
inline std::string test_name(const std::string& file) {
  std::string name = file;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}

inline TriangleMesh scaled(TriangleMesh mesh, float scale) {
  for (float& x : mesh.vtx2xyz) x *= scale;
  return mesh;
}

}  // namespace komorebi::testing
