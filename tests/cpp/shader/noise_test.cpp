#include <gtest/gtest.h>
#include "shader/program.h"
#include "shader/perlin.h"
#include "shader/fractal_noise.h"
#include <chrono>
#include <cstdio>
namespace komorebi {
TEST(Noise, Time) {
  float p[4][64], out[64], detail[64], half[64], two[64], one[64];
  for (int i = 0; i < 64; ++i) { for (int d = 0; d < 4; ++d) p[d][i] = 0.37f * float(i) + 1.7f * float(d); half[i] = .5f; two[i] = 2.f; one[i] = 1.f; }
  for (std::uint32_t dims = 1; dims <= 4; ++dims)
  for (float det : {0.f, 1.f, 7.f}) {
    for (int i = 0; i < 64; ++i) detail[i] = det;
    FractalKind kind; kind.dimensions = dims; kind.normalize = true;
    FractalRows rows{{p[0], p[1], p[2], p[3]}, detail, half, two, one, one};
    auto t = std::chrono::steady_clock::now();
    const int reps = 20000;
    float s = 0;
    for (int r = 0; r < reps; ++r) { fractal_noise(kind, rows, 64, out); s += out[r & 63]; }
    double ns = std::chrono::duration<double>(std::chrono::steady_clock::now() - t).count() * 1e9 / reps / 64;
    std::printf("%uD octaves %d: %.1f ns/lane %g\n", dims, int(det) + 1, ns, s);
  }
}
}
