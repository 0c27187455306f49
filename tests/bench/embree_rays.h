#pragma once

#include <memory>
#include <vector>

#include "bench/embree_peer.h"
#include "bench/ray_sets.h"

namespace komorebi::bench {

/// How Embree is asked: one ray, packets of 4, 8 or 16 (all lanes active but in the last of a
/// chunk), or its streams ("1M"); each with the flag for coherent rays or without.
struct EmbreeQuery {
  int width;  ///< 1, 4, 8, 16; 0: a stream
  bool coherent;
};

/// A query's rays in Embree's own layout, made beforehand: filling it is not timed.
class EmbreeRays {
 public:
  static constexpr std::uint32_t kStream = 256;  ///< rays of one call of rtcOccluded1M

  virtual ~EmbreeRays() = default;
  /// Undoes what a query has written. Not timed.
  virtual void reset(const testing::RayList& rays) = 0;
  virtual void occluded(RTCScene scene, RTCIntersectContext* context, std::uint32_t chunk) = 0;
  /// Whether each ray was found blocked, after `occluded` of all chunks.
  virtual bool blocked(std::uint32_t ray) const = 0;
};

/// Packets of W rays, chunk by chunk; W = 1 serves single rays and streams.
template <class Packet, std::uint32_t W>
class EmbreePackets : public EmbreeRays {
 public:
  EmbreePackets(const RaySet& set, int query_width) : query_width_(query_width) {
    for (std::uint32_t chunk = 0; chunk < set.chunk_count(); ++chunk) {
      first_packet_.push_back(static_cast<std::uint32_t>(packets_.size()));
      for (std::uint32_t i = set.first_ray(chunk); i < set.end_ray(chunk); i += W) {
        const std::uint32_t count = std::min(W, set.end_ray(chunk) - i);
        Packet& packet = packets_.emplace_back();
        for (std::uint32_t lane = 0; lane < count; ++lane) {
          store(packet, lane, set.list[i + lane]);
          place_.push_back({static_cast<std::uint32_t>(packets_.size() - 1), lane});
        }
        active_.push_back(count);
      }
    }
    first_packet_.push_back(static_cast<std::uint32_t>(packets_.size()));
  }

  void reset(const testing::RayList& rays) override {
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      far_of(packets_[place_[i].packet], place_[i].lane) = rays.span().t_max[i];
    }
  }

  void occluded(RTCScene scene, RTCIntersectContext* context, std::uint32_t chunk) override {
    const std::uint32_t end = first_packet_[chunk + 1];
    if (query_width_ == 0) {
      for (std::uint32_t i = first_packet_[chunk]; i < end; i += kStream) {
        rtcOccluded1M(scene, context, reinterpret_cast<RTCRay*>(&packets_[i]),
                      std::min(kStream, end - i), sizeof(RTCRay));
      }
      return;
    }
    alignas(64) static thread_local int valid[16];
    for (std::uint32_t i = first_packet_[chunk]; i < end; ++i) {
      if constexpr (W > 1) {
        for (std::uint32_t lane = 0; lane < W; ++lane) valid[lane] = lane < active_[i] ? -1 : 0;
      }
      if constexpr (W == 1) rtcOccluded1(scene, context, &packets_[i]);
      if constexpr (W == 4) rtcOccluded4(valid, scene, context, &packets_[i]);
      if constexpr (W == 8) rtcOccluded8(valid, scene, context, &packets_[i]);
      if constexpr (W == 16) rtcOccluded16(valid, scene, context, &packets_[i]);
    }
  }

  bool blocked(std::uint32_t ray) const override {
    return far_of(packets_[place_[ray].packet], place_[ray].lane) < 0.0f;
  }

 private:
  template <class P>
  static auto& far_of(P& packet, std::uint32_t lane) {
    if constexpr (W == 1) {
      return packet.tfar;
    } else {
      return packet.tfar[lane];
    }
  }
  static void store(Packet& packet, std::uint32_t lane, const Ray& ray) {
    const RTCRay one{ray.origin.x,
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
    if constexpr (W == 1) {
      packet = one;
    } else {
      packet.org_x[lane] = one.org_x, packet.org_y[lane] = one.org_y,
      packet.org_z[lane] = one.org_z;
      packet.dir_x[lane] = one.dir_x, packet.dir_y[lane] = one.dir_y,
      packet.dir_z[lane] = one.dir_z;
      packet.tnear[lane] = one.tnear, packet.tfar[lane] = one.tfar, packet.time[lane] = 0.0f;
      packet.mask[lane] = one.mask, packet.id[lane] = 0, packet.flags[lane] = 0;
    }
  }

  struct Where {
    std::uint32_t packet, lane;
  };
  int query_width_;
  std::vector<Packet> packets_;
  std::vector<std::uint32_t> first_packet_, active_;
  std::vector<Where> place_;
};

inline std::unique_ptr<EmbreeRays> embree_rays(const RaySet& set, int width) {
  switch (width) {
    case 4:
      return std::make_unique<EmbreePackets<RTCRay4, 4>>(set, width);
    case 8:
      return std::make_unique<EmbreePackets<RTCRay8, 8>>(set, width);
    case 16:
      return std::make_unique<EmbreePackets<RTCRay16, 16>>(set, width);
    default:
      return std::make_unique<EmbreePackets<RTCRay, 1>>(set, width);
  }
}

}  // namespace komorebi::bench
