// The table of one instruction set's kernels. Included once per instruction set by
// traverse_simd.cpp, without a guard.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {

extern const Kernel kKernel;
constexpr Kernel kKernel = {&HWY_STR(HWY_NAMESPACE)[2], &intersect, &occluded,
                            &occluded_bundles};  // N_AVX2: "AVX2"

}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
