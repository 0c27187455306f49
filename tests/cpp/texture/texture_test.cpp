// Look-ups against the definitions, written down anew in double precision.
#include "texture/texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "core/half.h"
#include "core/srgb.h"
#include "parallel/thread_pool.h"

namespace komorebi {
namespace {

template <class T>
Texels texels_of(std::uint32_t width, std::uint32_t height, std::uint32_t channels, TexelType type,
                 const std::vector<T>& values) {
  Texels texels;
  texels.width = width;
  texels.height = height;
  texels.channels = channels;
  texels.type = type;
  EXPECT_EQ(values.size() * sizeof(T), texels.byte_count());
  texels.data.reset(new std::byte[texels.byte_count()]);
  std::memcpy(texels.data.get(), values.data(), texels.byte_count());
  return texels;
}

std::vector<float> random_values(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<float> values(count);
  for (float& v : values) v = static_cast<float>(random() % 1000) / 500.0f;
  return values;
}

Texture float_texture(std::uint32_t width, std::uint32_t height, const std::vector<float>& values,
                      unsigned threads = 1) {
  ThreadPool pool(threads);
  return Texture("t", texels_of(width, height, 4, TexelType::kFloat, values), {}, pool);
}

// The picture continued over the plane: what extension says that texel (x, y) is.
int wrapped(Extension extension, int x, int n) {
  switch (extension) {
    case Extension::kRepeat:
      return ((x % n) + n) % n;
    case Extension::kExtend:
      return std::clamp(x, 0, n - 1);
    case Extension::kMirror: {
      const int r = ((x % (2 * n)) + 2 * n) % (2 * n);
      return r < n ? r : 2 * n - 1 - r;
    }
    default:
      return x >= 0 && x < n ? x : -1;
  }
}

double spline(double d) {  // the uniform cubic B-spline about 0
  d = std::abs(d);
  if (d < 1.0) return 2.0 / 3.0 - d * d + 0.5 * d * d * d;
  return d < 2.0 ? (2.0 - d) * (2.0 - d) * (2.0 - d) / 6.0 : 0.0;
}

double kernel(Interpolation interpolation, double d) {
  if (interpolation == Interpolation::kClosest) return d >= -0.5 && d < 0.5 ? 1.0 : 0.0;
  if (interpolation == Interpolation::kLinear) return std::max(0.0, 1.0 - std::abs(d));
  return spline(d);
}

TEST(Texture, LookupsAreSumsOverTexelsByTheirKernel) {
  constexpr int kWidth = 7, kHeight = 5;
  const auto values = random_values(4 * kWidth * kHeight, 1);
  const Texture texture = float_texture(kWidth, kHeight, values);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> place(-2.3f, 3.1f);
  for (const auto interpolation : {Interpolation::kClosest, Interpolation::kLinear,
                                   Interpolation::kCubic, Interpolation::kSmart}) {
    for (const auto extension :
         {Extension::kRepeat, Extension::kExtend, Extension::kClip, Extension::kMirror}) {
      for (int i = 0; i < 500; ++i) {
        const float u = place(random), v = place(random);
        const double x = double{u} * kWidth - 0.5, y = double{v} * kHeight - 0.5;
        double expected[4] = {};
        for (int row = int(std::floor(y)) - 2; row <= int(std::floor(y)) + 3; ++row) {
          for (int column = int(std::floor(x)) - 2; column <= int(std::floor(x)) + 3; ++column) {
            const double weight =
                kernel(interpolation, column - x) * kernel(interpolation, row - y);
            const int c = wrapped(extension, column, kWidth), r = wrapped(extension, row, kHeight);
            if (c < 0 || r < 0) continue;
            for (int k = 0; k < 4; ++k) {
              expected[k] += weight * double{values[std::size_t(4 * (r * kWidth + c) + k)]};
            }
          }
        }
        const Vec4 got = texture.lookup({interpolation, extension, false}, u, v);
        for (int k = 0; k < 4; ++k) {
          ASSERT_NEAR(got[k], expected[k], 2e-5)
              << int(interpolation) << " " << int(extension) << " " << u << " " << v;
        }
      }
    }
  }
}

TEST(Texture, EachTypeGivesItsNumbers) {
  ThreadPool pool(1);
  const TextureSampling closest{Interpolation::kClosest, Extension::kRepeat, false};
  const Texture byte("b", texels_of<std::uint8_t>(1, 1, 4, TexelType::kByte, {51, 0, 255, 102}), {},
                     pool);
  EXPECT_EQ(byte.lookup(closest, 0.5f, 0.5f),
            Vec4(51 * (1.0f / 255.0f), 0.0f, 1.0f, 102 * (1.0f / 255.0f)));
  const Texture grey("g", texels_of<std::uint16_t>(1, 1, 1, TexelType::kShort, {13107}), {}, pool);
  const Vec4 value = grey.lookup(closest, 0.5f, 0.5f);
  EXPECT_NEAR(value.x, 0.2f, 1e-7f);
  EXPECT_EQ(value, Vec4(value.x, value.x, value.x, 1.0f));
  const Texture half(
      "h", texels_of<std::uint16_t>(1, 1, 4, TexelType::kHalf, {0x3c00, 0xc000, 0x7bff, 0x0001}),
      {}, pool);
  EXPECT_EQ(half.lookup(closest, 0.5f, 0.5f), Vec4(1.0f, -2.0f, 65504.0f, std::ldexp(1.0f, -24)));
}

TEST(Texture, GreyOutsideAClippedPictureIsBlackAndOpaque) {
  ThreadPool pool(1);
  const Texture grey("g", texels_of<std::uint8_t>(2, 2, 1, TexelType::kByte, {255, 255, 255, 255}),
                     {}, pool);
  for (const auto interpolation :
       {Interpolation::kClosest, Interpolation::kLinear, Interpolation::kCubic}) {
    const Vec4 value = grey.lookup({interpolation, Extension::kClip, true}, 3.0f, 0.5f);
    EXPECT_EQ(value, Vec4(0.0f, 0.0f, 0.0f, 1.0f));
  }
}

TEST(Texture, SrgbIsDecodedAfterInterpolationAndDivision) {
  ThreadPool pool(1);
  TextureColor srgb;
  srgb.srgb = true;
  const Texture texture(
      "s", texels_of<std::uint8_t>(2, 1, 4, TexelType::kByte, {0, 0, 0, 255, 200, 100, 50, 55}),
      srgb, pool);
  const auto decode = [](double x) {
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  };
  const TextureSampling linear{Interpolation::kLinear, Extension::kExtend, false};
  const Vec4 plain = texture.lookup(linear, 0.5f, 0.5f);
  EXPECT_NEAR(plain.x, decode(100 / 255.0), 1e-6);
  EXPECT_NEAR(plain.w, 155 / 255.0, 1e-6);
  const Vec4 straight =
      texture.lookup({Interpolation::kLinear, Extension::kExtend, true}, 0.5f, 0.5f);
  EXPECT_NEAR(straight.x, decode(100.0 / 155.0), 1e-6);
  TextureColor data;
  data.data = true;
  const Texture packed("p", texels_of<std::uint8_t>(1, 1, 4, TexelType::kByte, {200, 100, 50, 55}),
                       data, pool);
  EXPECT_NEAR(packed.lookup({Interpolation::kLinear, Extension::kExtend, true}, 0.5f, 0.5f).x,
              200 / 255.0, 1e-6);
}

TEST(Texture, SrgbCurves) {
  for (int i = 0; i <= 200000; ++i) {
    const float x = static_cast<float>(i) / 20000.0f;  // to 10
    const double linear =
        x < 0.04045f ? double{x} / 12.92 : std::pow((double{x} + 0.055) / 1.055, 2.4);
    ASSERT_NEAR(srgb_to_linear(x), linear, 1e-6 * linear) << x;
    const double encoded =
        x < 0.0031308f ? double{x} * 12.92 : 1.055 * std::pow(double{x}, 1.0 / 2.4) - 0.055;
    ASSERT_NEAR(linear_to_srgb(x), encoded, 1e-6 * encoded) << x;
  }
  EXPECT_EQ(srgb_to_linear(-1.0f), 0.0f);
  for (int i = 0; i < 256; ++i) {
    const float x = static_cast<float>(i) / 255.0f;
    EXPECT_EQ(std::lround(linear_to_srgb(srgb_to_linear(x)) * 255.0f), i);
  }
}

TEST(Texture, HalvesAreExactAndRoundToEven) {
  for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    const int exponent = half >> 10 & 31, fraction = half & 1023;
    const double magnitude =
        exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
    const float value = float_from_half(half);
    if (exponent == 31) {
      EXPECT_FALSE(std::isfinite(value));
      continue;
    }
    ASSERT_EQ(double{value}, half & 0x8000 ? -magnitude : magnitude);
    ASSERT_EQ(half_from_float(value), half);
    if ((half & 0x7fff) < 0x7bff) {
      const float next = float_from_half(static_cast<std::uint16_t>(half + 1));
      const float middle = 0.5f * (value + next);
      ASSERT_EQ(half_from_float(middle), half & 1 ? half + 1 : half);
      ASSERT_EQ(half_from_float(std::nextafter(middle, value)), half);
      ASSERT_EQ(half_from_float(std::nextafter(middle, next)), half + 1);
    }
  }
  EXPECT_EQ(half_from_float(1e9f), 0x7bff);
  EXPECT_EQ(half_from_float(-1e9f), 0xfbff);
}

TEST(Texture, CoarseLevelsAreMeansOfLight) {
  for (const auto& [width, height] : {std::pair{8u, 8u}, {13u, 7u}, {1u, 65u}, {100u, 3u}}) {
    const auto values = random_values(std::size_t{4} * width * height, width);
    const Texture texture = float_texture(width, height, values);
    double mean[4] = {};
    for (std::size_t i = 0; i < values.size(); ++i) {
      mean[i % 4] += double{values[i]} / double(width * height);
    }
    // 1 × 65 pixels stay sharp: their shorter side cannot be coarser
    const Vec4 all = texture.lookup({}, 0.5f, 0.5f, 1.0f);
    if (width == 8) {
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(all[c], mean[c], 1e-5);
    }
    const Vec4 most = texture.lookup({}, 0.5f, 0.5f, 1e6f);
    if (width > 1) {
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(most[c], mean[c], 1e-5);
    }
  }
}

TEST(Texture, CoarseColoursAreWeighedByAlpha) {
  ThreadPool pool(1);
  TextureColor srgb;
  srgb.srgb = true;
  // half covered by a colour: the colour stays, alpha is halved
  const Texture leaf(
      "l",
      texels_of<std::uint8_t>(2, 2, 4, TexelType::kByte,
                              {188, 188, 188, 255, 0, 0, 0, 0, 0, 0, 0, 0, 188, 188, 188, 255}),
      srgb, pool);
  const Vec4 value =
      leaf.lookup({Interpolation::kLinear, Extension::kRepeat, true}, 0.5f, 0.5f, 2.0f);
  EXPECT_NEAR(value.w, 0.5f, 0.003f);
  EXPECT_NEAR(value.x, srgb_to_linear(188 / 255.0f), 0.006f);
}

TEST(Texture, LevelFollowsTheFootprint) {
  // a picture of bars, one texel wide: 0 and 1 in turn, grey as soon as they are averaged
  std::vector<float> bars(4 * 64 * 64);
  for (std::size_t i = 0; i < bars.size(); ++i) bars[i] = i / 4 % 2 ? 1.0f : 0.0f;
  const Texture texture = float_texture(64, 64, bars);
  const TextureSampling closest{Interpolation::kClosest, Extension::kRepeat, false};
  EXPECT_EQ(texture.lookup(closest, 1.5f / 64, 0.5f, 0.0f).x, 1.0f);
  EXPECT_EQ(texture.lookup(closest, 1.5f / 64, 0.5f, 1.9f / 64).x, 1.0f);
  EXPECT_EQ(texture.lookup(closest, 1.5f / 64, 0.5f, 2.0f / 64).x, 0.5f);
  EXPECT_EQ(texture.lookup(closest, 1.5f / 64, 0.5f, std::nanf("")).x, 1.0f);
}

TEST(Texture, CoarseLevelsHaveTheMeanOfFineLookUps) {
  // Bytes of all brightnesses side by side, decoded after interpolation: the mean over the picture
  // of what the finest level shows is what the coarsest one holds, within a byte's rounding.
  ThreadPool pool(2);
  std::mt19937 random(3);
  for (const std::uint32_t channels : {1u, 4u}) {
    std::vector<std::uint8_t> bytes(std::size_t{16} * 8 * channels);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      bytes[i] = i % 4 == 3 && channels == 4 ? 255 : static_cast<std::uint8_t>(random() % 256);
    }
    TextureColor color;
    color.srgb = true;
    const Texture texture("t", texels_of(16, 8, channels, TexelType::kByte, bytes), color, pool);
    const TextureSampling extended{Interpolation::kLinear, Extension::kExtend, false};
    constexpr int kSteps = 400;
    double sum = 0.0;
    for (int y = 0; y < kSteps; ++y) {
      for (int x = 0; x < kSteps; ++x) {
        const float u = (static_cast<float>(x) + 0.5f) / kSteps;
        const float v = (static_cast<float>(y) + 0.5f) / kSteps;
        sum += double{texture.lookup(extended, u, v).x} / (kSteps * kSteps);
      }
    }
    EXPECT_NEAR(double{texture.lookup(extended, 0.5f, 0.5f, 2.0f).x}, sum, 0.004) << channels;
  }
}

TEST(Texture, EqualForAnyThreadsAndLevelsLeftOut) {
  const auto values = random_values(4 * 300 * 217, 5);
  const Texture one = float_texture(300, 217, values, 1), four = float_texture(300, 217, values, 4);
  ThreadPool pool(3);
  const Texels header = texels_of(300, 217, 4, TexelType::kFloat, values);
  const Texture small("t", texels_of(300, 217, 4, TexelType::kFloat, values), {}, pool, {2, true});
  EXPECT_EQ(small.width(), 75u);
  EXPECT_EQ(small.byte_count() / 1000, Texture::byte_count(header, {}, {2, true}) / 1000);
  EXPECT_EQ(one.byte_count() / 1000, Texture::byte_count(header, {}) / 1000);
  for (const std::uint32_t skip : {0u, 2u}) {
    const TextureLevels alone = {skip, false};
    const Texture single("t", texels_of(300, 217, 4, TexelType::kFloat, values), {}, pool, alone);
    EXPECT_EQ(single.level_count(), 1u);
    EXPECT_EQ(single.byte_count(), Texture::byte_count(header, {}, alone));
    const Texture& whole = skip == 0 ? one : small;
    for (int i = 0; i < 50; ++i) {
      const float u = static_cast<float>(i) / 61.0f, v = static_cast<float>(i) / 97.0f;
      EXPECT_EQ(single.lookup({}, u, v, 0.5f), whole.lookup({Interpolation::kClosest}, u, v));
      EXPECT_EQ(single.lookup({}, u, v), whole.lookup({}, u, v));
    }
  }
  for (int i = 0; i < 200; ++i) {
    const float u = static_cast<float>(i) / 61.0f, v = static_cast<float>(i) / 97.0f;
    const float footprint = static_cast<float>(i % 20) / 200.0f;
    EXPECT_EQ(one.lookup({}, u, v, footprint), four.lookup({}, u, v, footprint));
    const TextureSampling closest{Interpolation::kClosest, Extension::kRepeat, false};
    EXPECT_EQ(one.lookup({}, u, v, 4.0f / 217.0f), small.lookup(closest, u, v, 0.0f));
  }
}

TEST(Texture, TilesFollowTheirNumbers) {
  const auto plain = [](float value) {
    return std::make_shared<const Texture>(float_texture(1, 1, {value, value, value, 1.0f}));
  };
  const Texture tiles("t", {{1012, plain(3.0f)}, {1001, plain(1.0f)}, {1002, plain(2.0f)}});
  EXPECT_EQ(tiles.lookup({}, 0.5f, 0.5f).x, 1.0f);
  EXPECT_EQ(tiles.lookup({}, -0.5f, 0.5f).x, 1.0f);  // as in Cycles
  EXPECT_EQ(tiles.lookup({}, 1.5f, 0.5f).x, 2.0f);
  EXPECT_EQ(tiles.lookup({}, 1.5f, 1.5f).x, 3.0f);
  for (const auto& [u, v] : {std::pair{2.5f, 0.5f},
                             {0.5f, 1.5f},
                             {-1.5f, 0.5f},
                             {10.5f, 0.5f},
                             {1e30f, 0.0f},
                             {std::nanf(""), 0.5f}}) {
    EXPECT_EQ(tiles.lookup({}, u, v), Vec4(1.0f, 0.0f, 1.0f, 1.0f)) << u << " " << v;
  }
  EXPECT_THROW(Texture("none", {}), std::invalid_argument);
  EXPECT_EQ(Texture::missing("m")->lookup({}, 0.3f, 0.3f), Vec4(1.0f, 0.0f, 1.0f, 1.0f));
}

TEST(Texture, OtherSpacesAreConverted) {
  ThreadPool pool(2);
  TextureColor color;
  color.has_matrix = true;
  color.matrix = {0.5f, 0.25f, 0.25f, 0, 1, 0, 0, 0, 2};
  const Texture texture(
      "m", texels_of<std::uint8_t>(1, 1, 4, TexelType::kByte, {51, 102, 204, 255}), color, pool);
  EXPECT_EQ(texture.type(), TexelType::kHalf);
  const Vec4 value = texture.lookup({}, 0.5f, 0.5f);
  EXPECT_NEAR(value.x, 0.4f, 3e-4f);
  EXPECT_NEAR(value.y, 0.4f, 3e-4f);
  EXPECT_NEAR(value.z, 1.6f, 1e-3f);
}

TEST(Texture, BadNumbersAreBlackAndCounted) {
  const float inf = std::numeric_limits<float>::infinity();
  const Texture texture = float_texture(3, 1, {1, inf, 1, 1, 1, 1, 1, 1, 1, 1, std::nanf(""), 1});
  EXPECT_EQ(texture.nonfinite_texels(), 2u);
  const TextureSampling closest{Interpolation::kClosest, Extension::kRepeat, false};
  EXPECT_EQ(texture.lookup(closest, 0.1f, 0.5f), Vec4(0.0f));
  EXPECT_EQ(texture.lookup(closest, 0.5f, 0.5f), Vec4(1.0f));
  for (const float bad : {inf, -inf, std::nanf(""), 3e38f, -3e38f}) {
    for (const auto extension :
         {Extension::kRepeat, Extension::kExtend, Extension::kClip, Extension::kMirror}) {
      const Vec4 value = texture.lookup({Interpolation::kCubic, extension, true}, bad, bad);
      EXPECT_TRUE(std::isfinite(value.x));
    }
  }
  ThreadPool pool(1);
  EXPECT_THROW(Texture("none", Texels(), {}, pool), std::invalid_argument);
}

TEST(Texture, AStripeOfPixelsIsAPicture) {
  std::vector<std::uint8_t> values(65536);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint8_t>(i);
  ThreadPool pool(2);
  const Texture texture("1x65536", texels_of(1, 65536, 1, TexelType::kByte, values), {}, pool);
  const TextureSampling closest{Interpolation::kClosest, Extension::kRepeat, false};
  for (const int y : {0, 1, 777, 65535}) {
    EXPECT_EQ(texture.lookup(closest, 0.5f, (static_cast<float>(y) + 0.5f) / 65536.0f).x,
              static_cast<float>(y % 256) * (1.0f / 255.0f));
  }
}

}  // namespace
}  // namespace komorebi
