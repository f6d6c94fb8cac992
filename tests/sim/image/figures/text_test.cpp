#include "sim/image/figures/text.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace hydroprint::image {
namespace {

constexpr Rgb8 kBlack = {0, 0, 0};

const text::Font& font() { return *text::Font::standard().value(); }

RgbImage blank(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(3U * static_cast<unsigned>(width * height), 255)};
}

/// First and last column of an image that contain ink.
std::pair<int, int> inked_columns(const RgbImage& image) {
  int first = image.width, last = -1;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (image.at(x, y)[0] > 250) continue;
      first = std::min(first, x);
      last = std::max(last, x);
    }
  }
  return {first, last};
}

RgbImage drawn(std::string_view text) {
  RgbImage image = blank(300, 60);
  draw_text(image, font(), 10, 40, 14, text, kBlack);
  return image;
}

TEST(Text, IsAsWideAsItSays) {
  const double width = text_width_px(font(), 14, "HnH");
  const auto [first, last] = inked_columns(drawn("HnH"));
  EXPECT_NEAR(first, 10, 3);
  EXPECT_NEAR(last, 10 + width, 3);
}

TEST(Text, CaseAndAccentsAreDrawn) {
  EXPECT_NE(drawn("mug").rgb, drawn("MUG").rgb);
  EXPECT_NE(drawn("arztin").rgb, drawn("ärztin").rgb);
  EXPECT_NE(drawn("3").rgb, drawn("№3").rgb);
}

TEST(Text, IsAntialiasedBetweenPaperAndInk) {
  const RgbImage image = drawn("O");
  EXPECT_EQ(*std::min_element(image.rgb.begin(), image.rgb.end()), 0);
  EXPECT_TRUE(std::any_of(image.rgb.begin(), image.rgb.end(),
                          [](std::uint8_t c) { return c > 60 && c < 200; }));
}

TEST(Text, PartsBeyondTheImageAreLeftOut) {
  RgbImage image = blank(20, 10);
  for (const double at : {-1000.0, -15.0, -3.0, 5.0, 19.5, 1e6}) {
    draw_text(image, font(), at, 5, 30, "Mug 7 \xFF\U0001F9D9", kBlack);
    draw_text(image, font(), 5, at, 30, "Mug 7", kBlack);
  }
  EXPECT_EQ(image.rgb.size(), 600U);
}

}  // namespace
}  // namespace hydroprint::image
