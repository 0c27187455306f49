// What the promise of equal bits asks of the compiler, beside its flags.
#include <gtest/gtest.h>

namespace komorebi {
namespace {

struct Point {
  float x, y;
};

// GCC 12 at -O2 drops double → float → double where it vectorizes straight-line code, so that a
// point rounded to float is not; -fno-tree-slp-vectorize prevents it.
[[gnu::noipa]] void round_to_float(double* out, const double* in) {
  const Point rounded{static_cast<float>(in[0]), static_cast<float>(in[1])};
  const double x = double{rounded.x}, y = double{rounded.y};
  out[0] = x;
  out[1] = y;
}

TEST(Compiler, RoundsToFloatWhereItIsWritten) {
  const double in[2] = {0.1, 0.3};
  double out[2];
  round_to_float(out, in);
  EXPECT_EQ(out[0], 0x1.99999ap-4);
  EXPECT_EQ(out[1], 0x1.333334p-2);
}

}  // namespace
}  // namespace komorebi
