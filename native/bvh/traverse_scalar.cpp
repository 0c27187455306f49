#include "bvh/traverse_scalar.h"

#include "bvh/traverse.h"

namespace komorebi {

Hit intersect_scalar(const SceneView& scene, const Ray& ray) {
  return trace_scalar<false>(scene, ray);
}

bool occluded_scalar(const SceneView& scene, const Ray& ray) {
  return trace_scalar<true>(scene, ray).valid();
}

}  // namespace komorebi
