#pragma once

#include <embree3/rtcore.h>

#include <algorithm>

#include "core/ray.h"
#include "support/mesh_file.h"

namespace komorebi::testing {

/// One mesh in Embree, with its robust triangle test: a tracer that is not ours.
class EmbreeScene {
 public:
  explicit EmbreeScene(const TriangleMesh& mesh) {
    device_ = rtcNewDevice("threads=2");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* xyz = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                            RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                            mesh.vtx2xyz.size() / 3));
    std::copy(mesh.vtx2xyz.begin(), mesh.vtx2xyz.end(), xyz);
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangle_count()));
    std::copy(mesh.tri2vtx.begin(), mesh.tri2vtx.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  Hit intersect(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = to_embree(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return Hit{};
    return Hit{query.ray.tfar, query.hit.u, query.hit.v, 0, query.hit.primID};
  }

  bool occluded(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query = to_embree(ray);
    rtcOccluded1(scene_, &context, &query);
    return query.tfar < 0.0f;
  }

 private:
  static RTCRay to_embree(const Ray& ray) {
    return {ray.origin.x,
            ray.origin.y,
            ray.origin.z,
            ray.t_min,
            ray.direction.x,
            ray.direction.y,
            ray.direction.z,
            0.0f,
            ray.t_max,
            ~0u,
            0,
            0};
  }

  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace komorebi::testing
