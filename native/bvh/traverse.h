#pragma once

#include <string>
#include <vector>

#include "core/ray_bundles.h"
#include "core/scene_view.h"

namespace komorebi {

/// Closest hits of a span of rays; `hits` has rays.count entries, a miss has instance kNone.
void intersect(const SceneView& scene, const RaySpan& rays, Hit* hits);

/// Whether anything lies on each ray: bit i % 32 of word i / 32 for ray i. The
/// (rays.count + 31) / 32 words are overwritten, unused bits with 0.
void occluded(const SceneView& scene, const RaySpan& rays, std::uint32_t* bits);

/// The same for rays that leave common points: bit i % 32 of word i / 32 for ray i of all.
void occluded(const SceneView& scene, const RayBundles& bundles, std::uint32_t* bits);

/// The specification of the three: one ray, the same tree, plain C++. Kernels agree to the bit.
Hit intersect_scalar(const SceneView& scene, const Ray& ray);
bool occluded_scalar(const SceneView& scene, const Ray& ray);

/// The same answers, to the bit, from every triangle of every instance and no tree at all.
Hit intersect_brute_force(const SceneView& scene, const Ray& ray);
bool occluded_brute_force(const SceneView& scene, const Ray& ray);

/// Instruction sets that kernels were compiled for and this machine has, best first; the last is
/// "SCALAR", the specification itself.
std::vector<std::string> built_instruction_sets();

/// The one in use: the best, unless the environment variable KOMOREBI_ISA names another.
const char* active_instruction_set();

/// Where the module and the program begin.
/// @throws std::invalid_argument if KOMOREBI_ISA names none of built_instruction_sets().
void check_instruction_set();

/// For tests: from now on uses this one ("" for the best again).
/// @throws std::invalid_argument if it is not among built_instruction_sets().
void force_instruction_set(const std::string& name);

}  // namespace komorebi
