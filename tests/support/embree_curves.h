#pragma once

#include <embree3/rtcore.h>

#include <atomic>

#include "core/ray.h"
#include "support/made_curves.h"

namespace komorebi::testing {

/// Curves in Embree as Cycles gives them: Catmull–Rom, flat or round, the first and the last key
/// doubled; the rules of the shapes (no back faces of round ones) are up to the caller.
class EmbreeCurves {
 public:
  explicit EmbreeCurves(const Curves& curves, unsigned pieces = 5, unsigned threads = 2) {
    device_ = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, this);
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    const bool is_linear = curves.shape == CurveShape::kThickLinear;
    RTCGeometry geometry = rtcNewGeometry(device_, is_linear ? RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE
                                                   : curves.shape == CurveShape::kRibbon
                                                       ? RTC_GEOMETRY_TYPE_FLAT_CATMULL_ROM_CURVE
                                                       : RTC_GEOMETRY_TYPE_ROUND_CATMULL_ROM_CURVE);
    rtcSetGeometryTessellationRate(geometry, static_cast<float>(pieces));
    const std::size_t count = curves.offsets.size() - 1;
    auto* keys = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                             RTC_FORMAT_FLOAT4, 16,
                                                             curves.radius.size() + 2 * count));
    std::vector<std::uint32_t> first;
    std::vector<std::uint8_t> neighbours;
    std::size_t at = 0;
    const auto put = [&](std::int32_t key) {
      const auto k = static_cast<std::size_t>(key);
      for (std::size_t c = 0; c < 3; ++c) keys[4 * at + c] = curves.xyz[3 * k + c];
      keys[4 * at++ + 3] = curves.radius[k];
    };
    for (std::size_t c = 0; c < count; ++c) {
      const std::int32_t begin = curves.offsets[c], end = curves.offsets[c + 1];
      for (std::int32_t k = begin; k + 1 < end; ++k) {
        first.push_back(static_cast<std::uint32_t>(at) + static_cast<std::uint32_t>(k - begin) +
                        (is_linear ? 1u : 0u));
        neighbours.push_back(
            static_cast<std::uint8_t>((k > begin ? RTC_CURVE_FLAG_NEIGHBOR_LEFT : 0) |
                                      (k + 2 < end ? RTC_CURVE_FLAG_NEIGHBOR_RIGHT : 0)));
      }
      put(begin);
      for (std::int32_t k = begin; k < end; ++k) put(k);
      put(end - 1);
    }
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(std::uint32_t), first.size()));
    std::copy(first.begin(), first.end(), indices);
    if (is_linear) {
      auto* flags = static_cast<std::uint8_t*>(
          rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_FLAGS, 0, RTC_FORMAT_UCHAR,
                                  sizeof(std::uint8_t), neighbours.size()));
      std::copy(neighbours.begin(), neighbours.end(), flags);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeCurves() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeCurves(const EmbreeCurves&) = delete;
  EmbreeCurves& operator=(const EmbreeCurves&) = delete;

  /// Nearest hit; of round curves the nearest front with `cull`.
  Hit intersect(const Ray& ray, bool cull) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (cull) context.filter = drop_back_faces;
    RTCRayHit query{};
    query.ray = to_embree(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return Hit{};
    return Hit{query.ray.tfar, query.hit.u, query.hit.v, 0, query.hit.primID};
  }

  bool occluded(const Ray& ray, bool cull) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (cull) context.filter = drop_back_faces;
    RTCRay query = to_embree(ray);
    rtcOccluded1(scene_, &context, &query);
    return query.tfar < 0.0f;
  }

  double byte_count() const { return static_cast<double>(bytes_.load()); }

 private:
  static void drop_back_faces(const RTCFilterFunctionNArguments* a) {
    const auto* ray = reinterpret_cast<const RTCRay*>(a->ray);
    const auto* hit = reinterpret_cast<const RTCHit*>(a->hit);
    const float facing = ray->dir_x * hit->Ng_x + ray->dir_y * hit->Ng_y + ray->dir_z * hit->Ng_z;
    if (facing > 0.0f) a->valid[0] = 0;
  }
  static bool count_bytes(void* self, ssize_t bytes, bool) {
    static_cast<EmbreeCurves*>(self)->bytes_ += bytes;
    return true;
  }
  static RTCRay to_embree(const Ray& r) {
    return {r.origin.x,
            r.origin.y,
            r.origin.z,
            r.t_min,
            r.direction.x,
            r.direction.y,
            r.direction.z,
            0.0f,
            r.t_max,
            ~0u,
            0,
            0};
  }

  RTCDevice device_;
  RTCScene scene_;
  std::atomic<ssize_t> bytes_{0};
};

}  // namespace komorebi::testing
