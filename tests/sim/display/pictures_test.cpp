#include "sim/display/pictures.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/value_of.h"

namespace hydroprint::display {
namespace {

/// Noise, which hardly compresses.
image::Texture noise(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  image::Texels texels{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    const auto value = [&] { return static_cast<std::uint16_t>(random()); };
    texels.texels.push_back({value(), value(), value(), 0});
  }
  return testing::value_of(
      image::Texture::build(std::move(texels), mesh::Wrap::kMirror, mesh::Wrap::kClamp, {}));
}

image::Texels decoded(const Picture& picture) {
  return testing::value_of(image::read_image(picture.png, "picture", Context{})).image;
}

TEST(Pictures, WithinTheLimitsKeepEveryPixel) {
  const std::vector<image::Texture> textures = {noise(40, 30, 1), noise(7, 90, 2)};
  const Pictures out = testing::value_of(show_pictures(textures, {}, {}));
  EXPECT_EQ(out.halvings, 0);
  ASSERT_EQ(out.pictures.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const image::Texels read = decoded(out.pictures[i]);
    EXPECT_EQ(read.width, textures[i].width());
    EXPECT_EQ(read.height, textures[i].height());
    const image::Texels& first = textures[i].levels()[0];
    for (std::size_t k = 0; k < read.texels.size(); ++k) {
      EXPECT_NEAR(read.texels[k].r, first.texels[k].r, 300) << "half a step of 8-bit sRGB";
      EXPECT_NEAR(read.texels[k].b, first.texels[k].b, 300);
    }
    EXPECT_EQ(out.pictures[i].wrap_u, mesh::Wrap::kMirror);
    EXPECT_EQ(out.pictures[i].wrap_v, mesh::Wrap::kClamp);
  }
}

TEST(Pictures, OnlyThoseWithALongSideAreHalved) {
  const std::vector<image::Texture> textures = {noise(300, 20, 1), noise(64, 64, 2)};
  const Pictures out = testing::value_of(show_pictures(textures, {100, 1 << 20}, {}));
  EXPECT_EQ(out.halvings, 0);
  EXPECT_EQ(decoded(out.pictures[0]).width, 75);
  EXPECT_EQ(decoded(out.pictures[0]).height, 5);
  EXPECT_EQ(decoded(out.pictures[1]).width, 64);
}

TEST(Pictures, AllAreHalvedUntilTheyFitTogether) {
  const std::vector<image::Texture> textures = {noise(128, 128, 1), noise(64, 32, 2),
                                                noise(2, 2, 3)};
  const Pictures out = testing::value_of(show_pictures(textures, {2048, 16'000}, {}));
  std::size_t bytes = 0;
  for (const Picture& picture : out.pictures) bytes += picture.png.size();
  EXPECT_LE(bytes, 16'000U);
  EXPECT_EQ(out.halvings, 1) << "128 x 128 x 3 = 49 kB and 6 kB become a quarter";
  EXPECT_EQ(decoded(out.pictures[0]).width, 64);
  EXPECT_EQ(decoded(out.pictures[1]).width, 32);
  EXPECT_EQ(decoded(out.pictures[2]).width, 1);
}

TEST(Pictures, ThatNeverFitAreRefused) {
  const std::vector<image::Texture> textures = {noise(4, 4, 1), noise(4, 4, 2)};
  const auto out = show_pictures(textures, {2048, 60}, {});
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code, Code::kResourceExhausted);
}

}  // namespace
}  // namespace hydroprint::display
