#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "sim/image/io/colour.h"
#include "sim/image/io/image_file.h"
#include "tests/sim/image/io/image_files.h"
#include "tests/sim/image/scenes.h"

namespace hydroprint::image {
namespace {

using namespace testing;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

std::vector<char> bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void put(const std::filesystem::path& path, const std::vector<char>& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
}

RgbImage gradient(int width, int height) {
  return make_image(width, height, [](int x, int y) {
    return std::array<int, 3>{x * 3 % 256, y * 5 % 256, (x + y) * 7 % 256};
  });
}

void expect_refused(const Result<ReadImage>& read, Code code, const std::string& name) {
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, code) << read.error().message;
  EXPECT_NE(read.error().message.find(name), std::string::npos) << read.error().message;
  EXPECT_EQ(read.error().message.find('\n'), std::string::npos) << read.error().message;
}

TEST(ReadImage, EightBitCodesSurviveConversionToLinearLight) {
  for (int code = 0; code < 256; ++code) {
    const auto linear = linear16_from_srgb16(static_cast<std::uint16_t>(code * 257));
    EXPECT_EQ(srgb8_from_linear(static_cast<float>(linear) / 65535.0F), code);
  }
}

TEST(ReadImage, PngAndTiffGiveTheirPixels) {
  const TemporaryFolder folder;
  const RgbImage image = gradient(70, 45);
  ASSERT_TRUE(write_png(folder / "a.png", image, 72));
  write_with_oiio(folder / "a.tif", ImageSpec(70, 45, 3, TypeDesc::UINT8), TypeDesc::UINT8,
                  image.rgb);
  ImageSpec tiled(70, 45, 3, TypeDesc::UINT8);
  tiled.tile_width = tiled.tile_height = 16;
  write_with_oiio(folder / "tiled.tif", tiled, TypeDesc::UINT8, image.rgb);
  for (const std::string name : {"a.png", "a.tif", "tiled.tif"}) {
    const auto read = read_image(folder / name, {});
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_FALSE(read->had_alpha);
    ASSERT_EQ(read->image.width, 70);
    ASSERT_EQ(read->image.height, 45);
    for (int i = 0; i < 70 * 45; ++i) {
      const auto rgb = srgb8(read->image.texels[i]);
      for (int c = 0; c < 3; ++c) ASSERT_EQ(rgb[c], image.rgb[3 * i + c]) << name << " " << i;
    }
  }
}

TEST(ReadImage, GreySixteenBitAndFloatImagesAreRead) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> grey(64, 100);
  write_with_oiio(folder / "grey.png", ImageSpec(8, 8, 1, TypeDesc::UINT8), TypeDesc::UINT8, grey);
  const std::vector<std::uint16_t> deep(64 * 3, 30000);
  write_with_oiio(folder / "deep.png", ImageSpec(8, 8, 3, TypeDesc::UINT16), TypeDesc::UINT16,
                  deep);
  std::vector<float> light(64 * 3, 0.25F);
  light[5] = std::nanf("");
  light[6] = 7;
  write_with_oiio(folder / "light.tif", ImageSpec(8, 8, 3, TypeDesc::FLOAT), TypeDesc::FLOAT,
                  light);

  const auto a = read_image(folder / "grey.png", {});
  ASSERT_TRUE(a);
  EXPECT_EQ(srgb8(a->image.texels[9]), (std::array<int, 3>{100, 100, 100}));
  const auto b = read_image(folder / "deep.png", {});
  ASSERT_TRUE(b);
  EXPECT_EQ(b->image.texels[9].g, linear16_from_srgb16(30000));
  const auto c = read_image(folder / "light.tif", {});
  ASSERT_TRUE(c);
  EXPECT_EQ(c->image.texels[9].b, 16384);
  EXPECT_EQ(c->image.texels[1].b, 0) << "NaN must become 0";
  EXPECT_EQ(c->image.texels[2].r, 65535) << "values beyond white must become white";
}

TEST(ReadImage, AlphaIsLaidOverWhiteInLinearLight) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> rgba, grey_alpha;
  for (const int alpha : {0, 128, 255, 255}) {
    for (const int value : {200, 0, 0, alpha}) rgba.push_back(static_cast<std::uint8_t>(value));
    for (const int value : {50, alpha}) grey_alpha.push_back(static_cast<std::uint8_t>(value));
  }
  write_with_oiio(folder / "rgba.png", ImageSpec(2, 2, 4, TypeDesc::UINT8), TypeDesc::UINT8, rgba);
  write_with_oiio(folder / "rgba.tif", ImageSpec(2, 2, 4, TypeDesc::UINT8), TypeDesc::UINT8, rgba);
  for (const std::string name : {"rgba.png", "rgba.tif"}) {
    const auto read = read_image(folder / name, {});
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_TRUE(read->had_alpha);
    EXPECT_EQ(srgb8(read->image.texels[0]), (std::array<int, 3>{255, 255, 255}));
    const float half = 128.0F / 255;
    const float red = linear_from_srgb(200 / 255.0F) * half + 1 - half;
    EXPECT_NEAR(read->image.texels[1].r, red * 65535, 2) << name;
    EXPECT_NEAR(read->image.texels[1].g, (1 - half) * 65535, 2) << name;
    EXPECT_EQ(srgb8(read->image.texels[2]), (std::array<int, 3>{200, 0, 0}));
  }
  ImageSpec spec(2, 2, 2, TypeDesc::UINT8);
  spec.channelnames = {"Y", "A"};
  spec.alpha_channel = 1;
  write_with_oiio(folder / "ya.png", spec, TypeDesc::UINT8, grey_alpha);
  const auto read = read_image(folder / "ya.png", {});
  ASSERT_TRUE(read);
  EXPECT_EQ(srgb8(read->image.texels[0]), (std::array<int, 3>{255, 255, 255}));
  EXPECT_EQ(srgb8(read->image.texels[3]), (std::array<int, 3>{50, 50, 50}));
}

/// A 2 x 2 PNG with palette {red, green, blue, white}, two bits per pixel, written by hand.
const std::vector<unsigned char> kPalettePng = {
    0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48, 0x44, 0x52,
    0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x02, 0x03, 0x00, 0x00, 0x00, 0x0F, 0xD8, 0xE5,
    0xB7, 0x00, 0x00, 0x00, 0x0C, 0x50, 0x4C, 0x54, 0x45, 0xFF, 0x00, 0x00, 0x00, 0xFF, 0x00, 0x00,
    0x00, 0xFF, 0xFF, 0xFF, 0xFF, 0xFB, 0x00, 0x60, 0xF6, 0x00, 0x00, 0x00, 0x0C, 0x49, 0x44, 0x41,
    0x54, 0x78, 0x9C, 0x63, 0x10, 0x60, 0xD8, 0x00, 0x00, 0x00, 0xE4, 0x00, 0xC1, 0x27, 0xA8, 0xE8,
    0x57, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};

TEST(ReadImage, PalettesAreLookedUp) {
  const auto read = read_image(kPalettePng, "model.glb, image 0", {});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(srgb8(read->image.texels[0]), (std::array<int, 3>{255, 0, 0}));
  EXPECT_EQ(srgb8(read->image.texels[1]), (std::array<int, 3>{0, 255, 0}));
  EXPECT_EQ(srgb8(read->image.texels[2]), (std::array<int, 3>{0, 0, 255}));
  EXPECT_EQ(srgb8(read->image.texels[3]), (std::array<int, 3>{255, 255, 255}));
}

TEST(ReadImage, TheFormatIsDetectedByContentNotByName) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "a.png", gradient(9, 9), 72));
  std::filesystem::rename(folder / "a.png", folder / "a.jpg");
  EXPECT_TRUE(read_image(folder / "a.jpg", {}));
  put(folder / "text.png", {'h', 'e', 'l', 'l', 'o'});
  expect_refused(read_image(folder / "text.png", {}), Code::kInvalidArgument, "text.png");
  put(folder / "empty.png", {});
  expect_refused(read_image(folder / "empty.png", {}), Code::kInvalidArgument, "empty.png");
  expect_refused(read_image(folder / "", {}), Code::kInvalidArgument, "not a regular file");
  expect_refused(read_image(folder / "none.png", {}), Code::kNotFound, "none.png");
}

void falsify_size(std::vector<char>& png, unsigned width, unsigned height) {
  for (int i = 0; i < 4; ++i) {
    png[16 + i] = static_cast<char>(width >> (24 - 8 * i));
    png[20 + i] = static_cast<char>(height >> (24 - 8 * i));
  }
}

TEST(ReadImage, APngWithAFalseSizeIsRefusedBeforeDecoding) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "a.png", gradient(64, 64), 72));
  std::vector<char> png = bytes_of(folder / "a.png");
  falsify_size(png, 100000, 100000);
  put(folder / "huge.png", png);
  expect_refused(read_image(folder / "huge.png", {}), Code::kOutOfRange, "huge.png");
  falsify_size(png, 14000, 14000);
  put(folder / "large.png", png);
  expect_refused(read_image(folder / "large.png", {}), Code::kDataLoss, "large.png");
  falsify_size(png, 0, 64);
  put(folder / "none.png", png);
  expect_refused(read_image(folder / "none.png", {}), Code::kDataLoss, "none.png");
  falsify_size(png, 64, 65);
  put(folder / "one_more.png", png);
  expect_refused(read_image(folder / "one_more.png", {}), Code::kDataLoss, "one_more.png");
}

TEST(ReadImage, AJpegWithATooLargeSizeIsRefusedBeforeDecoding) {
  const TemporaryFolder folder;
  write_with_oiio(folder / "a.jpg", ImageSpec(64, 64, 3, TypeDesc::UINT8), TypeDesc::UINT8,
                  gradient(64, 64).rgb);
  ASSERT_TRUE(read_image(folder / "a.jpg", {}));
  std::vector<char> jpeg = bytes_of(folder / "a.jpg");
  for (std::size_t i = 2; i + 9 < jpeg.size(); ++i) {
    if (static_cast<unsigned char>(jpeg[i]) == 0xFF &&
        static_cast<unsigned char>(jpeg[i + 1]) == 0xC0) {
      jpeg[i + 5] = jpeg[i + 7] = static_cast<char>(0xFF);
      break;
    }
  }
  put(folder / "huge.jpg", jpeg);
  expect_refused(read_image(folder / "huge.jpg", {}), Code::kOutOfRange, "huge.jpg");
}

TEST(ReadImage, EveryTruncationIsRefused) {
  const TemporaryFolder folder;
  const RgbImage image = gradient(64, 64);
  ASSERT_TRUE(write_png(folder / "a.png", image, 72));
  write_with_oiio(folder / "a.jpg", ImageSpec(64, 64, 3, TypeDesc::UINT8), TypeDesc::UINT8,
                  image.rgb);
  write_with_oiio(folder / "a.tif", ImageSpec(64, 64, 3, TypeDesc::UINT8), TypeDesc::UINT8,
                  image.rgb);
  for (const std::string name : {"a.png", "a.jpg", "a.tif"}) {
    const std::vector<char> whole = bytes_of(folder / name);
    for (int part = 1; part < 12; ++part) {
      const auto length = static_cast<long>(whole.size()) * part / 12;
      put(folder / ("cut_" + name), {whole.begin(), whole.begin() + length});
      const auto read = read_image(folder / ("cut_" + name), {});
      ASSERT_FALSE(read) << name << " cut to " << length << " of " << whole.size();
      EXPECT_EQ(read.error().message.find('\n'), std::string::npos) << read.error().message;
    }
  }
}

TEST(ReadImage, ADamagedPngIsRefused) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "a.png", gradient(64, 64), 72));
  std::vector<char> png = bytes_of(folder / "a.png");
  png[png.size() / 2] = static_cast<char>(~png[png.size() / 2]);
  put(folder / "bad.png", png);
  expect_refused(read_image(folder / "bad.png", {}), Code::kDataLoss, "bad.png");
}

TEST(ReadImage, FlippedBytesNeverCrash) {
  const TemporaryFolder folder;
  const RgbImage image = gradient(32, 32);
  ASSERT_TRUE(write_png(folder / "a.png", image, 72));
  write_with_oiio(folder / "a.jpg", ImageSpec(32, 32, 3, TypeDesc::UINT8), TypeDesc::UINT8,
                  image.rgb);
  write_with_oiio(folder / "a.tif", ImageSpec(32, 32, 3, TypeDesc::UINT8), TypeDesc::UINT8,
                  image.rgb);
  unsigned state = 1;
  for (const std::string name : {"a.png", "a.jpg", "a.tif"}) {
    const std::vector<char> whole = bytes_of(folder / name);
    for (int trial = 0; trial < 150; ++trial) {
      std::vector<unsigned char> bytes(whole.begin(), whole.end());
      for (int flips = 0; flips < 3; ++flips) {
        state = state * 1664525 + 1013904223;
        bytes[state % std::min<std::size_t>(bytes.size(), 700)] =
            static_cast<unsigned char>(state >> 16);
      }
      const auto read = read_image(bytes, name, {});
      if (!read) continue;
      EXPECT_EQ(read->image.texels.size(),
                static_cast<std::size_t>(read->image.width) * read->image.height);
    }
  }
}

}  // namespace
}  // namespace hydroprint::image
