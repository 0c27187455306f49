#pragma once

#include <cstdint>

#include "shader/lane.h"

/// Hashes of words to words and to numbers in [0, 1], as Cycles has them: Bob Jenkins' lookup3
/// (burtleburtle.net/bob/c/lookup3.c) for bits of floats, and since Blender 5.0, for Voronoi's
/// cells, PCG in 2 to 4 dimensions (Jarzynski and Olano 2020, "Hash Functions for GPU Rendering").
namespace komorebi {

namespace detail {

KOMOREBI_LANE std::uint32_t rotated(std::uint32_t x, int k) {
  return x << k | x >> (32 - k);
}

KOMOREBI_LANE void jenkins_mix(std::uint32_t& a, std::uint32_t& b, std::uint32_t& c) {
  a = (a - c) ^ rotated(c, 4);
  c += b;
  b = (b - a) ^ rotated(a, 6);
  a += c;
  c = (c - b) ^ rotated(b, 8);
  b += a;
  a = (a - c) ^ rotated(c, 16);
  c += b;
  b = (b - a) ^ rotated(a, 19);
  a += c;
  c = (c - b) ^ rotated(b, 4);
  b += a;
}

KOMOREBI_LANE std::uint32_t jenkins_final(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  c = (c ^ b) - rotated(b, 14);
  a = (a ^ c) - rotated(c, 11);
  b = (b ^ a) - rotated(a, 25);
  c = (c ^ b) - rotated(b, 16);
  a = (a ^ c) - rotated(c, 4);
  b = (b ^ a) - rotated(a, 14);
  return (c ^ b) - rotated(b, 24);
}

constexpr std::uint32_t jenkins_seed(std::uint32_t words) {
  return 0xdeadbeefu + (words << 2) + 13u;
}

}  // namespace detail

KOMOREBI_LANE std::uint32_t hash_words(std::uint32_t x) {
  constexpr std::uint32_t s = detail::jenkins_seed(1);
  return detail::jenkins_final(s + x, s, s);
}
KOMOREBI_LANE std::uint32_t hash_words(std::uint32_t x, std::uint32_t y) {
  constexpr std::uint32_t s = detail::jenkins_seed(2);
  return detail::jenkins_final(s + x, s + y, s);
}
KOMOREBI_LANE std::uint32_t hash_words(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  constexpr std::uint32_t s = detail::jenkins_seed(3);
  return detail::jenkins_final(s + x, s + y, s + z);
}
KOMOREBI_LANE std::uint32_t hash_words(std::uint32_t x, std::uint32_t y, std::uint32_t z,
                                       std::uint32_t w) {
  constexpr std::uint32_t s = detail::jenkins_seed(4);
  std::uint32_t a = s + x, b = s + y, c = s + z;
  detail::jenkins_mix(a, b, c);
  return detail::jenkins_final(a + w, b, c);
}

/// From [0, 2³² − 1] to [0, 1]. In two halves, whose sum is rounded once, as the whole would be:
/// processors convert signed words alone.
KOMOREBI_LANE float unit_float(std::uint32_t bits) {
  const auto high = static_cast<float>(static_cast<std::int32_t>(bits >> 16));
  const auto low = static_cast<float>(static_cast<std::int32_t>(bits & 0xffffu));
  return (high * 65536.0f + low) * (1.0f / 4294967295.0f);
}

/// The hash of floats' bits, in [0, 1].
template <class... T>
KOMOREBI_LANE float hash_floats(T... x) {
  return unit_float(hash_words(float_bits(x)...));
}

namespace detail {

// An arithmetic shift, as of signed words.
KOMOREBI_LANE std::uint32_t pcg_shifted(std::uint32_t x) {
  return x ^ static_cast<std::uint32_t>(static_cast<std::int32_t>(x) >> 16);
}
KOMOREBI_LANE float pcg_float(std::uint32_t x) {
  return static_cast<float>(static_cast<std::int32_t>(x & 0x7fffffffu)) * (1.0f / 2147483647.0f);
}

}  // namespace detail

/// PCG of 2, 3 or 4 words, replaced by as many numbers in [0, 1].
KOMOREBI_LANE void hash_pcg(const std::uint32_t (&k)[2], float (&out)[2]) {
  constexpr std::uint32_t kA = 1664525u, kC = 1013904223u;
  std::uint32_t x = k[0] * kA + kC, y = k[1] * kA + kC;
  x += y * kA;
  y += x * kA;
  x = detail::pcg_shifted(x);
  y = detail::pcg_shifted(y);
  x += y * kA;
  y += x * kA;
  out[0] = detail::pcg_float(x);
  out[1] = detail::pcg_float(y);
}
KOMOREBI_LANE void hash_pcg(const std::uint32_t (&k)[3], float (&out)[3]) {
  constexpr std::uint32_t kA = 1664525u, kC = 1013904223u;
  std::uint32_t x = k[0] * kA + kC, y = k[1] * kA + kC, z = k[2] * kA + kC;
  x += y * z;
  y += z * x;
  z += x * y;
  x = detail::pcg_shifted(x);
  y = detail::pcg_shifted(y);
  z = detail::pcg_shifted(z);
  x += y * z;
  y += z * x;
  z += x * y;
  out[0] = detail::pcg_float(x);
  out[1] = detail::pcg_float(y);
  out[2] = detail::pcg_float(z);
}
KOMOREBI_LANE void hash_pcg(const std::uint32_t (&k)[4], float (&out)[4]) {
  constexpr std::uint32_t kA = 1664525u, kC = 1013904223u;
  std::uint32_t x = k[0] * kA + kC, y = k[1] * kA + kC, z = k[2] * kA + kC, w = k[3] * kA + kC;
  x += y * w;
  y += z * x;
  z += x * y;
  w += y * z;
  x = detail::pcg_shifted(x);
  y = detail::pcg_shifted(y);
  z = detail::pcg_shifted(z);
  w = detail::pcg_shifted(w);
  x += y * w;
  y += z * x;
  z += x * y;
  w += y * z;
  out[0] = detail::pcg_float(x);
  out[1] = detail::pcg_float(y);
  out[2] = detail::pcg_float(z);
  out[3] = detail::pcg_float(w);
}

}  // namespace komorebi
