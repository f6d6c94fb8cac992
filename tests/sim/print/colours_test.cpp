#include "sim/print/colours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/ink/separation.h"
#include "tests/sim/ink/printers.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::print {
namespace {

image::RgbImage row_of(const std::vector<image::Rgb8>& colours) {
  image::RgbImage out{static_cast<int>(colours.size()), 1, {}};
  for (const image::Rgb8& c : colours) out.rgb.insert(out.rgb.end(), c.begin(), c.end());
  return out;
}

image::RgbImage noise(int width, int height) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> code(0, 255);
  image::RgbImage out{width, height, std::vector<std::uint8_t>(3U * width * height)};
  for (std::uint8_t& c : out.rgb) c = static_cast<std::uint8_t>(code(random));
  return out;
}

int total(const std::uint8_t* c) { return c[0] + c[1] + c[2] + c[3]; }

ColourSettings plain_cmyk(double limit = 4) { return {true, {}, limit}; }

TEST(PrinterColours, PlainCmykOfPureColoursIsExact) {
  const auto got = printer_coloured(
      row_of({{255, 255, 255}, {0, 0, 0}, {255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {128, 128, 128}}),
      plain_cmyk(), {});
  ASSERT_TRUE(got);
  EXPECT_EQ(got->image.samples,
            (std::vector<std::uint8_t>{0,   0, 0,   0, 0,   0,   0, 255, 0, 255, 255, 0,
                                       255, 0, 255, 0, 255, 255, 0, 0,   0, 0,   0,   127}));
  EXPECT_EQ(got->most_ink, 2);
  EXPECT_EQ(got->limited_share, 0);
}

TEST(PrinterColours, RgbWithoutAProfileIsUnchanged) {
  const image::RgbImage image = noise(31, 17);
  const auto got = printer_coloured(image, {}, {});
  ASSERT_TRUE(got);
  EXPECT_EQ(got->image.samples, image.rgb);
}

TEST(PrinterColours, NoPixelExceedsTheInkLimitAndBlackStays) {
  const image::RgbImage image = noise(300, 200);
  const auto all = printer_coloured(image, plain_cmyk(), {});
  for (const double limit : {0.3, 1.0, 1.7, 2.5}) {
    const auto got = printer_coloured(image, plain_cmyk(limit), {});
    ASSERT_TRUE(got);
    double most = 0, changed = 0;
    for (std::size_t i = 0; i < got->image.samples.size(); i += 4) {
      const std::uint8_t* cmyk = &got->image.samples[i];
      const std::uint8_t* before = &all->image.samples[i];
      most = std::max(most, total(cmyk) / 255.0);
      if (total(before) <= limit * 255) {
        EXPECT_TRUE(std::equal(cmyk, cmyk + 4, before));
        continue;
      }
      ++changed;
      EXPECT_GE(total(cmyk), static_cast<int>(limit * 255) - 3);
      EXPECT_EQ(cmyk[3], std::min<int>(before[3], static_cast<int>(limit * 255)));
      // The hue must not change: the shares of C, M and Y are equal except for 8-bit rounding.
      const double colour = before[0] + before[1] + before[2], left = cmyk[0] + cmyk[1] + cmyk[2];
      for (int c = 0; colour > 0 && c < 3; ++c) {
        EXPECT_NEAR(cmyk[c], before[c] * left / colour, 2);
      }
    }
    EXPECT_LE(most, limit);
    EXPECT_EQ(got->most_ink, most);
    EXPECT_NEAR(got->limited_share, changed / (300 * 200), 1e-12);
  }
}

TEST(PrinterColours, AProfileUsesTheInkThatTheSimulationAssumes) {
  const testing::TemporaryFolder folder;
  const auto icc = folder.write("printer.icc", ink::testing::icc_profile({0.25, 0.75}));
  const image::RgbImage image = noise(40, 30);
  const auto got = printer_coloured(image, {false, icc, 4}, {});
  ASSERT_TRUE(got);
  ASSERT_EQ(got->image.channels, 4);
  const auto separation = ink::make_separation(icc);
  ASSERT_TRUE(separation);
  std::vector<double> t(40 * 30);
  (*separation)(image.rgb.data(), t.size(), t.data());
  for (std::size_t i = 0; i < t.size(); ++i) {
    EXPECT_NEAR(total(&got->image.samples[4 * i]) / 255.0, t[i], 2.1 / 255);
  }
}

TEST(PrinterColours, WhiteIsNoInkForAnyProfile) {
  const testing::TemporaryFolder folder;
  for (const std::string& bytes :
       {ink::testing::icc_profile({0.25, 0.75}), ink::testing::rgb_printer_profile()}) {
    const auto icc = folder.write("printer.icc", bytes);
    const auto got = printer_coloured(row_of({{255, 255, 255}}), {false, icc, 4}, {});
    ASSERT_TRUE(got);
    const std::uint8_t nothing = got->image.channels == 4 ? 0 : 255;
    for (const std::uint8_t c : got->image.samples) EXPECT_EQ(c, nothing);
    EXPECT_EQ(got->icc_profile, bytes);
  }
}

TEST(PrinterColours, AreTheSameForAnyNumberOfThreads) {
  const image::RgbImage image = noise(200, 150);
  Context many;
  many.threads = 4;
  EXPECT_EQ(printer_coloured(image, plain_cmyk(1.5), {})->image.samples,
            printer_coloured(image, plain_cmyk(1.5), many)->image.samples);
}

TEST(PrinterColours, RefuseInvalidInkLimits) {
  const image::RgbImage image = noise(2, 2);
  for (const double limit : {0.0, -1.0, 4.1, static_cast<double>(NAN)}) {
    EXPECT_EQ(printer_coloured(image, plain_cmyk(limit), {}).error().code, Code::kOutOfRange);
  }
  EXPECT_EQ(printer_coloured(image, {false, {}, 3}, {}).error().code, Code::kInvalidArgument);
}

}  // namespace
}  // namespace hydroprint::print
