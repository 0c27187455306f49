#pragma once

#include "core/ray_bundles.h"
#include "core/scene_view.h"

namespace komorebi {

/// Traversal compiled for one instruction set.
struct Kernel {
  const char* name;
  void (*intersect)(const SceneView& scene, const RaySpan& rays, Hit* hits);
  void (*occluded)(const SceneView& scene, const RaySpan& rays, std::uint32_t* bits);
  void (*occluded_bundles)(const SceneView& scene, const RayBundles& bundles, std::uint32_t* bits);
};

/// Null-terminated, best first; whether the machine has the instruction set is another question.
extern const Kernel* const kSimdKernels[];

/// Which entry of a table made by KOMOREBI_KERNELS (bvh/simd_targets.h) is in use; −1: none, but
/// the scalar functions.
int active_kernel_index();

/// Whether this machine and its operating system run the kernel of that name.
bool machine_has(const char* kernel_name);

}  // namespace komorebi
