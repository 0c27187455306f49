// Which kernel runs. The choice is made here and not by Highway's library, so that the module
// loads no shared library for it.
#if defined(__x86_64__) || defined(__i386__)
#include <cpuid.h>
#endif

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "bvh/kernel.h"
#include "bvh/traverse.h"

namespace komorebi {
namespace {

void intersect_all_scalar(const SceneView& scene, const RaySpan& rays, Hit* hits) {
  for (std::uint32_t i = 0; i < rays.count; ++i) hits[i] = intersect_scalar(scene, rays[i]);
}

void occluded_all_scalar(const SceneView& scene, const RaySpan& rays, std::uint32_t* bits) {
  for (std::uint32_t i = 0; i < (rays.count + 31) / 32; ++i) bits[i] = 0;
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    if (occluded_scalar(scene, rays[i])) bits[i / 32] |= 1u << (i % 32);
  }
}

void occluded_bundles_scalar(const SceneView& scene, const RayBundles& bundles,
                             std::uint32_t* bits) {
  for (std::uint32_t i = 0; i < (bundles.ray_count() + 31) / 32; ++i) bits[i] = 0;
  for (std::uint32_t p = 0; p < bundles.point_count; ++p) {
    for (std::uint32_t i = bundles.first_ray[p]; i < bundles.first_ray[p + 1]; ++i) {
      if (occluded_scalar(scene, bundles.ray(p, i))) bits[i / 32] |= 1u << (i % 32);
    }
  }
}

constexpr Kernel kScalarKernel = {"SCALAR", &intersect_all_scalar, &occluded_all_scalar,
                                  &occluded_bundles_scalar};

constexpr int kScalar = -1, kUnknown = -2;  // where others are indices in kSimdKernels

/// Of the kernel of that name; kUnknown if there is none that this machine runs.
int find_kernel(const char* name) {
  for (int i = 0; kSimdKernels[i] != nullptr; ++i) {
    if (std::strcmp(kSimdKernels[i]->name, name) == 0 && machine_has(name)) return i;
  }
  return std::strcmp(name, kScalarKernel.name) == 0 ? kScalar : kUnknown;
}

/// What the environment asks for; null if nothing.
const char* wanted_by_environment() {
  const char* const wanted = std::getenv("KOMOREBI_ISA");
  return wanted != nullptr && *wanted != '\0' ? wanted : nullptr;
}

int best_kernel() {
  if (const char* wanted = wanted_by_environment(); wanted != nullptr) {
    if (const int kernel = find_kernel(wanted); kernel != kUnknown) return kernel;
  }
  for (int i = 0; kSimdKernels[i] != nullptr; ++i) {
    if (machine_has(kSimdKernels[i]->name)) return i;
  }
  return kScalar;
}

std::atomic<int> forced_kernel{kUnknown};

const Kernel& active_kernel() {
  const int index = active_kernel_index();
  return index == kScalar ? kScalarKernel : *kSimdKernels[index];
}

[[noreturn]] void refuse(const std::string& name, const std::string& says) {
  std::string all;
  for (const std::string& built : built_instruction_sets())
    all += (all.empty() ? "" : ", ") + built;
  throw std::invalid_argument(says + ": there is no instruction set \"" + name +
                              "\" in this build or machine, only " + all);
}

#if defined(__x86_64__) || defined(__i386__)
/// Not every compiler's __builtin_cpu_supports knows this one.
bool has_f16c() {
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
  return __get_cpuid(1, &eax, &ebx, &ecx, &edx) != 0 && (ecx & bit_F16C) != 0;
}
#endif

}  // namespace

bool machine_has(const char* kernel_name) {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_cpu_init();
  // What Highway lets the compiler use for each (hwy/ops/set_macros-inl.h).
  const bool sse4 = __builtin_cpu_supports("sse4.1") && __builtin_cpu_supports("sse4.2") &&
                    __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("aes");
  const bool avx2 = sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
                    __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma") && has_f16c();
  const bool avx3 = avx2 && __builtin_cpu_supports("avx512f") &&
                    __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512bw");
  if (std::strcmp(kernel_name, "SSE4") == 0) return sse4;
  if (std::strcmp(kernel_name, "AVX2") == 0) return avx2;
  if (std::strcmp(kernel_name, "AVX3") == 0) return avx3;
  return false;
#else
  return kernel_name != nullptr;  // only instruction sets that the whole build may use
#endif
}

int active_kernel_index() {
  static const int best = best_kernel();
  const int forced = forced_kernel.load(std::memory_order_relaxed);
  return forced != kUnknown ? forced : best;
}

void intersect(const SceneView& scene, const RaySpan& rays, Hit* hits) {
  active_kernel().intersect(scene, rays, hits);
}

void occluded(const SceneView& scene, const RayBundles& bundles, std::uint32_t* bits) {
  active_kernel().occluded_bundles(scene, bundles, bits);
}

void occluded(const SceneView& scene, const RaySpan& rays, std::uint32_t* bits) {
  active_kernel().occluded(scene, rays, bits);
}

std::vector<std::string> built_instruction_sets() {
  std::vector<std::string> names;
  for (const Kernel* const* kernel = kSimdKernels; *kernel != nullptr; ++kernel) {
    if (machine_has((*kernel)->name)) names.emplace_back((*kernel)->name);
  }
  names.emplace_back(kScalarKernel.name);
  return names;
}

const char* active_instruction_set() {
  return active_kernel().name;
}

void check_instruction_set() {
  const char* const wanted = wanted_by_environment();
  if (wanted != nullptr && find_kernel(wanted) == kUnknown) refuse(wanted, "KOMOREBI_ISA");
}

void force_instruction_set(const std::string& name) {
  const int kernel = name.empty() ? kUnknown : find_kernel(name.c_str());
  if (kernel == kUnknown && !name.empty()) refuse(name, "force_instruction_set");
  forced_kernel.store(kernel, std::memory_order_relaxed);
}

}  // namespace komorebi
