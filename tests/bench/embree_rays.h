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
  static constexpr std::uint32_t kStream = 256;  ///< rays of one call of a stream

  virtual ~EmbreeRays() = default;
  /// Undoes what a query has written. Not timed.
  virtual void reset(const testing::RayList& rays) = 0;
  virtual void trace(RTCScene scene, RTCIntersectContext* context, std::uint32_t chunk) = 0;
  /// Whether each ray met something, after `trace` of all chunks.
  virtual bool met(std::uint32_t ray) const = 0;
};

/// Packets of W rays, chunk by chunk; W = 1 serves single rays and streams. Packets with a hit
/// (RTCRayHit…) ask for the closest, those without whether there is any.
template <class Packet, std::uint32_t W>
class EmbreePackets : public EmbreeRays {
  static constexpr bool kClosest = requires(Packet p) { p.hit; };

 public:
  EmbreePackets(const RaySet& set, bool stream) : stream_(stream) {
    for (std::uint32_t chunk = 0; chunk < set.chunk_count(); ++chunk) {
      first_packet_.push_back(static_cast<std::uint32_t>(packets_.size()));
      for (std::uint32_t i = set.first_ray(chunk); i < set.end_ray(chunk); i += W) {
        const std::uint32_t count = std::min(W, set.end_ray(chunk) - i);
        Packet& packet = packets_.emplace_back();
        for (std::uint32_t lane = 0; lane < count; ++lane) {
          store(ray_of(packet), lane, set.list[i + lane]);
          place_.push_back({static_cast<std::uint32_t>(packets_.size() - 1), lane});
        }
        active_.push_back(count);
      }
    }
    first_packet_.push_back(static_cast<std::uint32_t>(packets_.size()));
  }

  void reset(const testing::RayList& rays) override {
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      Packet& packet = packets_[place_[i].packet];
      if constexpr (kClosest) lane_of(packet.hit.geomID, place_[i].lane) = RTC_INVALID_GEOMETRY_ID;
      lane_of(ray_of(packet).tfar, place_[i].lane) = rays.span().t_max[i];
    }
  }

  void trace(RTCScene scene, RTCIntersectContext* context, std::uint32_t chunk) override {
    const std::uint32_t end = first_packet_[chunk + 1];
    for (std::uint32_t i = first_packet_[chunk]; i < end; i += stream_ ? kStream : 1) {
      if (stream_) {
        query_stream(scene, context, &packets_[i], std::min(kStream, end - i));
      } else {
        query(scene, context, &packets_[i], active_[i]);
      }
    }
  }

  bool met(std::uint32_t ray) const override {
    const Packet& packet = packets_[place_[ray].packet];
    if constexpr (kClosest) {
      return lane_of(packet.hit.geomID, place_[ray].lane) != RTC_INVALID_GEOMETRY_ID;
    } else {
      return lane_of(packet.tfar, place_[ray].lane) < 0.0f;
    }
  }

 private:
  static void query_stream(RTCScene scene, RTCIntersectContext* context, Packet* packet,
                           std::uint32_t count) {
    if constexpr (W == 1 && kClosest) rtcIntersect1M(scene, context, packet, count, sizeof *packet);
    if constexpr (W == 1 && !kClosest) rtcOccluded1M(scene, context, packet, count, sizeof *packet);
  }

  static void query(RTCScene scene, RTCIntersectContext* context, Packet* packet,
                    std::uint32_t active) {
    alignas(64) int valid[W];
    for (std::uint32_t lane = 0; lane < W; ++lane) valid[lane] = lane < active ? -1 : 0;
    if constexpr (W == 1 && kClosest) rtcIntersect1(scene, context, packet);
    if constexpr (W == 1 && !kClosest) rtcOccluded1(scene, context, packet);
    if constexpr (W == 4 && kClosest) rtcIntersect4(valid, scene, context, packet);
    if constexpr (W == 4 && !kClosest) rtcOccluded4(valid, scene, context, packet);
    if constexpr (W == 8 && kClosest) rtcIntersect8(valid, scene, context, packet);
    if constexpr (W == 8 && !kClosest) rtcOccluded8(valid, scene, context, packet);
    if constexpr (W == 16 && kClosest) rtcIntersect16(valid, scene, context, packet);
    if constexpr (W == 16 && !kClosest) rtcOccluded16(valid, scene, context, packet);
  }

  template <class P>
  static auto& ray_of(P& packet) {
    if constexpr (kClosest) {
      return packet.ray;
    } else {
      return packet;
    }
  }
  template <class Field>
  static auto& lane_of(Field& field, std::uint32_t lane) {
    if constexpr (W == 1) {
      return field;
    } else {
      return field[lane];
    }
  }
  template <class R>
  static void store(R& packet, std::uint32_t lane, const Ray& ray) {
    lane_of(packet.org_x, lane) = ray.origin.x, lane_of(packet.dir_x, lane) = ray.direction.x;
    lane_of(packet.org_y, lane) = ray.origin.y, lane_of(packet.dir_y, lane) = ray.direction.y;
    lane_of(packet.org_z, lane) = ray.origin.z, lane_of(packet.dir_z, lane) = ray.direction.z;
    lane_of(packet.tnear, lane) = ray.t_min, lane_of(packet.tfar, lane) = ray.t_max;
    lane_of(packet.time, lane) = 0.0f, lane_of(packet.mask, lane) = ~0u;
    lane_of(packet.id, lane) = 0, lane_of(packet.flags, lane) = 0;
  }

  struct Where {
    std::uint32_t packet, lane;
  };
  bool stream_;
  std::vector<Packet> packets_;
  std::vector<std::uint32_t> first_packet_, active_;
  std::vector<Where> place_;
};

/// @param closest  ask for closest hits (rtcIntersect…), not for any (rtcOccluded…)
inline std::unique_ptr<EmbreeRays> embree_rays(const RaySet& set, int width, bool closest) {
  const auto make = [&]<class Packet, std::uint32_t W>() -> std::unique_ptr<EmbreeRays> {
    return std::make_unique<EmbreePackets<Packet, W>>(set, width == 0);
  };
  switch (width) {
    case 4:
      return closest ? make.template operator()<RTCRayHit4, 4>()
                     : make.template operator()<RTCRay4, 4>();
    case 8:
      return closest ? make.template operator()<RTCRayHit8, 8>()
                     : make.template operator()<RTCRay8, 8>();
    case 16:
      return closest ? make.template operator()<RTCRayHit16, 16>()
                     : make.template operator()<RTCRay16, 16>();
    default:
      return closest ? make.template operator()<RTCRayHit, 1>()
                     : make.template operator()<RTCRay, 1>();
  }
}

}  // namespace komorebi::bench
