#include "sim/image/io/png.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "sim/image/io/grey16.h"
#include "sim/image/io/image_file.h"
#include "tests/sim/image/scenes.h"

namespace hydroprint::image {
namespace {

/// An image whose bytes do not compress.
RgbImage noise(int width, int height) {
  std::uint32_t state = 1;
  RgbImage image{width, height, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(width) * height);
  for (std::uint8_t& byte : image.rgb) {
    state = state * 1664525 + 1013904223;
    byte = static_cast<std::uint8_t>(state >> 24);
  }
  return image;
}

RgbImage ramp(int width, int height) {
  return testing::make_image(width, height, [](int x, int y) {
    return std::array<int, 3>{x & 255, y & 255, (x + y) / 2 & 255};
  });
}

/// Pixels of a PNG as read by OpenImageIO, which uses libpng.
std::vector<std::uint8_t> decoded(const std::vector<unsigned char>& file, int& width, int& height) {
  OIIO::Filesystem::IOMemReader memory(file.data(), file.size());
  const auto input = OIIO::ImageInput::open("image.png", nullptr, &memory);
  if (!input) return {};
  width = input->spec().width;
  height = input->spec().height;
  EXPECT_EQ(input->spec().nchannels, 3);
  std::vector<std::uint8_t> pixels(3 * static_cast<std::size_t>(width) * height);
  EXPECT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.data()))
      << input->geterror();
  return pixels;
}

TEST(EncodePng, Grey16ReadsBackUnchanged) {
  Grey16Image image{641, 480, {}};
  for (int i = 0; i < 641 * 480; ++i) {
    image.grey.push_back(static_cast<std::uint16_t>(i * 2654435761U >> 15U));
  }
  const auto file = encode_png(image);
  ASSERT_TRUE(file);
  OIIO::Filesystem::IOMemReader memory(file->data(), file->size());
  const auto input = OIIO::ImageInput::open("image.png", nullptr, &memory);
  ASSERT_TRUE(input);
  EXPECT_EQ(input->spec().format, OIIO::TypeDesc::UINT16);
  EXPECT_EQ(input->spec().nchannels, 1);
  std::vector<std::uint16_t> grey(image.grey.size());
  ASSERT_TRUE(input->read_image(0, 0, 0, 1, OIIO::TypeDesc::UINT16, grey.data()));
  EXPECT_TRUE(grey == image.grey);
}

TEST(EncodePng, ReadsBackUnchangedForAnyImageSize) {
  // One pixel, one row, one column, one band of rows, several bands, and rows longer than a band.
  for (const auto& [width, height] :
       {std::pair{1, 1}, {700, 1}, {1, 700}, {300, 200}, {2480, 500}, {400000, 3}}) {
    for (const RgbImage& image : {ramp(width, height), noise(width, height)}) {
      const auto file = encode_png(image, 300);
      ASSERT_TRUE(file);
      int w = 0, h = 0;
      const auto pixels = decoded(*file, w, h);
      EXPECT_EQ(std::pair(w, h), std::pair(width, height));
      EXPECT_TRUE(pixels == image.rgb) << width << " x " << height;
    }
  }
}

TEST(EncodePng, IsByteIdenticalForAnyNumberOfThreads) {
  const RgbImage image = ramp(2480, 1200);
  Context one, three;
  three.threads = 3;
  EXPECT_EQ(*encode_png(image, 300, one), *encode_png(image, 300, three));
}

TEST(EncodePng, CompressesUniformImages) {
  RgbImage white = ramp(2480, 1200);
  const std::size_t bytes = white.rgb.size();
  EXPECT_LT(encode_png(white, 300)->size(), bytes / 20);
  white.rgb.assign(bytes, 255);
  EXPECT_LT(encode_png(white, 300)->size(), bytes / 200);
  EXPECT_LT(encode_png(noise(500, 500), 300)->size(), 500 * 500 * 3 * 1.01 + 1000);
}

TEST(EncodePng, StopsWhenCancelled) {
  Context context;
  context.cancelled = [] { return true; };
  const auto file = encode_png(ramp(2480, 1200), 300, context);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, Code::kCancelled);
}

}  // namespace
}  // namespace hydroprint::image
