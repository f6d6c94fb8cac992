// How the values of an image file become colours: orientation, profile, gamma, alpha, factor.

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <lcms2.h>

#include <Eigen/LU>
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

ReadImage decode(const std::filesystem::path& path, const Decoding& decoding = {}) {
  auto read = read_image(path, {}, decoding);
  if (!read) {
    ADD_FAILURE() << read.error().message;
    return {};
  }
  return std::move(*read);
}

Eigen::Vector3d linear(const Texel& texel) {
  return Eigen::Vector3d(texel.r, texel.g, texel.b) / 65535.0;
}

using Profile = std::vector<std::uint8_t>;

Profile bytes_of(cmsHPROFILE profile) {
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  Profile bytes(size);
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  return bytes;
}

constexpr cmsCIExyY kD65 = {0.3127, 0.3290, 1};
constexpr cmsCIExyYTRIPLE kWide = {{0.64, 0.33, 1}, {0.21, 0.71, 1}, {0.15, 0.06, 1}};
constexpr cmsCIExyYTRIPLE kSrgb = {{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}};

Profile rgb_profile(const cmsCIExyYTRIPLE& primaries, double gamma) {
  cmsToneCurve* curve = cmsBuildGamma(nullptr, gamma);
  const std::array<cmsToneCurve*, 3> curves = {curve, curve, curve};
  const Profile out = bytes_of(cmsCreateRGBProfile(&kD65, &primaries, curves.data()));
  cmsFreeToneCurve(curve);
  return out;
}

/// Returns the matrix from linear RGB to XYZ that primaries and white define.
Eigen::Matrix3d to_xyz(const cmsCIExyYTRIPLE& p) {
  const auto column = [](const cmsCIExyY& c) {
    return Eigen::Vector3d(c.x / c.y, 1, (1 - c.x - c.y) / c.y);
  };
  Eigen::Matrix3d m;
  m << column(p.Red), column(p.Green), column(p.Blue);
  return m * (m.inverse() * column(kD65)).asDiagonal();
}

void attach(ImageSpec& spec, const Profile& profile) {
  spec.attribute("ICCProfile", TypeDesc(TypeDesc::UINT8, static_cast<int>(profile.size())),
                 profile.data());
}

/// 8-bit colours; the second lies outside sRGB as wide RGB.
const std::vector<std::uint8_t> kColours = {200, 120, 90, 90,  160, 100, 120, 90, 180,
                                            60,  60,  60, 255, 255, 255, 0,   0,  0};

TEST(Decoding, EveryOrientationShowsTheSamePicture) {
  // Exif 2.3, tag 274: where the first row and the first column are when the picture is seen.
  enum Side { kTop, kBottom, kLeft, kRight };
  const std::array<std::pair<Side, Side>, 8> sides = {{{kTop, kLeft},
                                                       {kTop, kRight},
                                                       {kBottom, kRight},
                                                       {kBottom, kLeft},
                                                       {kLeft, kTop},
                                                       {kRight, kTop},
                                                       {kRight, kBottom},
                                                       {kLeft, kBottom}}};
  constexpr int kWidth = 3, kHeight = 2;  // as seen
  const auto seen = [](int x, int y) { return 40 * (x + kWidth * y) + 20; };
  const TemporaryFolder folder;
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const auto [row, column] = sides[static_cast<std::size_t>(orientation - 1)];
    const bool rows_are_rows = row == kTop || row == kBottom;
    const int width = rows_are_rows ? kWidth : kHeight, height = rows_are_rows ? kHeight : kWidth;
    std::vector<std::uint8_t> values;
    for (int r = 0; r < height; ++r) {
      for (int c = 0; c < width; ++c) {
        const auto along = [](Side side, int i, int count) {
          return side == kBottom || side == kRight ? count - 1 - i : i;
        };
        const int from_row = along(row, r, height), from_column = along(column, c, width);
        const int value = rows_are_rows ? seen(from_column, from_row) : seen(from_row, from_column);
        values.insert(values.end(), 3, static_cast<std::uint8_t>(value));
      }
    }
    ImageSpec spec(width, height, 3, TypeDesc::UINT8);
    spec.attribute("Orientation", orientation);
    write_with_oiio(folder / "a.tif", spec, TypeDesc::UINT8, values);
    const ReadImage read = decode(folder / "a.tif");
    ASSERT_EQ(read.image.width, kWidth) << orientation;
    ASSERT_EQ(read.image.height, kHeight) << orientation;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        EXPECT_EQ(srgb8(read.image.texels[static_cast<std::size_t>(x + kWidth * y)])[0], seen(x, y))
            << orientation;
    EXPECT_EQ(decode(folder / "a.tif", {.as_stored = true}).image.width, width);
  }
}

TEST(Decoding, APhotoOfAPhoneIsTurned) {
  // Orientation 6: the first row is on the right, the first column at the top.
  const TemporaryFolder folder;
  std::vector<std::uint8_t> values;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x) values.insert(values.end(), 3, x < 16 ? 250 : 10);
  ImageSpec spec(32, 16, 3, TypeDesc::UINT8);
  spec.attribute("Orientation", 6);
  write_with_oiio(folder / "a.jpg", spec, TypeDesc::UINT8, values);
  const ReadImage read = decode(folder / "a.jpg");
  ASSERT_EQ(read.image.width, 16);
  ASSERT_EQ(read.image.height, 32);
  EXPECT_GT(srgb8(read.image.texels[8])[1], 240);  // at the top: the stored left
  EXPECT_LT(srgb8(read.image.texels[16 * 31 + 8])[1], 20);
}

TEST(Decoding, ProfilesAreConvertedToSrgb) {
  const TemporaryFolder folder;
  ImageSpec spec(6, 1, 3, TypeDesc::UINT8);
  attach(spec, rgb_profile(kWide, 2.2));
  const Eigen::Matrix3d to_srgb = to_xyz(kSrgb).inverse() * to_xyz(kWide);
  for (const std::string name : {"a.png", "a.tif"}) {
    write_with_oiio(folder / name, spec, TypeDesc::UINT8, kColours);
    const ReadImage read = decode(folder / name);
    EXPECT_TRUE(read.warnings.empty());
    for (std::size_t i = 0; i < 6; ++i) {
      Eigen::Vector3d wide;
      for (int k = 0; k < 3; ++k) wide[k] = std::pow(kColours[3 * i + k] / 255.0, 2.2);
      const Eigen::Vector3f expected =
          srgb_from_linear(Eigen::Vector3f((to_srgb * wide).cast<float>()));
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(srgb8(read.image.texels[i])[k], 255 * expected[k], 1.01) << name << " " << i;
    }
    EXPECT_EQ(srgb8(decode(folder / name, {.as_stored = true}).image.texels[0]),
              (std::array<int, 3>{200, 120, 90}));
  }
}

TEST(Decoding, AProfileOfSrgbChangesNoCode) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> values;
  for (int code = 0; code < 256; ++code)
    for (const int value : {code, 255 - code, code * 7 % 256})
      values.push_back(static_cast<std::uint8_t>(value));
  ImageSpec spec(256, 1, 3, TypeDesc::UINT8);
  attach(spec, bytes_of(cmsCreate_sRGBProfile()));
  write_with_oiio(folder / "a.png", spec, TypeDesc::UINT8, values);
  const ReadImage read = decode(folder / "a.png");
  for (int code = 0; code < 256; ++code)
    EXPECT_EQ(srgb8(read.image.texels[static_cast<std::size_t>(code)]),
              (std::array<int, 3>{code, 255 - code, code * 7 % 256}));
}

TEST(Decoding, GreyProfilesAreConverted) {
  const TemporaryFolder folder;
  cmsToneCurve* curve = cmsBuildGamma(nullptr, 1);
  ImageSpec spec(3, 1, 1, TypeDesc::UINT8);
  attach(spec, bytes_of(cmsCreateGrayProfile(cmsD50_xyY(), curve)));
  cmsFreeToneCurve(curve);
  write_with_oiio(folder / "a.tif", spec, TypeDesc::UINT8, std::vector<std::uint8_t>{0, 64, 255});
  const ReadImage read = decode(folder / "a.tif");
  EXPECT_TRUE(read.warnings.empty());
  EXPECT_NEAR(linear(read.image.texels[1]).y(), 64 / 255.0, 0.004);
  EXPECT_NEAR(linear(read.image.texels[2]).y(), 1, 0.004);
}

TEST(Decoding, UnusableProfilesGiveAWarning) {
  const TemporaryFolder folder;
  cmsToneCurve* curve = cmsBuildGamma(nullptr, 1);
  const Profile grey = bytes_of(cmsCreateGrayProfile(cmsD50_xyY(), curve));
  cmsFreeToneCurve(curve);
  Profile cut = rgb_profile(kWide, 2.2);
  cut.resize(200);
  for (const Profile& profile : {cut, grey}) {
    ImageSpec spec(6, 1, 3, TypeDesc::UINT8);
    attach(spec, profile);
    write_with_oiio(folder / "a.tif", spec, TypeDesc::UINT8, kColours);
    const ReadImage read = decode(folder / "a.tif");
    ASSERT_EQ(read.warnings.size(), 1U);
    EXPECT_EQ(read.warnings[0].code, WarningCode::PROFILE_IGNORED);
    EXPECT_EQ(srgb8(read.image.texels[0]), (std::array<int, 3>{200, 120, 90}));
  }
}

/// Returns the bytes of a PNG chunk.
std::string chunk(const std::string& type_and_data) {
  const auto big_endian = [](std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
    return bytes;
  };
  std::uint32_t crc = ~0U;
  for (const char byte : type_and_data) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xEDB88320U & (0U - (crc & 1U)));
  }
  return big_endian(static_cast<std::uint32_t>(type_and_data.size() - 4)) + type_and_data +
         big_endian(~crc);
}

TEST(Decoding, ADamagedProfileOfAPngGivesAWarningAndNoGamma) {
  const TemporaryFolder folder;
  ImageSpec spec(6, 1, 3, TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "Linear");
  write_with_oiio(folder / "a.png", spec, TypeDesc::UINT8, kColours);
  std::ifstream file(folder / "a.png", std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  constexpr std::size_t kAfterHeader = 33;
  bytes.insert(kAfterHeader, chunk(std::string("iCCPx\0\0", 7) + "not compressed"));
  std::ofstream(folder / "b.png", std::ios::binary) << bytes;
  const ReadImage read = decode(folder / "b.png");
  ASSERT_EQ(read.warnings.size(), 1U);
  EXPECT_EQ(read.warnings[0].code, WarningCode::PROFILE_IGNORED);
  EXPECT_EQ(srgb8(read.image.texels[0]), (std::array<int, 3>{200, 120, 90}));
}

TEST(Decoding, TheGammaOfAPngCounts) {
  const TemporaryFolder folder;
  ImageSpec spec(6, 1, 3, TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "Linear");
  write_with_oiio(folder / "a.png", spec, TypeDesc::UINT8, kColours);
  const ReadImage read = decode(folder / "a.png");
  for (std::size_t i = 0; i < 6; ++i)
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(linear(read.image.texels[i])[k], kColours[3 * i + k] / 255.0, 1e-4);
  EXPECT_EQ(srgb8(decode(folder / "a.png", {.as_stored = true}).image.texels[0]),
            (std::array<int, 3>{200, 120, 90}));
}

TEST(Decoding, AProfileWinsOverTheGamma) {
  const TemporaryFolder folder;
  ImageSpec spec(6, 1, 3, TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "Linear");
  attach(spec, bytes_of(cmsCreate_sRGBProfile()));
  write_with_oiio(folder / "a.png", spec, TypeDesc::UINT8, kColours);
  EXPECT_EQ(srgb8(decode(folder / "a.png").image.texels[0]), (std::array<int, 3>{200, 120, 90}));
}

TEST(Decoding, AlphaIsBlendedIgnoredOrCutOut) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> values = {200, 120, 90, 255, 200, 120, 90, 128,
                                            200, 120, 90, 100, 200, 120, 90, 0};
  write_with_oiio(folder / "a.png", ImageSpec(4, 1, 4, TypeDesc::UINT8), TypeDesc::UINT8, values);
  const Eigen::Vector3d colour =
      linear_from_srgb(Eigen::Vector3f(200, 120, 90) / 255).cast<double>();
  const auto over_white = [&](double opacity, const Eigen::Vector3d& factor) {
    return (opacity * colour.cwiseProduct(factor) + Eigen::Vector3d::Constant(1 - opacity)).eval();
  };
  const Eigen::Vector3d none = Eigen::Vector3d::Ones(), tint(0.5, 1, 0.25);
  const auto expect = [&](const Decoding& decoding, const std::array<double, 4>& opacities,
                          const Eigen::Vector3d& factor) {
    const ReadImage read = decode(folder / "a.png", decoding);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_LT((linear(read.image.texels[i]) - over_white(opacities[i], factor)).norm(), 1e-4)
          << i;
    EXPECT_EQ(read.had_alpha, opacities[3] < 1);
  };
  expect({}, {1, 128 / 255.0, 100 / 255.0, 0}, none);
  expect({.opacity = 0.5F}, {0.5, 64 / 255.0, 50 / 255.0, 0}, none);
  expect({.alpha = Alpha::kIgnored}, {1, 1, 1, 1}, none);
  expect({.alpha = Alpha::kCutOut}, {1, 1, 0, 0}, none);
  expect({.alpha = Alpha::kCutOut, .cutoff = 0.3F}, {1, 1, 1, 0}, none);
  expect({.alpha = Alpha::kCutOut, .cutoff = 1.5F}, {0, 0, 0, 0}, none);
  expect({.tint = tint.cast<float>()}, {1, 128 / 255.0, 100 / 255.0, 0}, tint);
}

TEST(Decoding, OpacityOfAnImageWithoutAlphaIsItsAlpha) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "a.png", make_image(2, 2, [](int, int) { return kBlack; }), 72));
  const ReadImage read = decode(folder / "a.png", {.opacity = 0.25F});
  EXPECT_TRUE(read.had_alpha);
  EXPECT_NEAR(linear(read.image.texels[0]).x(), 0.75, 1e-4);
}

}  // namespace
}  // namespace hydroprint::image
