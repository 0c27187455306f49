#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <stdexcept>
#include <string>

#include "support/mesh_file.h"

namespace komorebi::bench {

/// A way to build in Embree: its quality levels, its compact trees, its robust (watertight) ones.
struct EmbreeMode {
  std::string name;
  RTCBuildQuality quality;
  RTCSceneFlags flags;
  bool reads_vertices;  ///< compact leaves hold indices, and the caller's vertices are read
};

/// "MEDIUM", "LOW", "HIGH", "MEDIUM+COMPACT", "HIGH+ROBUST", …
inline EmbreeMode embree_mode(const std::string& name) {
  const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
  int flags = RTC_SCENE_FLAG_NONE;
  if (has("COMPACT")) flags |= RTC_SCENE_FLAG_COMPACT;
  if (has("ROBUST")) flags |= RTC_SCENE_FLAG_ROBUST;
  const RTCBuildQuality quality = has("LOW")    ? RTC_BUILD_QUALITY_LOW
                                  : has("HIGH") ? RTC_BUILD_QUALITY_HIGH
                                                : RTC_BUILD_QUALITY_MEDIUM;
  if (!has("LOW") && !has("MEDIUM") && !has("HIGH")) {
    throw std::invalid_argument("no Embree mode " + name);
  }
  return {name, quality, static_cast<RTCSceneFlags>(flags), has("COMPACT")};
}

/// One mesh in Embree, which reads the caller's own buffers: no copy is timed or counted.
class EmbreePeer {
 public:
  EmbreePeer(const EmbreeMode& mode, unsigned threads) : mode_(mode) {
    device_ = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, this);
  }
  ~EmbreePeer() {
    if (geometry_) rtcReleaseGeometry(geometry_);
    if (scene_) rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;

  /// Gives a mesh one float more than it has: Embree reads whole vectors of four.
  static testing::TriangleMesh with_padding(testing::TriangleMesh mesh) {
    mesh.vtx2xyz.reserve(mesh.vtx2xyz.size() + 1);
    return mesh;
  }

  /// The first build: all that Embree does from the arrays to a scene that can be traced.
  void build(const testing::TriangleMesh& mesh) {
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, mode_.flags);
    rtcSetSceneBuildQuality(scene_, mode_.quality);
    geometry_ = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry_, mode_.quality);
    rtcSetSharedGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh.vtx2xyz.data(), 0, 3 * sizeof(float), mesh.vtx2xyz.size() / 3);
    rtcSetSharedGeometryBuffer(geometry_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.tri2vtx.data(), 0, 3 * sizeof(std::uint32_t),
                               mesh.triangle_count());
    rtcCommitGeometry(geometry_);
    rtcAttachGeometry(scene_, geometry_);
    rtcCommitScene(scene_);
    if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE) {
      throw std::runtime_error("Embree's error " + std::to_string(error));
    }
    vertex_bytes_ = mode_.reads_vertices ? mesh.vtx2xyz.size() * sizeof(float) : 0;
  }

  /// Builds again after all vertices were declared changed; Embree keeps its memory for it.
  void rebuild() {
    rtcUpdateGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }

  RTCScene scene() const { return scene_; }

  /// What Embree has allocated now, and the vertices where its tracer reads them.
  double byte_count() const {
    return static_cast<double>(bytes_.load()) + static_cast<double>(vertex_bytes_);
  }

 private:
  static bool count_bytes(void* self, ssize_t bytes, bool) {
    static_cast<EmbreePeer*>(self)->bytes_ += bytes;
    return true;
  }

  EmbreeMode mode_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  RTCGeometry geometry_ = nullptr;
  std::atomic<ssize_t> bytes_{0};
  std::size_t vertex_bytes_ = 0;
};

}  // namespace komorebi::bench
