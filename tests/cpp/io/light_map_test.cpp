// Maps in the least memory that holds them exactly, read band by band.
#include "io/light_map.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

namespace komorebi {
namespace {

namespace fs = std::filesystem;

TEST(LightMap, RgbeIsExactOrRefused) {
  std::mt19937 engine(1);
  const auto random = [&] { return static_cast<std::uint32_t>(engine()); };
  for (int i = 0; i < 200000; ++i) {
    const std::uint32_t exponent = 10 + random() % 246;
    const std::uint32_t word = (random() & 0xffffffu) | exponent << 24;
    const Vec3 value = rgbe_texel(word);
    const float expected = static_cast<float>(std::ldexp(double(word & 255u), int(exponent) - 136));
    ASSERT_EQ(value.x, expected);
    std::uint32_t back = 0;
    ASSERT_TRUE(exact_rgbe(&value.x, &back)) << std::hex << word;
    ASSERT_EQ(rgbe_texel(back), value);
    Vec3 other = value;
    other.y = std::nextafter(std::max(other.y, 1e-30f), 1e30f);  // needs more than eight bits
    EXPECT_FALSE(exact_rgbe(&other.x, &back) && !(rgbe_texel(back) == other));
  }
  const Vec3 black(0.0f);
  std::uint32_t word = 0;
  ASSERT_TRUE(exact_rgbe(&black.x, &word));
  EXPECT_EQ(rgbe_texel(word), black);
  for (const Vec3& v : {Vec3(1.0f, 1.0f / 512.0f, 0.0f), Vec3(0.1f), Vec3(3e38f), Vec3(1e-42f)}) {
    EXPECT_FALSE(exact_rgbe(&v.x, &word));
  }
}

TEST(LightMap, WidensAsItMust) {
  LightMap map("m", 2, 3);
  float first[] = {1, 2, 3, 0.5f, 0, 0.25f};
  map.put(1, 1, first);
  EXPECT_EQ(map.storage(), LightStorage::kRgbe);
  EXPECT_EQ(map.byte_count(), 24u);
  float halves[] = {1.0009765625f, 0, 0, 5.9604644775390625e-8f, 65504, 1};
  map.put(0, 1, halves);
  EXPECT_EQ(map.storage(), LightStorage::kHalf);
  EXPECT_EQ(map.byte_count(), 36u);
  const float inf = std::numeric_limits<float>::infinity();
  float bad[] = {-1, 0.1f, 7, inf, 1, 1};
  map.put(2, 1, bad);
  EXPECT_EQ(map.storage(), LightStorage::kFloat);
  EXPECT_EQ(map.byte_count(), 72u);
  const Vec3 expected[] = {Vec3(1.0009765625f, 0, 0),
                           Vec3(5.9604644775390625e-8f, 65504, 1),
                           Vec3(1, 2, 3),
                           Vec3(0.5f, 0, 0.25f),
                           Vec3(0, 0.1f, 7),
                           Vec3(0)};
  for (std::uint64_t i = 0; i < 6; ++i) EXPECT_EQ(map.texel(i), expected[i]) << i;
  EXPECT_EQ(map.nonfinite_texels(), 1u);
  EXPECT_EQ(map.negative_texels(), 1u);
  EXPECT_EQ(map.max_radiance(), 65504.0f);
  EXPECT_THROW(LightMap("none", 0, 4), std::invalid_argument);
}

TEST(LightMap, NegativeZerosHaveNoSign) {
  LightMap map("m", 2, 1);
  float texels[] = {1.0009765625f, -0.0f, 2, 0.5f, 1, -0.0f};
  map.put(0, 1, texels);
  ASSERT_EQ(map.storage(), LightStorage::kHalf);
  EXPECT_FALSE(std::signbit(map.texel(0).y));
  EXPECT_FALSE(std::signbit(map.texel(1).z));
  EXPECT_EQ(map.negative_texels(), 0u);
}

TEST(LightMap, FilesAreReadAsReadImageReadsThem) {
  const fs::path folder =
      fs::temp_directory_path() / ("komorebi_maps_" + std::to_string(std::random_device{}()));
  fs::create_directories(folder);
  std::mt19937 random(1);
  const int width = 70, height = 85;  // no whole number of bands
  std::vector<float> light(std::size_t(3 * width * height));
  for (float& v : light) v = static_cast<float>(random() % 65536) / 300.0f;
  const struct {
    const char* name;
    OIIO::TypeDesc type;
    int channels, tile;
    LightStorage storage;
  } files[] = {
      {"a.hdr", OIIO::TypeDesc::FLOAT, 3, 0, LightStorage::kRgbe},
      {"half.exr", OIIO::TypeDesc::HALF, 3, 0, LightStorage::kHalf},
      {"float.exr", OIIO::TypeDesc::FLOAT, 3, 0, LightStorage::kFloat},
      {"tiles.exr", OIIO::TypeDesc::HALF, 3, 32, LightStorage::kHalf},
      {"grey.exr", OIIO::TypeDesc::HALF, 1, 0, LightStorage::kHalf},
      {"a.png", OIIO::TypeDesc::UINT8, 3, 0, LightStorage::kFloat},
      {"a.tif", OIIO::TypeDesc::UINT16, 3, 16, LightStorage::kFloat},
  };
  for (const auto& file : files) {
    const std::string path = (folder / file.name).string();
    const auto output = OIIO::ImageOutput::create(path);
    OIIO::ImageSpec spec(width, height, file.channels, file.type);
    spec.tile_width = spec.tile_height = file.tile;
    ASSERT_TRUE(output->open(path, spec)) << output->geterror();
    std::vector<float> values(light);
    if (file.storage == LightStorage::kFloat && file.channels == 3 && path.back() != 'r') {
      for (float& v : values) v /= 300.0f;
    }
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
    ASSERT_TRUE(output->close());
    for (const ColorSpace space : {ColorSpace::kLinear, ColorSpace::kSrgb}) {
      const LightMap map = read_light_map(path, space);
      const Image image = read_image(path, space);
      if (space == ColorSpace::kLinear) {
        EXPECT_EQ(map.storage(), file.storage) << path;
      }
      ASSERT_EQ(map.width(), image.width);
      ASSERT_EQ(map.height(), image.height);
      for (std::uint64_t i = 0; i < map.texel_count(); ++i) {
        const float* p = &image.pixels[3 * i];
        ASSERT_EQ(map.texel(i), Vec3(p[0], p[1], p[2])) << path << " " << i;
      }
    }
    fs::resize_file(path, fs::file_size(path) / 2);
    EXPECT_THROW(read_light_map(path, ColorSpace::kLinear), std::runtime_error) << path;
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace komorebi
