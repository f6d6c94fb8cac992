#include "sim/ink/separation.h"

#include <gtest/gtest.h>
#include <lcms2.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "sim/image/io/colour.h"
#include "tests/sim/ink/printers.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::ink {
namespace {

using testing::icc_profile;

using Rgb = std::array<std::uint8_t, 3>;

/// A profile of the Debian package libgs-common (deploy/packages.txt).
constexpr const char* kRealProfile = "/usr/share/color/icc/ghostscript/default_cmyk.icc";

double amount(const Separation& separation, const Rgb& rgb) {
  double t = -1;
  separation(rgb.data(), 1, &t);
  return t;
}

Result<Separation> separation_from(const std::string& bytes) {
  const hydroprint::testing::TemporaryFolder folder;
  return make_separation(folder.write("printer.icc", bytes));
}

void expect_refused(const Result<Separation>& made, Code code, const std::string& what) {
  ASSERT_FALSE(made) << what;
  const std::string& message = made.error().message;
  EXPECT_EQ(made.error().code, code) << what << ": " << message;
  EXPECT_NE(message.find("printer.icc: "), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

double lightness(double y) { return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27; }

std::vector<Rgb> some_colours() {
  std::vector<Rgb> out;
  for (const int r : {0, 37, 128, 200, 255}) {
    for (const int g : {0, 51, 130, 255}) {
      for (const int b : {0, 77, 180, 255}) {
        out.push_back({static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g),
                       static_cast<std::uint8_t>(b)});
      }
    }
  }
  return out;
}

TEST(NaiveCmyk, PrimariesAreExact) {
  const Separation naive = *make_separation({});
  EXPECT_EQ(amount(naive, {255, 255, 255}), 0);
  EXPECT_EQ(amount(naive, {0, 0, 0}), 1);
  for (const Rgb& two_inks : {Rgb{255, 0, 0}, Rgb{0, 255, 0}, Rgb{0, 0, 255}}) {
    EXPECT_EQ(amount(naive, two_inks), 2);
  }
  for (const Rgb& one_ink : {Rgb{0, 255, 255}, Rgb{255, 0, 255}, Rgb{255, 255, 0}}) {
    EXPECT_EQ(amount(naive, one_ink), 1);
  }
  EXPECT_NEAR(amount(naive, {51, 51, 51}), 0.8, 1e-15) << "a grey uses only K";
  EXPECT_NEAR(amount(naive, {51, 0, 0}), 0.8 + 2, 1e-15);
}

TEST(NaiveCmyk, IsTheSumOfTheFourChannelsForEveryColour) {
  const Separation naive = *make_separation({});
  for (int code = 0; code < 1 << 24; code += 97) {
    const Rgb rgb = {static_cast<std::uint8_t>(code >> 16), static_cast<std::uint8_t>(code >> 8),
                     static_cast<std::uint8_t>(code)};
    const double r = rgb[0] / 255.0, g = rgb[1] / 255.0, b = rgb[2] / 255.0;
    const double k = 1 - std::max({r, g, b});
    const auto channel = [&](double colour) { return k < 1 ? (1 - colour - k) / (1 - k) : 0; };
    const double t = amount(naive, rgb);
    ASSERT_NEAR(t, channel(r) + channel(g) + channel(b) + k, 1e-12) << code;
    ASSERT_TRUE(t >= 0 && t <= 4) << code;
  }
}

TEST(IccSeparation, FollowsTheProfilesColorimetricTable) {
  const auto printer = separation_from(icc_profile({.perceptual = 0.25, .colorimetric = 0.75}));
  ASSERT_TRUE(printer) << printer.error().message;
  for (int code = 0; code < 256; ++code) {
    const auto grey = static_cast<std::uint8_t>(code);
    const double y = image::linear_from_srgb(static_cast<float>(code) / 255.0F);
    EXPECT_NEAR(amount(*printer, {grey, grey, grey}), 3 * (1 - lightness(y) / 100), 0.01) << code;
  }
  EXPECT_EQ(amount(*printer, {255, 255, 255}), 0);
  // Expected amounts from the luminances of sRGB's primaries, adapted to D50.
  EXPECT_NEAR(amount(*printer, {255, 0, 0}), 3 * (1 - lightness(0.2225) / 100), 0.01);
  EXPECT_NEAR(amount(*printer, {0, 255, 0}), 3 * (1 - lightness(0.7169) / 100), 0.01);
  EXPECT_NEAR(amount(*printer, {0, 0, 255}), 3 * (1 - lightness(0.0606) / 100), 0.01);
}

TEST(IccSeparation, AllFourInksInFullAreFour) {
  const auto printer = separation_from(icc_profile({.perceptual = 0, .colorimetric = 1}));
  ASSERT_TRUE(printer) << printer.error().message;
  EXPECT_NEAR(amount(*printer, {0, 0, 0}), 4, 1e-3);
  EXPECT_LE(amount(*printer, {0, 0, 0}), 4);
}

TEST(IccSeparation, RealPrintersProfileAgreesWithLittleCmsInFullPrecision) {
  const auto printer = make_separation(kRealProfile);
  ASSERT_TRUE(printer) << printer.error().message << " (Debian package libgs-common)";
  const cmsHPROFILE srgb = cmsCreate_sRGBProfile();
  const cmsHPROFILE profile = cmsOpenProfileFromFile(kRealProfile, "r");
  const cmsHTRANSFORM exact = cmsCreateTransform(srgb, TYPE_RGB_DBL, profile, TYPE_CMYK_DBL,
                                                 INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE);
  ASSERT_NE(exact, nullptr);
  for (const Rgb& rgb : some_colours()) {
    const std::array<double, 3> from = {rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0};
    std::array<double, 4> percent{};
    cmsDoTransform(exact, from.data(), percent.data(), 1);
    const double t = (percent[0] + percent[1] + percent[2] + percent[3]) / 100;
    EXPECT_NEAR(amount(*printer, rgb), t, 0.03) << +rgb[0] << " " << +rgb[1] << " " << +rgb[2];
  }
  EXPECT_EQ(amount(*printer, {255, 255, 255}), 0);
  EXPECT_GT(amount(*printer, {0, 0, 0}), 2) << "the black of a real printer uses more than K";
  cmsDeleteTransform(exact);
  cmsCloseProfile(profile);
  cmsCloseProfile(srgb);
}

TEST(IccSeparation, RowsOfAnyLengthAreThoseOfSinglePixels) {
  const auto printer = separation_from(icc_profile({}));
  ASSERT_TRUE(printer) << printer.error().message;
  for (const std::size_t count : {0, 1, 1023, 1024, 1025, 3000}) {
    std::vector<std::uint8_t> rgb(3 * count);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(i * 37 % 251);
    std::vector<double> t(count + 1, -1);
    (*printer)(rgb.data(), count, t.data());
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(t[i], amount(*printer, {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]})) << i;
    }
    EXPECT_EQ(t[count], -1);
  }
}

TEST(IccSeparation, ProfilesOfOtherDevicesAreRefused) {
  expect_refused(separation_from(testing::srgb_profile()), Code::kInvalidArgument, "a display");
  expect_refused(separation_from(testing::cmyk_link_profile()), Code::kInvalidArgument, "a link");
  expect_refused(separation_from(testing::rgb_printer_profile()), Code::kInvalidArgument, "RGB");
}

TEST(IccSeparation, MissingFilesAndOtherFilesAreRefused) {
  const hydroprint::testing::TemporaryFolder folder;
  expect_refused(make_separation(folder.path() / "printer.icc"), Code::kNotFound, "missing");
  EXPECT_EQ(make_separation(folder.path()).error().code, Code::kInvalidArgument);
  EXPECT_EQ(make_separation("/dev/zero").error().code, Code::kInvalidArgument);
  expect_refused(separation_from(""), Code::kDataLoss, "empty");
  expect_refused(separation_from("ICC"), Code::kDataLoss, "short");
  expect_refused(separation_from(std::string(4096, '\0')), Code::kDataLoss, "zeros");
  expect_refused(separation_from(std::string(4096, 'x')), Code::kDataLoss, "text");
}

TEST(IccSeparation, TruncatedProfilesAreRefused) {
  const hydroprint::testing::TemporaryFolder folder;
  const std::string whole = icc_profile({});
  const auto path = folder.write("printer.icc", whole);
  ASSERT_TRUE(make_separation(path));
  for (std::size_t size = whole.size() - 1; size > 0; --size) {
    std::filesystem::resize_file(path, size);
    expect_refused(make_separation(path), Code::kDataLoss, std::to_string(size));
  }
}

TEST(IccSeparation, HugeTablesThatAHeaderAnnouncesAreNotAllocated) {
  const auto peak_kib = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const std::string whole = icc_profile({});
  const std::size_t table = whole.rfind("mBA ");
  ASSERT_NE(table, std::string::npos);
  const auto word = [&](std::size_t at) {
    std::size_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(whole[at + i]);
    return value;
  };
  const std::size_t grid_points = table + word(table + 24);
  ASSERT_EQ(whole.substr(grid_points, 4), std::string("\2\2\2\0", 4));
  const long before = peak_kib();
  // With 4 channels of 2 bytes, the tables would have 133 MB and 16 MB.
  for (const char points : {'\xFF', '\x7F'}) {
    std::string lying = whole;
    lying.replace(grid_points, 3, 3, points);
    expect_refused(separation_from(lying), Code::kDataLoss, "grid points");
  }
  EXPECT_LT(peak_kib() - before, 64 * 1024);
  // Corrupts the size and the number of tags in the header.
  for (const std::size_t at : {std::size_t{0}, std::size_t{128}}) {
    std::string lying = whole;
    lying.replace(at, 4, 4, '\xFF');
    expect_refused(separation_from(lying), Code::kDataLoss, "sizes");
  }
}

TEST(IccSeparation, DamagedProfilesAreRefusedOrGiveAnAmountOfInk) {
  const std::string whole = icc_profile({});
  std::mt19937 random(5);
  for (int trial = 0; trial < 60; ++trial) {
    std::string damaged = whole;
    const std::size_t at = random() % whole.size();
    damaged[at] = static_cast<char>(random());
    const auto printer = separation_from(damaged);
    if (!printer) {
      EXPECT_EQ(printer.error().message.find('\n'), std::string::npos) << printer.error().message;
      continue;
    }
    for (const Rgb& rgb : some_colours()) {
      const double t = amount(*printer, rgb);
      EXPECT_TRUE(t >= 0 && t <= 4) << at;
    }
  }
}

}  // namespace
}  // namespace hydroprint::ink
